#include "ricochet/scheme/response/penalty_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

/// Force of a point, without cancellation, and its derivative with respect to the gap at the end.
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

/// Returns the forces at which the linearized law and gap = free + W r agree; `motion` is gap − free.
Vector newton_forces(const Matrix& w, const Vector& law, const Vector& slope, const Vector& motion) {
  std::vector<Index> pressing;
  for (Index i = 0; i < slope.size(); ++i) {
    if (slope[i] != 0.0) pressing.push_back(i);
  }
  Vector result = Vector::Zero(slope.size());
  if (pressing.empty()) return result;
  const Vector compliance = -slope(pressing).cwiseInverse();
  Matrix tangent = w(pressing, pressing);
  tangent.diagonal() += compliance;
  result(pressing) = SmallCholesky(tangent).solve(compliance.cwiseProduct(law(pressing)) + motion(pressing));
  return result;
}

}  // namespace

double penalty_energy(const Vector& stiffness, const Vector& gap) {
  return 0.5 * stiffness.dot(gap.cwiseMin(0.0).cwiseAbs2());
}

/// Newton's method for r = f(free + W r), the minimum of a convex function whose derivative is W (r − f). The unknown
/// is r, with W + diag(−1/slope) of the pressing points: with gaps as unknowns, a stiffness much larger than W⁻¹ would
/// reduce r to the rounding of gaps times that stiffness.
Vector penalty_forces(const Matrix& w, const PenaltyPoints& points) {
  constexpr int most_iterations = 200, most_halvings = 50;
  constexpr double rounding = 4.0 * std::numeric_limits<double>::epsilon(), good_enough = 1e-12;
  const Index count = points.free.size();
  Vector gap = points.free, r = Vector::Zero(count), law(count), slope(count);
  const auto evaluate = [&](const Vector& at) {
    for (Index i = 0; i < count; ++i) {
      const PenaltyForce here = penalty_force(points.stiffness[i], points.before[i], at[i]);
      law[i] = here.force;
      slope[i] = here.slope;
    }
  };
  double last = std::numeric_limits<double>::infinity();
  evaluate(gap);
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Vector change = newton_forces(w, law, slope, gap - points.free) - r;
    const Vector motion = w * change;
    const double size = std::max(gap.lpNorm<Eigen::Infinity>(), points.free.lpNorm<Eigen::Infinity>());
    const double moved = size > 0.0 ? motion.lpNorm<Eigen::Infinity>() / size : 0.0;
    // The law at a gap has the rounding of the gap times the stiffness; the change does not.
    if (moved <= rounding || (moved <= good_enough && moved >= 0.5 * last)) return (r + change).cwiseMax(0.0);
    last = moved;
    const double descent = -motion.dot(r - law);
    double part = 1.0;
    for (int halving = 0; halving < most_halvings; ++halving, part *= 0.5) {
      evaluate(gap + part * motion);
      if (motion.dot(r + part * change - law) <= 0.5 * descent) break;
    }
    r += part * change;
    gap = points.free + w * r;
    evaluate(gap);
  }
  throw Error(ErrorKind::not_converged, "the penalty forces of contact were not found");
}

}  // namespace ricochet
