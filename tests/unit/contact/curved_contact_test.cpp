#include "ricochet/contact/curved_contact.hpp"

#include <gtest/gtest.h>

/// @file Rows that follow the motion: derivatives of the gaps at the current positions, with revisions that mark
/// changed rows.
namespace ricochet {
namespace {

/// Two nodes and two contact points in a bowl; the second point is between the nodes.
class TwoPoints : public testing::TestWithParam<Index> {
 protected:
  TwoPoints() {
    using Numbers = std::vector<double>;
    const Index d = GetParam();
    obstacle_ = make_obstacle(
        "sphere", {{"centre", Numbers(std::size_t(d), 0.0)}, {"radius", 2.0}, {"side", std::string("inside")}},
        Vector::Constant(d, 0.25));
    CurvedContactData data;
    data.obstacles.push_back(obstacle_.get());
    data.node_positions = Points::Zero(d, 2);
    data.node_positions.row(d - 1).setConstant(-1.9);
    data.node_positions(0, 1) = 0.4;
    data.node_normals = data.node_positions;
    data.trace.resize(2, 2);
    data.trace.insert(0, 0) = 1.0;
    data.trace.insert(1, 0) = 0.25;
    data.trace.insert(1, 1) = 0.75;
    data.trace.makeCompressed();
    for (Index i = 0; i < 2; ++i) {
      data.points.push_back({i, 0, {true, true, true}});
      data.nodes.push_back({i, i, 0});
    }
    rows_.normals = Points::Zero(d, 2);
    rows_.tangents.resize(2);
    rows_.slips.assign(std::size_t(2 * (d - 1)), 1);
    rows_.gap_rounding = Vector::Constant(2, 1e-15);
    rows_.gap = Vector::Zero(2);
    rows_.revision.assign(2, 0);
    rows_.gap_operator.resize(2, 2 * d);
    rows_.tangential_trace.resize(2 * (d - 1), 2 * d);
    for (Index i = 0; i < 2; ++i) {
      for (SparseRowMatrix::InnerIterator entry(data.trace, i); entry; ++entry) {
        for (Index k = 0; k < d; ++k) {
          rows_.gap_operator.insert(i, entry.col() * d + k) = 1.0;
          for (Index j = 0; j < d - 1; ++j) rows_.tangential_trace.insert(i * (d - 1) + j, entry.col() * d + k) = 1.0;
        }
      }
    }
    rows_.gap_operator.makeCompressed();
    rows_.tangential_trace.makeCompressed();
    geometry_ = make_curved_contact(std::move(data));
  }
  [[nodiscard]] Vector gaps(const Vector& displacement, double time) const {
    Vector result(2);
    geometry_->gaps(displacement, time, result);
    return result;
  }

  std::unique_ptr<Obstacle> obstacle_;
  std::unique_ptr<ContactGeometry> geometry_;
  ContactRows rows_;
};

TEST_P(TwoPoints, HaveRowsThatAreTheDerivativesOfTheirGaps) {
  const Index d = GetParam(), dofs = 2 * d;
  Vector displacement = 0.1 * Vector::LinSpaced(dofs, -1.0, 1.0);
  constexpr double time = 0.2, h = 1e-6;
  geometry_->update(displacement, time, nullptr, rows_);
  EXPECT_EQ(rows_.gap, gaps(displacement, time));
  for (Index dof = 0; dof < dofs; ++dof) {
    Vector ahead = displacement, behind = displacement;
    ahead[dof] += h;
    behind[dof] -= h;
    const Vector slope = (gaps(ahead, time) - gaps(behind, time)) / (2.0 * h);
    EXPECT_NEAR(rows_.gap_operator.coeff(0, dof), slope[0], 1e-9);
    EXPECT_NEAR(rows_.gap_operator.coeff(1, dof), slope[1], 1e-9);
  }
  // Motion along the surface changes no gap; directions are orthonormal.
  for (Index i = 0; i < 2; ++i) {
    const Points& tangents = rows_.tangents[std::size_t(i)];
    EXPECT_LE((tangents.transpose() * rows_.normals.col(i)).cwiseAbs().maxCoeff(), 1e-15);
    EXPECT_LE((tangents.transpose() * tangents - Matrix::Identity(d - 1, d - 1)).cwiseAbs().maxCoeff(), 1e-15);
  }
  const Vector slip = Vector(rows_.tangential_trace * Vector::Ones(dofs));
  EXPECT_NEAR(slip[0], rows_.tangents[0].col(0).sum(), 1e-15);
}

/// A motion of the obstacle changes gaps as the opposite motion of the body does.
TEST_P(TwoPoints, SeeTheObstacleMove) {
  const Vector still = Vector::Zero(2 * GetParam());
  constexpr double time = 0.3;
  const Vector moved = Vector::Constant(still.size(), -0.25 * time);
  EXPECT_LE((gaps(still, time) - gaps(moved, 0.0)).cwiseAbs().maxCoeff(), 1e-15);
}

TEST_P(TwoPoints, ChangeTheirRevisionWithTheirRowsAlone) {
  Vector displacement = Vector::Zero(2 * GetParam());
  geometry_->update(displacement, 0.0, nullptr, rows_);
  const std::vector<long> first = rows_.revision;
  geometry_->update(displacement, 0.0, nullptr, rows_);
  EXPECT_EQ(rows_.revision, first);
  // The first point depends only on the first node, which stays.
  displacement[GetParam()] = 0.05;
  displacement[2 * GetParam() - 1] = -1.0;
  geometry_->update(displacement, 0.0, nullptr, rows_);
  EXPECT_EQ(rows_.revision[0], first[0]);
  EXPECT_GT(rows_.revision[1], first[1]);
}

/// The normals and gaps that a checkpoint stores restore the rows to the bit.
TEST_P(TwoPoints, AreRestoredToTheBit) {
  const Vector displacement = 0.05 * Vector::LinSpaced(2 * GetParam(), -1.0, 1.0);
  geometry_->update(displacement, 0.1, nullptr, rows_);
  const ContactRows saved = rows_;
  geometry_->update(Vector::Zero(displacement.size()), 0.7, nullptr, rows_);
  ASSERT_NE(rows_.normals, saved.normals);
  geometry_->restore(saved.normals, saved.gap, Vector(), rows_);
  EXPECT_EQ(rows_.normals, saved.normals);
  EXPECT_EQ(rows_.gap, saved.gap);
  EXPECT_EQ(Matrix(rows_.gap_operator), Matrix(saved.gap_operator));
  EXPECT_EQ(Matrix(rows_.tangential_trace), Matrix(saved.tangential_trace));
}

INSTANTIATE_TEST_SUITE_P(Dimensions, TwoPoints, testing::Values(2, 3));

}  // namespace
}  // namespace ricochet
