#include "ricochet/solver/coulomb_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();
using Tangent = Eigen::Vector2d;  ///< the second component is zero in two dimensions

/// The point with its normal eliminated, in the principal axes of what remains:
///   (diag(stiffness) + κ) ρ_T = right,   r_N = normal − slope·ρ_T.
struct ReducedPoint {
  Tangent stiffness, right, slope, axis;  ///< axis: the first principal one
  double normal = 0.0;

  [[nodiscard]] Tangent tangential(double kappa) const {
    Tangent result;
    for (Index k = 0; k < 2; ++k) {
      // No stiffness and nothing to resist: the reaction of least size is zero.
      result[k] = right[k] == 0.0 ? 0.0 : right[k] / (stiffness[k] + kappa);
    }
    return result;
  }
  [[nodiscard]] double normal_reaction(const Tangent& tangential) const { return normal - slope.dot(tangential); }
  /// From the principal axes to those of the point.
  [[nodiscard]] Tangent to_point(const Tangent& t) const {
    return {axis[0] * t[0] - axis[1] * t[1], axis[1] * t[0] + axis[0] * t[1]};
  }
  [[nodiscard]] Tangent to_axes(const Tangent& t) const {
    return {axis[0] * t[0] + axis[1] * t[1], -axis[1] * t[0] + axis[0] * t[1]};
  }
};

/// Eigenvalues of a symmetric 2×2 matrix and the first axis.
void find_principal_axes(const Eigen::Matrix2d& matrix, ReducedPoint& reduced) {
  const double half_difference = 0.5 * (matrix(0, 0) - matrix(1, 1));
  const double coupling = matrix(0, 1);
  const double mean = 0.5 * (matrix(0, 0) + matrix(1, 1));
  const double radius = std::sqrt(half_difference * half_difference + coupling * coupling);
  reduced.axis = Tangent(1.0, 0.0);
  reduced.stiffness = Tangent(matrix(0, 0), matrix(1, 1));
  if (std::abs(coupling) <= epsilon * std::abs(mean)) return;
  const Tangent direction = half_difference >= 0.0 ? Tangent(half_difference + radius, coupling)
                                                   : Tangent(coupling, radius - half_difference);
  reduced.axis = direction / direction.norm();
  reduced.stiffness = Tangent(mean + radius, mean - radius);
}

ReducedPoint reduce(const PointMatrix& w, const PointVector& q) {
  ReducedPoint reduced;
  Tangent slope = Tangent::Zero();
  Tangent right = Tangent::Zero();
  Eigen::Matrix2d block = Eigen::Matrix2d::Zero();
  const Index tangents = q.size() - 1;
  reduced.normal = -q[0] / w(0, 0);
  for (Index k = 0; k < tangents; ++k) {
    slope[k] = w(0, k + 1) / w(0, 0);
    right[k] = -(q[k + 1] + w(k + 1, 0) * reduced.normal);
    for (Index l = 0; l < tangents; ++l) block(k, l) = w(k + 1, l + 1) - slope[k] * w(0, l + 1);
  }
  find_principal_axes(block, reduced);
  const double negligible = 16.0 * epsilon * w.trace();
  const Tangent sizes = reduced.to_axes(right).cwiseAbs();
  reduced.right = reduced.to_axes(right);
  reduced.slope = reduced.to_axes(slope);
  for (Index k = 0; k < 2; ++k) {
    if (reduced.stiffness[k] > negligible) continue;
    reduced.stiffness[k] = 0.0;
    if (sizes[k] <= 16.0 * epsilon * q.lpNorm<Eigen::Infinity>()) reduced.right[k] = 0.0;
  }
  return reduced;
}

/// A root of a function that is negative (or minus infinite) at zero and positive far away: regula falsi with the
/// Illinois correction, whose bracket closes from both sides; halved where that is no number.
template <typename Function>
double find_root(const Function& function, double start) {
  double low = 0.0;
  double high = start;
  double value_low = function(low);
  double value_high = function(high);
  for (int k = 0; k < 500 && !(value_high >= 0.0); ++k) {
    low = high;
    value_low = value_high;
    high *= 4.0;
    value_high = function(high);
  }
  int side = 0;
  for (int k = 0; k < 300 && value_high != 0.0 && high - low > 2.0 * epsilon * high; ++k) {
    const double secant = low - value_low * ((high - low) / (value_high - value_low));
    const bool usable = k % 16 != 15 && secant > low && secant < high;
    const double middle = usable ? secant : low + 0.5 * (high - low);
    const double value = function(middle);
    if (value >= 0.0) {
      high = middle;
      value_high = value;
      if (side == 1) value_low *= 0.5;
      side = 1;
    } else {
      low = middle;
      value_low = value;
      if (side == -1) value_high *= 0.5;
      side = -1;
    }
  }
  return high;
}

PointVector assemble(Index size, double normal, const Tangent& tangential) {
  PointVector result(size);
  result[0] = normal;
  for (Index k = 1; k < size; ++k) result[k] = tangential[k - 1];
  return result;
}

PointVector solve_coulomb(const ReducedPoint& reduced, const CoulombPoint& point) {
  const Index size = point.size;
  const Tangent stick = reduced.tangential(0.0);
  const double stick_normal = reduced.normal_reaction(stick);
  if (stick.allFinite() && stick_normal >= 0.0 && stick.norm() <= point.friction_limit(stick_normal))
    return assemble(size, stick_normal, reduced.to_point(stick));
  // (b − |ρ_T|)/|ρ_T|, nearly linear in κ.
  const auto reserve = [&](double kappa) {
    const Tangent t = reduced.tangential(kappa);
    const double length = t.norm();
    if (!std::isfinite(length)) return -std::numeric_limits<double>::infinity();
    const double normal = reduced.normal_reaction(t);
    return (point.is_bounded(normal) ? point.bound : point.coefficient * normal) / length - 1.0;
  };
  const double limit = point.friction_limit(reduced.normal);
  const double length = reduced.right.norm();
  if (!(limit > 0.0) || !(length > 0.0)) return assemble(size, reduced.normal, Tangent::Zero());
  const Tangent at_root = reduced.tangential(find_root(reserve, length / limit));
  const Tangent direction = at_root / at_root.norm();
  if (point.is_bounded(reduced.normal_reaction(at_root))) {
    const Tangent bounded = point.bound * direction;
    return assemble(size, reduced.normal_reaction(bounded), reduced.to_point(bounded));
  }
  // On the cone exactly: r_N from its equation along this direction.
  const double coefficient = point.coefficient;
  const double divisor = 1.0 + coefficient * reduced.slope.dot(direction);
  if (!direction.allFinite() || !(divisor > 0.0)) return assemble(size, reduced.normal, Tangent::Zero());
  const double normal = reduced.normal / divisor;
  return assemble(size, normal, reduced.to_point(direction * (coefficient * normal)));
}

PointVector solve_tresca(const ReducedPoint& reduced, Index size, double bound) {
  double kappa = 0.0;
  Tangent tangential = reduced.tangential(0.0);
  if (!tangential.allFinite() || tangential.norm() > bound) {
    const auto reserve = [&](double k) {
      const double length = reduced.tangential(k).norm();
      return std::isfinite(length) ? bound / length - 1.0 : -std::numeric_limits<double>::infinity();
    };
    kappa = find_root(reserve, reduced.right.norm() / bound);
    tangential = reduced.tangential(kappa);
    tangential *= bound / tangential.norm();
  }
  const double normal = reduced.normal_reaction(tangential);
  if (normal > 0.0 || reduced.normal <= 0.0) return assemble(size, normal, reduced.to_point(tangential));
  // Friction alone carries the point: grazing, with as much friction as leaves r_N = 0.
  const auto pressing = [&](double k) { return reduced.normal_reaction(reduced.tangential(kappa + k)); };
  const double start = kappa > 0.0 ? kappa : reduced.stiffness.maxCoeff();
  return assemble(size, 0.0, reduced.to_point(reduced.tangential(kappa + find_root(pressing, start))));
}

}  // namespace

PointVector solve_point(const CoulombPoint& point, const PointMatrix& w, const PointVector& q, bool pressed) {
  const PointVector open = PointVector::Zero(point.size);
  if (!(w(0, 0) > 0.0)) return open;
  if (point.size > 1 && point.is_tresca() && pressed && q[0] >= 0.0) {
    const PointVector closed = solve_tresca(reduce(w, q), point.size, point.bound);
    return closed[0] > 0.0 ? closed : open;
  }
  if (!(q[0] < 0.0)) return open;
  if (!point.has_friction()) return assemble(point.size, -q[0] / w(0, 0), Tangent::Zero());
  const ReducedPoint reduced = reduce(w, q);
  return point.is_tresca() ? solve_tresca(reduced, point.size, point.bound) : solve_coulomb(reduced, point);
}

namespace {

/// |ρ_T − P_b(ρ_T − c u_T)|/c.
double tangential_residual(const CoulombPoint& point, const PointVector& reaction, const PointVector& motion,
                           double b) {
  const PointVector rho = reaction.tail(point.size - 1);
  const PointVector tau = rho - point.step * motion.tail(point.size - 1);
  const double length = tau.norm();
  // Inside the disc the difference is c u_T itself, without the cancellation.
  if (length <= b) return motion.tail(point.size - 1).norm();
  return (rho - tau * (b / length)).norm() / point.step;
}

}  // namespace

double natural_residual(const CoulombPoint& point, const PointVector& reaction, const PointVector& motion) {
  const double normal = std::abs(std::min(motion[0], reaction[0] / point.step));
  if (point.size == 1) return normal;
  double tangential = tangential_residual(point, reaction, motion, point.friction_limit(reaction[0]));
  if (point.is_tresca() && reaction[0] == 0.0) {
    // Grazing: any limit up to the bound, as long as u_N = 0.
    const double limit = std::min(point.bound, reaction.tail(point.size - 1).norm());
    tangential =
        std::min(tangential, std::max(std::abs(motion[0]), tangential_residual(point, reaction, motion, limit)));
  }
  return std::isfinite(motion.sum()) ? std::max(normal, tangential) : std::numeric_limits<double>::infinity();
}

}  // namespace ricochet
