#include "ricochet/scheme/critical_step.hpp"

#include <cmath>
#include <limits>

#include "ricochet/linear_algebra/largest_eigenvalue.hpp"

namespace ricochet {

double bound_frequency_squared(const SemidiscreteProblem& problem) {
  require_linear(*problem.internal_force, "the bound of the highest frequency");
  Vector inverse_root = problem.mass.diagonal();
  for (const Index dof : problem.supports.dofs()) inverse_root[dof] = 0.0;
  const double heaviest = problem.ranks->maximum(inverse_root.size() > 0 ? inverse_root.maxCoeff() : 0.0);
  if (!(heaviest > 0.0)) return 0.0;
  // Roots are taken of masses brought near 1 by a power of two: units that differ by powers of two give the same bits.
  int exponent = 0;
  std::frexp(heaviest, &exponent);
  for (double& m : inverse_root) m = m > 0.0 ? 1.0 / std::sqrt(std::ldexp(m, -exponent)) : 0.0;
  Vector displacement, force;
  const auto multiply = [&](const Vector& x, Vector& y) {
    displacement = inverse_root.cwiseProduct(x);
    problem.internal_force->evaluate(displacement, force);
    y = inverse_root.cwiseProduct(force);
  };
  const EigenvalueBounds bounds = bound_largest_eigenvalue(inverse_root.size(), multiply);
  return std::ldexp(bounds.upper, -exponent);
}

double central_difference_limit(const SemidiscreteProblem& problem) {
  const double bound = bound_frequency_squared(problem);
  return bound > 0.0 ? 2.0 / std::sqrt(bound) : std::numeric_limits<double>::infinity();
}

}  // namespace ricochet
