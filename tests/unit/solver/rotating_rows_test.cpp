#include "ricochet/solver/corotated/rotating_rows.hpp"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <random>

namespace ricochet {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

/// Points in space, each on two nodes of its own; those with odd numbers have no rotating trace.
struct TurningPoints {
  static constexpr Index points = 5, nodes = 2 * points, d = 3;
  std::mt19937 random{3};
  ContactRows rows;
  SparseRowMatrix trace{points, nodes};

  TurningPoints() {
    Triplets entries, turning;
    for (Index i = 0; i < points; ++i) {
      for (Index j = 0; j < 2; ++j) {
        const Eigen::Triplet<double> entry(static_cast<int>(i), int(2 * i + j), number());
        entries.push_back(entry);
        if (i % 2 == 0) turning.push_back(entry);
      }
    }
    trace.setFromTriplets(entries.begin(), entries.end());
    auto of_turning = std::make_shared<SparseRowMatrix>(points, nodes);
    of_turning->setFromTriplets(turning.begin(), turning.end());
    rows.rotating_trace = of_turning;
    rows.normals.resize(d, points);
    turn();
  }
  [[nodiscard]] double number() { return double(random()) / 2147483648.0 - 1.0; }

  /// Rotates the directions. Point 4 slips along one tangent alone.
  void turn() {
    Triplets gap, slip;
    for (Index i = 0; i < points; ++i) {
      const Eigen::Matrix3d some = Eigen::Matrix3d::NullaryExpr([this] { return number(); });
      const Eigen::Matrix3d q = Eigen::HouseholderQR<Eigen::Matrix3d>(some).householderQ();
      rows.normals.col(i) = q.col(0);
      for (SparseRowMatrix::InnerIterator c(trace, i); c; ++c) {
        for (Index k = 0; k < d; ++k) {
          const int dof = int(c.col() * d + k);
          gap.emplace_back(int(i), dof, c.value() * q(k, 0));
          for (int j = 1; j < d; ++j)
            slip.emplace_back(int(i * (d - 1)) + j - 1, dof, i == 4 && j == 2 ? 0.0 : c.value() * q(k, j));
        }
      }
    }
    rows.gap_operator.resize(points, nodes * d);
    rows.gap_operator.setFromTriplets(gap.begin(), gap.end());
    rows.tangential_trace.resize(points * (d - 1), nodes * d);
    rows.tangential_trace.setFromTriplets(slip.begin(), slip.end());
  }
  /// H of a point; without friction only its row of G.
  [[nodiscard]] Matrix rows_of(Index point, bool has_friction) const {
    Matrix result = Matrix(rows.gap_operator).row(point);
    if (!has_friction) return result;
    result.conservativeResize(d, Eigen::NoChange);
    result.bottomRows(d - 1) = Matrix(rows.tangential_trace).middleRows(point * (d - 1), d - 1);
    return result;
  }
  [[nodiscard]] Matrix columns_of(Index point, bool has_friction) const {
    if (point % 2 == 1) return rows_of(point, has_friction);
    Matrix result = Matrix::Zero(d, nodes * d);
    for (SparseRowMatrix::InnerIterator c(trace, point); c; ++c)
      result.middleCols(c.col() * d, d) = c.value() * Matrix::Identity(d, d);
    return result;
  }
};

Matrix stack(const std::vector<Matrix>& parts) {
  Matrix result(0, parts.front().cols());
  for (const Matrix& part : parts) {
    result.conservativeResize(result.rows() + part.rows(), Eigen::NoChange);
    result.bottomRows(part.rows()) = part;
  }
  return result;
}

TEST(RotatingRows, AreThoseOfConstantColumnsInOtherDirections) {
  TurningPoints points;
  const auto has_friction = [](Index point) { return point != 2 && point != 3; };
  RotatingRows turned;
  for (Index i = 0; i < TurningPoints::points; ++i) turned.append(points.rows, i, has_friction(i) ? 3 : 1, i % 2 == 0);
  ASSERT_TRUE(turned.any());
  const Matrix some =
      Matrix::NullaryExpr(TurningPoints::nodes * 3, TurningPoints::nodes * 3, [&] { return points.number(); });
  const Matrix compliance = some * some.transpose();
  for (int turn = 0; turn < 3; ++turn) {
    std::vector<Matrix> h_parts, e_parts;
    for (Index i = 0; i < TurningPoints::points; ++i) {
      turned.read_directions(points.rows, i, std::size_t(i));
      h_parts.push_back(points.rows_of(i, has_friction(i)));
      e_parts.push_back(points.columns_of(i, has_friction(i)));
    }
    const Matrix h = stack(h_parts), e = stack(e_parts);
    ASSERT_EQ(turned.size(), e.rows());
    const Matrix w = turned.product(e * compliance * e.transpose());
    const Matrix expected = h * compliance * h.transpose();
    EXPECT_LE((w - expected).cwiseAbs().maxCoeff(), 1e-14 * expected.cwiseAbs().maxCoeff());
    EXPECT_TRUE(w == w.transpose());
    const Vector motion = Vector::NullaryExpr(h.cols(), [&] { return points.number(); });
    Vector result;
    turned.rotate(e * motion, result);
    EXPECT_LE((result - h * motion).norm(), 1e-14 * motion.norm());
    const Vector reaction = Vector::NullaryExpr(h.rows(), [&] { return points.number(); });
    turned.rotate_back(reaction, result);
    EXPECT_LE((e.transpose() * result - h.transpose() * reaction).norm(), 1e-14 * reaction.norm());
    points.turn();
  }
  turned.clear();
  EXPECT_FALSE(turned.any());
  EXPECT_EQ(turned.size(), 0);
}

}  // namespace
}  // namespace ricochet
