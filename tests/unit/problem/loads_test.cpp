#include "ricochet/problem/loads.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include <Eigen/Geometry>
#include <tuple>
#include <utility>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/problem/internal_force.hpp"
#include "support/box_mesh.hpp"

namespace ricochet::test_support {
namespace {

TEST(Loads, AreTheSumOfTheirParts) {
  Loads loads(3);
  Vector load;
  EXPECT_FALSE(loads.varies());
  loads.total(1.0, load);
  EXPECT_EQ(load, Vector::Zero(3));

  loads.add_constant(Vector::Constant(3, 2.0));
  loads.add_constant(Vector::Unit(3, 0));
  EXPECT_FALSE(loads.varies());
  EXPECT_EQ(loads.constant(), Vector(Vector::Constant(3, 2.0) + Vector::Unit(3, 0)));

  loads.add_separable(Vector::Unit(3, 1), Expression("4*t"));
  EXPECT_TRUE(loads.varies());
  loads.add_general([](double time, Vector& to) { to[2] += time * time; });
  loads.varying(3.0, load);
  EXPECT_EQ(load, Vector(Eigen::Vector3d(0.0, 12.0, 9.0)));
  loads.total(3.0, load);
  EXPECT_EQ(load, Vector(Eigen::Vector3d(3.0, 14.0, 11.0)));
  loads.total(0.0, load);  // the previous instant leaves no trace
  EXPECT_EQ(load, loads.constant());
}

TEST(Loads, AGeneralPartAloneVaries) {
  Loads loads(2);
  loads.add_general([](double, Vector& to) { to[0] += 1.0; });
  EXPECT_TRUE(loads.varies());
}

TEST(Loads, PassOnTheErrorOfAnAmplitude) {
  Loads loads(1);
  loads.add_separable(Vector::Ones(1), Expression("1/(1-t)"));
  Vector load;
  loads.total(0.0, load);
  EXPECT_EQ(load[0], 1.0);
  EXPECT_THROW(loads.total(1.0, load), Error);
}

TEST(Supports, AreSortedByDof) {
  Supports supports;
  EXPECT_TRUE(supports.add(7, Expression("t")));
  EXPECT_TRUE(supports.add(2, Expression("3*t")));
  EXPECT_TRUE(supports.add(4, Expression("t")));
  supports.finish();
  EXPECT_EQ(supports.dofs(), (std::vector<Index>{2, 4, 7}));
  Vector values;
  supports.values(2.0, values);
  EXPECT_EQ(values, Vector(Eigen::Vector3d(6.0, 2.0, 2.0)));
  EXPECT_TRUE(supports.contains(4));
  EXPECT_FALSE(supports.contains(3));
  EXPECT_EQ(supports.expression(2).text(), "3*t");
  EXPECT_EQ(supports.expression(7).text(), "t");
}

TEST(Supports, KeepTheFirstValueOfADof) {
  Supports supports;
  EXPECT_TRUE(supports.add(1, Expression("5")));
  EXPECT_FALSE(supports.add(1, Expression("6")));
  supports.finish();
  EXPECT_EQ(supports.size(), 1);
  Vector values;
  supports.values(0.0, values);
  EXPECT_EQ(values[0], 5.0);
  EXPECT_EQ(supports.expression(1).text(), "5");
}

/// One formula may occur twice with different parameters.
TEST(Supports, TellFormulasApartByTheirParameters) {
  Supports supports;
  supports.add(0, Expression("a*t", {{"a", 1.0}}));
  supports.add(1, Expression("a*t", {{"a", 2.0}}));
  supports.add(2, Expression("a*t", {{"a", 2.0}}));
  supports.finish();
  Vector values;
  supports.values(3.0, values);
  EXPECT_EQ(values, Vector(Eigen::Vector3d(3.0, 6.0, 6.0)));
}

TEST(Supports, OfNoDofHaveNoValues) {
  Supports supports;
  supports.finish();
  Vector values = Vector::Ones(3), velocity, acceleration;
  supports.values(1.0, values);
  supports.derivatives(0.0, 0.1, velocity, acceleration);
  EXPECT_EQ(values.size(), 0);
  EXPECT_EQ(velocity.size(), 0);
  EXPECT_EQ(acceleration.size(), 0);
}

TEST(Supports, DerivativesAreExactForParabolas) {
  Supports supports;
  supports.add(0, Expression("3 - 2*t + 5*t^2"));
  supports.finish();
  Vector velocity, acceleration;
  supports.derivatives(0.5, 0.25, velocity, acceleration);
  EXPECT_NEAR(velocity[0], 3.0, 1e-13);
  EXPECT_NEAR(acceleration[0], 10.0, 1e-12);
}

TEST(Supports, DerivativesAreOfSecondOrder) {
  Supports supports;
  supports.add(0, Expression("sin(3*t + 0.4)"));
  supports.finish();
  double previous_velocity = 0.0, previous_acceleration = 0.0;
  for (const double spacing : {0.02, 0.01, 0.005}) {
    Vector velocity, acceleration;
    supports.derivatives(0.0, spacing, velocity, acceleration);
    const double velocity_error = std::abs(velocity[0] - 3.0 * std::cos(0.4));
    const double acceleration_error = std::abs(acceleration[0] + 9.0 * std::sin(0.4));
    if (previous_velocity > 0.0) {
      EXPECT_NEAR(std::log2(previous_velocity / velocity_error), 2.0, 0.15);
      EXPECT_NEAR(std::log2(previous_acceleration / acceleration_error), 2.0, 0.15);
    }
    previous_velocity = velocity_error;
    previous_acceleration = acceleration_error;
  }
}

/// Formulas may be undefined before the requested instant.
TEST(Supports, DerivativesLookForwardOnly) {
  Supports supports;
  supports.add(0, Expression("sqrt(t)^3"));
  supports.finish();
  Vector velocity, acceleration;
  EXPECT_NO_THROW(supports.derivatives(0.0, 1e-3, velocity, acceleration));
}

TEST(LinearElasticity, HasItsForceEnergyAndTangent) {
  // A spring of stiffness 2 along x between two nodes.
  Matrix dense = Matrix::Zero(4, 4);
  dense(0, 0) = dense(2, 2) = 2.0;
  dense(0, 2) = dense(2, 0) = -2.0;
  const SparseMatrix stiffness = dense.sparseView();
  Points nodes(2, 2);
  nodes << 0.0, 1.0, 0.0, 0.0;
  const LinearElasticity elasticity(stiffness, nodes);
  Vector force;
  const Vector u = Eigen::Vector4d(1.0, 5.0, 4.0, 5.0);
  elasticity.evaluate(u, force);
  EXPECT_EQ(force, Vector(Eigen::Vector4d(-6.0, 0.0, 6.0, 0.0)));
  EXPECT_EQ(elasticity.energy(u), 9.0);
  EXPECT_EQ(Matrix(elasticity.tangent()), Matrix(stiffness));
}

/// Springs along the lines between nodes: rigid motions cause no force.
SparseMatrix springs(const Points& nodes, const std::vector<std::pair<Index, Index>>& pairs) {
  const Index d = nodes.rows();
  std::vector<Eigen::Triplet<double>> entries;
  for (const auto& [i, j] : pairs) {
    const Vector along = (nodes.col(i) - nodes.col(j)).normalized();
    for (Index a = 0; a < d; ++a) {
      for (Index b = 0; b < d; ++b) {
        for (const auto& [row, column, sign] : {std::tuple{i, i, 1.0}, {j, j, 1.0}, {i, j, -1.0}, {j, i, -1.0}})
          entries.emplace_back(int(row * d + a), int(column * d + b), sign * along[a] * along[b]);
      }
    }
  }
  SparseMatrix result(nodes.size(), nodes.size());
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// A body of more nodes than the motion is fitted to, numbered row by row: a lattice of 8 × 16 × 64.
TEST(RigidMotion, OfManyNodesIsTakenOut) {
  const Index count = 8 * 16 * 64;
  Points nodes(3, count);
  for (Index i = 0; i < count; ++i) nodes.col(i) << double(i % 8), double(i / 8 % 16), double(i / 128);
  std::vector<std::pair<Index, Index>> chain;
  for (Index i = 0; i + 1 < count; ++i) chain.emplace_back(i, i + 1);
  const RigidMotion rigid(nodes, springs(nodes, chain));
  const Eigen::Vector3d axis(0.3, -0.2, 0.7), travel(30.0, -10.0, 20.0);
  Vector displacement(3 * count), deformation;
  for (Index i = 0; i < count; ++i) displacement.segment(3 * i, 3) = travel + axis.cross(Eigen::Vector3d(nodes.col(i)));
  rigid.remove(displacement, deformation);
  EXPECT_LT(deformation.lpNorm<Eigen::Infinity>(), 1e-13);
  // A strain is unchanged, and is so small that a fit to few nodes would alter it visibly.
  for (Index i = 0; i < count; ++i) displacement[3 * i] += 1e-6 * nodes(0, i);
  rigid.remove(displacement, deformation);
  EXPECT_LT(deformation.lpNorm<Eigen::Infinity>(), 1e-5);
  for (Index i = 1; i < count; ++i) {
    const Eigen::Vector3d edge = nodes.col(i) - nodes.col(0);
    const Eigen::Vector3d change = deformation.segment(3 * i, 3) - deformation.segment(0, 3);
    ASSERT_NEAR(edge.dot(change), 1e-6 * edge[0] * edge[0], 1e-12) << i;
  }
}

TEST(RigidMotion, LeavesTheDeformationOfEachBody) {
  // Two bodies of d + 1 nodes, each with its own rigid motion, and a deformation.
  for (const Index d : {Index{2}, Index{3}}) {
    const Index count = d + 1;
    Points nodes = Points::Random(d, 2 * count);
    std::vector<std::pair<Index, Index>> pairs;
    for (const Index first : {Index{0}, count}) {
      for (Index i = first; i < first + count; ++i) {
        for (Index j = first; j < i; ++j) pairs.emplace_back(i, j);
      }
    }
    const RigidMotion rigid(nodes, springs(nodes, pairs));
    Vector displacement(2 * count * d), deformation;
    for (Index i = 0; i < 2 * count; ++i) {
      const double body = i < count ? 1.0 : -2.0;
      Eigen::Vector3d x = Eigen::Vector3d::Zero();
      x.head(d) = nodes.col(i);
      const Eigen::Vector3d axis = d == 2 ? Eigen::Vector3d(0.0, 0.0, 0.7) : Eigen::Vector3d(0.3, -0.2, 0.7);
      displacement.segment(i * d, d) = (body * Eigen::Vector3d(3.0, -1.0, 2.0) + body * axis.cross(x)).head(d);
    }
    rigid.remove(displacement, deformation);
    EXPECT_LT(deformation.lpNorm<Eigen::Infinity>(), 1e-14) << "rigid motions are taken out";
    // The removed part is rigid: distances change by the same amount with and without it.
    const Vector random = Vector::Random(2 * count * d);
    rigid.remove(random + displacement, deformation);
    for (const Index first : {Index{0}, count}) {
      for (Index i = first; i < first + count; ++i) {
        for (Index j = first; j < i; ++j) {
          const Vector edge = nodes.col(i) - nodes.col(j);
          const auto stretch = [&](const Vector& u) { return edge.dot(u.segment(i * d, d) - u.segment(j * d, d)); };
          EXPECT_NEAR(stretch(deformation), stretch(random), 1e-13);
        }
      }
    }
  }
}

/// The force is K U with the K of the operators, even if rigid rotations are not in the kernel of K (linear functions
/// on curved cells).
TEST(LinearElasticity, IsThatOfItsTangentOnCurvedCells) {
  for (const int d : {2, 3}) {
    for (const int degree : {1, 2}) {
      const auto test = make_meshed_body(make_box_mesh({d == 2 ? CellShape::triangle : CellShape::tetrahedron,
                                                        std::vector<int>(std::size_t(d), 4), 2, 0.1, swirl_map(0.05)}),
                                         degree);
      const SparseMatrix stiffness = assemble_stiffness(test->body, node_graph(test->space));
      const LinearElasticity elasticity(stiffness, test->space.nodes);
      const Vector u = interpolate(test->space, [&](const Vector& x) {
        Vector value = 0.1 * x.cwiseProduct(x);
        value[0] -= 3.0 * x[1];
        value[1] += 3.0 * x[0];
        return value;
      });
      Vector force;
      elasticity.evaluate(u, force);
      const Vector terms = stiffness.cwiseAbs() * u.cwiseAbs();
      EXPECT_LT((force - stiffness * u).lpNorm<Eigen::Infinity>(), 1e-14 * terms.lpNorm<Eigen::Infinity>());
      EXPECT_NEAR(elasticity.energy(u), 0.5 * u.dot(stiffness * u), 1e-14 * u.cwiseAbs().dot(terms));
      // From the known force: also far from the start, where U alone would leave no digits.
      const double energy = elasticity.energy(u);
      const double rounding = 1e-15 * u.cwiseAbs().dot(terms);
      EXPECT_NEAR(elasticity.energy(u, force), energy, rounding);
      Vector far = u;
      for (Index i = 0; i < far.size(); ++i) far[i] += 1e9;
      elasticity.evaluate(far, force);
      EXPECT_NEAR(elasticity.energy(far, force), elasticity.energy(far), rounding);
    }
  }
}

}  // namespace
}  // namespace ricochet::test_support
