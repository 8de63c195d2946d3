#include "ricochet/problem/ground_springs.hpp"

#include <gtest/gtest.h>

#include "ricochet/problem/finite_elasticity.hpp"
#include "support/bent_body.hpp"

/// @file Springs between dofs and the ground, beside an elastic body.
namespace ricochet::test_support {
namespace {

TEST(GroundSprings, TheirTangentIsTheDerivativeOfTheirForce) {
  const auto body = make_bent_body({CellShape::triangle, 1, 1}, PlaneState::strain);
  body->body.materials[0].law = make_material_law("neo-hookean", {{"lambda", 1.3}, {"mu", 0.8}});
  const auto alone = std::make_shared<FiniteElasticity>(body->body, node_graph(body->space));
  Vector stiffness = Vector::Zero(body->space.dof_count());
  stiffness[3] = 0.7;
  stiffness[4] = 2.1;
  const GroundSprings sum(alone, stiffness);
  const Vector middle = random_displacement(*body, 0.02, 1), increment = random_displacement(*body, 0.02, 2);
  const Vector along = random_displacement(*body, 1.0, 3);
  const PathRules rules = sum.path_rules();
  // Springs are linear, so that the difference of their forces is the derivative.
  const auto of_springs = [&](const Vector& at) {
    Vector with, without;
    sum.path_force(at, increment, rules, with);
    alone->path_force(at, increment, rules, without);
    return Vector(with - without);
  };
  const Vector slope = of_springs(middle + 0.01 * along) - of_springs(middle);
  const PathVariation variation{0.01, 3.0};
  const SparseMatrix with = sum.path_tangent(middle, increment, rules, variation),
                     without = alone->path_tangent(middle, increment, rules, variation);
  EXPECT_LT(((with - without) * along - slope).norm(), 1e-13);
  EXPECT_GT(slope.norm(), 1e-3);
  const Vector product = (sum.tangent(middle) - alone->tangent(middle)) * along;
  EXPECT_LT((product - 100.0 * slope).norm(), 1e-11);
}

}  // namespace
}  // namespace ricochet::test_support
