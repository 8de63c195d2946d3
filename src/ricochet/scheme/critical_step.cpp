#include "ricochet/scheme/critical_step.hpp"

#include <cmath>
#include <limits>

#include "ricochet/linear_algebra/largest_eigenvalue.hpp"

namespace ricochet {

Vector inverse_root_mass(const SemidiscreteProblem& problem, int& exponent) {
  Vector inverse_root = problem.mass.diagonal();
  problem.ranks->accumulate(inverse_root);
  for (const Index dof : problem.supports.dofs()) inverse_root[dof] = 0.0;
  const double heaviest = problem.ranks->maximum(inverse_root.size() > 0 ? inverse_root.maxCoeff() : 0.0);
  exponent = 0;
  if (!(heaviest > 0.0)) return Vector::Zero(inverse_root.size());
  std::frexp(heaviest, &exponent);
  for (double& m : inverse_root) m = m > 0.0 ? 1.0 / std::sqrt(std::ldexp(m, -exponent)) : 0.0;
  return inverse_root;
}

double bound_frequency_squared(const SemidiscreteProblem& problem, const Vector& at) {
  int exponent = 0;
  const Vector inverse_root = inverse_root_mass(problem, exponent);
  if (!problem.ranks->any(!inverse_root.isZero(0.0))) return 0.0;
  const InternalForce& elastic = *problem.internal_force;
  NodeMatrix tangent;
  if (!elastic.is_linear()) tangent = NodeMatrix(elastic.tangent(at), problem.dimension);
  Vector displacement, force;
  const auto multiply = [&](const Vector& x, Vector& y) {
    displacement = inverse_root.cwiseProduct(x);
    elastic.is_linear() ? elastic.evaluate(displacement, force) : tangent.multiply(displacement, force);
    problem.ranks->accumulate(force);
    y = inverse_root.cwiseProduct(force);
  };
  const EigenvalueBounds bounds =
      bound_largest_eigenvalue(inverse_root.size(), multiply, frequency_spread, *problem.ranks, problem.dimension);
  return std::ldexp(bounds.upper, -exponent);
}

double central_difference_limit(const SemidiscreteProblem& problem, const Vector& displacement) {
  const double bound = bound_frequency_squared(problem, displacement);
  return bound > 0.0 ? 2.0 / std::sqrt(bound) : std::numeric_limits<double>::infinity();
}

}  // namespace ricochet
