#include "ricochet/solver/delassus/contact_basis.hpp"

#include <gtest/gtest.h>

#include <random>

namespace ricochet {
namespace {

/// Candidates of which every other one has rows that follow the motion, on two of a few dofs of its own and one of a
/// neighbour.
class ContactBasisTest : public testing::Test {
 protected:
  static constexpr Index candidates = 5, dofs = 12;
  std::mt19937 random{3};
  ContactBasis basis;
  std::vector<Matrix> rows_;  // of each candidate in H

  [[nodiscard]] double number() { return double(random()) / 2147483648.0 - 1.0; }
  [[nodiscard]] static bool follows(Index i) { return i % 2 == 0; }
  void append() {
    std::vector<int> of_dofs;
    for (Index i = 0; i < candidates; ++i) {
      rows_.push_back(Matrix::Zero(i == 2 ? 1 : 3, dofs));
      basis.append_candidate(rows_.back().rows(), follows(i));
      for (Index k = 0; k < 3; ++k) {
        const auto dof = int((2 * i + k) % dofs);
        rows_.back().col(dof).setConstant(number());
        if (follows(i) && !basis.has_dof(dof) && std::ranges::find(of_dofs, dof) == of_dofs.end())
          of_dofs.push_back(dof);
      }
    }
    basis.append_dofs(of_dofs);
  }
  /// Other directions of the rows that follow the motion.
  void rotate() {
    basis.begin_directions();
    for (Index i = 0; i < candidates; ++i) {
      if (!follows(i)) continue;
      for (Index k = 0; k < 3; ++k) {
        const Index dof = (2 * i + k) % dofs;
        for (Index row = 0; row < rows_[std::size_t(i)].rows(); ++row) {
          rows_[std::size_t(i)](row, dof) = number();
          basis.add(std::size_t(i), row, dof, rows_[std::size_t(i)](row, dof));
        }
      }
    }
    basis.finish_directions();
  }
  [[nodiscard]] Matrix h() const {
    Matrix result(0, dofs);
    for (const Matrix& part : rows_) {
      result.conservativeResize(result.rows() + part.rows(), Eigen::NoChange);
      result.bottomRows(part.rows()) = part;
    }
    return result;
  }
  [[nodiscard]] Matrix e() const {
    Matrix result = Matrix::Zero(basis.size(), dofs);
    for (Index i = 0; i < basis.size(); ++i) {
      const ContactBasis::Row& row = basis.rows()[std::size_t(i)];
      if (row.dof >= 0) {
        result(i, row.dof) = 1.0;
      } else {
        result.row(i) = rows_[std::size_t(row.candidate)].row(row.row);
      }
    }
    return result;
  }
};

TEST_F(ContactBasisTest, GivesTheOperatorOfRowsThatRotateFromColumnsThatDoNot) {
  append();
  ASSERT_TRUE(basis.any_follows());
  const Matrix some = Matrix::NullaryExpr(dofs, dofs, [&] { return number(); });
  const Matrix compliance = some * some.transpose();
  const Matrix k = e() * compliance * e().transpose();
  for (int turn = 0; turn < 3; ++turn) {
    rotate();
    const Matrix w = basis.product(k), expected = h() * compliance * h().transpose();
    EXPECT_LE((w - expected).cwiseAbs().maxCoeff(), 1e-14 * expected.cwiseAbs().maxCoeff());
    EXPECT_TRUE(w == w.transpose());
    const Vector motion = Vector::NullaryExpr(dofs, [&] { return number(); });
    Vector result;
    basis.to_rows(e() * motion, result);
    EXPECT_LE((result - h() * motion).norm(), 1e-14 * motion.norm());
    const Vector reaction = Vector::NullaryExpr(h().rows(), [&] { return number(); });
    basis.to_basis(reaction, result);
    EXPECT_LE((e().transpose() * result - h().transpose() * reaction).norm(), 1e-14 * reaction.norm());
  }
}

TEST_F(ContactBasisTest, CountsDofsThatNoRowUsesAnyMore) {
  append();
  rotate();
  EXPECT_EQ(basis.unused_dofs(), 0);
  const std::vector<int> before = basis.dofs();
  basis.append_dofs({dofs + 3, dofs + 1});
  rotate();
  EXPECT_EQ(basis.unused_dofs(), 2);
  std::vector<int> expected = before;
  expected.insert(expected.end(), {dofs + 3, dofs + 1});
  EXPECT_EQ(basis.dofs(), expected);
  basis.clear();
  EXPECT_FALSE(basis.any_follows());
  EXPECT_EQ(basis.size(), 0);
  EXPECT_EQ(basis.unused_dofs(), 0) << "candidates that do not follow the motion need no D";
}

}  // namespace
}  // namespace ricochet
