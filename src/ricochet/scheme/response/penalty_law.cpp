#include "ricochet/scheme/response/penalty_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

/// Of a point, without cancellation: the force, and its derivative by the gap at the end.
struct PenaltyForce {
  double force, slope;
};

PenaltyForce penalty_force(double stiffness, double before, double after) {
  if (before <= 0.0 && after <= 0.0) return {-0.5 * stiffness * (before + after), -0.5 * stiffness};
  if (before > 0.0 && after > 0.0) return {0.0, 0.0};
  const double change = after - before;
  const double inside = before > 0.0 ? after : before;
  const double force = 0.5 * stiffness * inside * inside / std::abs(change);
  if (before > 0.0) return {force, 0.5 * stiffness * after * (2.0 * before - after) / (change * change)};
  return {force, -force / change};
}

}  // namespace

double penalty_energy(const Vector& stiffness, const Vector& gap) {
  return 0.5 * stiffness.dot(gap.cwiseMin(0.0).cwiseAbs2());
}

Vector penalty_forces(const Matrix& w, const PenaltyPoints& points) {
  constexpr int most_iterations = 200;
  constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon();
  const Index count = points.free.size();
  Vector gap = points.free, force(count), slope(count);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    for (Index i = 0; i < count; ++i) {
      const PenaltyForce law = penalty_force(points.stiffness[i], points.before[i], gap[i]);
      force[i] = law.force;
      slope[i] = law.slope;
    }
    const Vector error = gap - points.free - w * force;
    // I − W diag(slope), slope ≤ 0.
    Matrix tangent = -w * slope.asDiagonal();
    tangent.diagonal().array() += 1.0;
    const Vector change = PivotedLu(tangent).solve(error);
    const double size = std::max(gap.lpNorm<Eigen::Infinity>(), points.free.lpNorm<Eigen::Infinity>());
    if (change.lpNorm<Eigen::Infinity>() <= rounding * size) return force;
    gap -= change;
  }
  throw Error(ErrorKind::not_converged, "the penalty forces of contact were not found");
}

}  // namespace ricochet
