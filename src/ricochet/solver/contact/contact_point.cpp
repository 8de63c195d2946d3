#include "ricochet/solver/contact/contact_point.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

namespace {

using Tangent = Eigen::Vector2d;  ///< the second component is zero in two dimensions

Tangent to_point(const PointOperator& block, const Tangent& t) {
  return {block.axis[0] * t[0] - block.axis[1] * t[1], block.axis[1] * t[0] + block.axis[0] * t[1]};
}
Tangent to_axes(const PointOperator& block, const Tangent& t) {
  return {block.axis[0] * t[0] + block.axis[1] * t[1], -block.axis[1] * t[0] + block.axis[0] * t[1]};
}

/// Point with its normal eliminated: (diag(stiffness) + κ) r_T = right, r_N = normal − slope·r_T.
struct ReducedPoint {
  const PointOperator& block;
  Tangent right;
  double normal;

  [[nodiscard]] Tangent tangential(double kappa) const {
    Tangent result;
    for (Index k = 0; k < 2; ++k) {
      // Neither stiffness nor motion to resist: the reaction of least size is zero.
      result[k] = right[k] == 0.0 ? 0.0 : right[k] / (block.stiffness[k] + kappa);
    }
    return result;
  }
  [[nodiscard]] double normal_reaction(const Tangent& tangential) const { return normal - block.slope.dot(tangential); }
  [[nodiscard]] PaddedVector reaction(double normal_part, const Tangent& tangential) const {
    const Tangent t = to_point(block, tangential);
    return {normal_part, t[0], t[1]};
  }
};

ReducedPoint reduce(const PointOperator& block, const PaddedVector& q) {
  const double normal = -q[0] / block.normal;
  ReducedPoint reduced{block, Tangent::Zero(), normal};
  reduced.right = to_axes(block, -(q.tail<2>() + block.coupling * normal));
  // In a direction without stiffness, rounding requires no friction.
  const double negligible = 16.0 * machine_epsilon * q.lpNorm<Eigen::Infinity>();
  for (Index k = 0; k < 2; ++k) {
    if (block.stiffness[k] == 0.0 && std::abs(reduced.right[k]) <= negligible) reduced.right[k] = 0.0;
  }
  return reduced;
}

/// Finds a root of a function that is negative (or minus infinite) at zero and positive far away: regula falsi with the
/// Illinois correction, whose bracket closes from both sides; halved if the result is not finite.
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
  for (int k = 0; k < 300 && value_high != 0.0 && high - low > 2.0 * machine_epsilon * high; ++k) {
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

/// Finds κ at which F r_N = |r_T|: Newton's method on F r_N/|r_T| − 1, which is nearly linear in κ; without coupling
/// and with equal stiffnesses the start is the solution. Not finite or not positive if Newton's method fails.
double slip_by_newton(const ReducedPoint& reduced, double coefficient, double guess) {
  const double enough = guess >= 0.0 ? 1e-5 : 1e-9;
  const Tangent& s = reduced.block.stiffness;
  double kappa = guess;
  if (!(kappa >= 0.0))
    kappa = std::max(0.0, reduced.right.norm() / (coefficient * reduced.normal) - 0.5 * (s[0] + s[1]));
  for (int k = 0; k < 12; ++k) {
    const double first = s[0] + kappa, second = s[1] + kappa;
    const double inverse = 1.0 / (first * second);
    const Tangent rate(second * inverse, first * inverse);
    const Tangent t = reduced.right.cwiseProduct(rate);
    const Tangent descent = t.cwiseProduct(rate);
    const double square = t.squaredNorm();
    const double normal = reduced.normal_reaction(t);
    const double excess = coefficient * normal - std::sqrt(square);
    // |r_T|² d/dκ: of r_N it is |r_T|² slope·descent, of 1/|r_T| it is t·descent/|r_T|.
    const double slope = coefficient * (reduced.block.slope.dot(descent) * square + normal * t.dot(descent));
    const double step = excess * square / slope;
    kappa -= step;
    if (!(slope > 0.0) || !(kappa >= 0.0)) return -1.0;
    // Quadratic convergence: the error is now the square of the step, and the next call continues from here.
    if (std::abs(step) <= enough * (kappa + std::max(s[0], s[1]))) return kappa;
  }
  return -1.0;
}

/// Direction of slip under Coulomb's law without a bound, zero if it is not found.
Tangent slip_direction(const ReducedPoint& reduced, const ContactPoint& point, double& slip_stiffness) {
  const Tangent& right = reduced.right;
  const Tangent& s = reduced.block.stiffness;
  if (right[1] == 0.0 && s[0] > 0.0) return {right[0] < 0.0 ? -1.0 : 1.0, 0.0};
  const double kappa = slip_by_newton(reduced, point.coefficient, slip_stiffness);
  slip_stiffness = kappa;
  if (!(kappa >= 0.0)) return Tangent::Zero();
  const Tangent t(right[0] / (s[0] + kappa), right[1] / (s[1] + kappa));
  return t / t.norm();
}

PaddedVector solve_coulomb(const ReducedPoint& reduced, const ContactPoint& point, double& slip_stiffness) {
  const Tangent stick = reduced.tangential(0.0);
  const double stick_normal = reduced.normal_reaction(stick);
  if (stick.allFinite() && stick_normal >= 0.0 && stick.norm() <= point.friction_limit(stick_normal))
    return reduced.reaction(stick_normal, stick);
  if (point.bound == 0.0 && reduced.normal > 0.0) {
    const Tangent direction = slip_direction(reduced, point, slip_stiffness);
    const double divisor = 1.0 + point.coefficient * reduced.block.slope.dot(direction);
    if (divisor > 0.0 && direction[0] * direction[0] + direction[1] * direction[1] > 0.5) {
      // On the cone exactly: r_N from its equation along this direction.
      const double normal = reduced.normal / divisor;
      return reduced.reaction(normal, direction * (point.coefficient * normal));
    }
  }
  // (b − |r_T|)/|r_T|, nearly linear in κ.
  const auto reserve = [&](double kappa) {
    const Tangent t = reduced.tangential(kappa);
    const double length = t.norm();
    if (!std::isfinite(length)) return -std::numeric_limits<double>::infinity();
    const double normal = reduced.normal_reaction(t);
    return (point.is_bounded(normal) ? point.bound : point.coefficient * normal) / length - 1.0;
  };
  const double limit = point.friction_limit(reduced.normal);
  const double length = reduced.right.norm();
  if (!(limit > 0.0) || !(length > 0.0)) return {reduced.normal, 0.0, 0.0};
  const Tangent at_root = reduced.tangential(find_root(reserve, length / limit));
  const Tangent direction = at_root / at_root.norm();
  if (point.is_bounded(reduced.normal_reaction(at_root))) {
    const Tangent bounded = point.bound * direction;
    return reduced.reaction(reduced.normal_reaction(bounded), bounded);
  }
  // On the cone exactly: r_N from its equation along this direction.
  const double coefficient = point.coefficient;
  const double divisor = 1.0 + coefficient * reduced.block.slope.dot(direction);
  if (!direction.allFinite() || !(divisor > 0.0)) return {reduced.normal, 0.0, 0.0};
  const double normal = reduced.normal / divisor;
  return reduced.reaction(normal, direction * (coefficient * normal));
}

double squared(double value) { return value * value; }

/// Slips to the side against the slip without friction.
PaddedVector slip_in_two_dimensions(double coefficient, const PointOperator& block, const PaddedVector& q) {
  const double side = q[1] * block.normal > block.coupling[0] * q[0] ? -coefficient : coefficient;
  const double divisor = block.normal + side * block.coupling[0];
  if (!(divisor > 0.0)) return {-q[0] / block.normal, 0.0, 0.0};
  const double normal = -q[0] / divisor;
  return {normal, side * normal, 0.0};
}

PaddedVector solve_tresca(const ReducedPoint& reduced, double bound) {
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
  if (normal > 0.0 || reduced.normal <= 0.0) return reduced.reaction(normal, tangential);
  // Friction alone carries the point: grazing, with the friction that leaves r_N = 0.
  const auto pressing = [&](double k) { return reduced.normal_reaction(reduced.tangential(kappa + k)); };
  const double start = kappa > 0.0 ? kappa : reduced.block.stiffness.maxCoeff();
  return reduced.reaction(0.0, reduced.tangential(kappa + find_root(pressing, start)));
}

/// |r_T − P_b(r_T − c u_T)|/c.
double tangential_residual(double step, const Tangent& reaction, const Tangent& motion, double b) {
  const Tangent tau = reaction - step * motion;
  const double length = tau.norm();
  // Inside the disc the difference is c u_T itself, without the cancellation.
  if (length <= b) return motion.norm();
  return (reaction - tau * (b / length)).norm() / step;
}

}  // namespace

/// Computes the eigenvalues of the symmetric 2×2 matrix and the first axis.
PointOperator make_point_operator(const PointMatrix& w) {
  PointOperator result;
  result.normal = w(0, 0);
  result.inverse.setZero();
  result.block.setZero();
  result.block.topLeftCorner(w.rows(), w.cols()) = w;
  result.coupling.setZero();
  result.slope.setZero();
  result.stiffness.setZero();
  result.axis = Tangent(1.0, 0.0);
  const Index tangents = w.rows() - 1;
  if (tangents == 0) return result;
  Tangent slope = Tangent::Zero();
  Eigen::Matrix2d rest = Eigen::Matrix2d::Zero();
  for (Index k = 0; k < tangents; ++k) {
    result.coupling[k] = w(k + 1, 0);
    slope[k] = w(0, k + 1) / w(0, 0);
    for (Index l = 0; l < tangents; ++l) rest(k, l) = w(k + 1, l + 1) - slope[k] * w(0, l + 1);
  }
  const double half_difference = 0.5 * (rest(0, 0) - rest(1, 1));
  const double mean = 0.5 * (rest(0, 0) + rest(1, 1));
  const double radius = std::sqrt(half_difference * half_difference + rest(0, 1) * rest(0, 1));
  result.stiffness = Tangent(rest(0, 0), rest(1, 1));
  if (std::abs(rest(0, 1)) > machine_epsilon * std::abs(mean)) {
    const Tangent direction = half_difference >= 0.0 ? Tangent(half_difference + radius, rest(0, 1))
                                                     : Tangent(rest(0, 1), radius - half_difference);
    result.axis = direction / direction.norm();
    result.stiffness = Tangent(mean + radius, mean - radius);
  }
  const double negligible = 16.0 * machine_epsilon * w.trace();
  for (double& stiffness : result.stiffness) {
    if (!(stiffness > negligible)) stiffness = 0.0;
  }
  result.slope = to_axes(result, slope);
  // With the tangents eliminated last, W⁻¹ in the frame of the principal axes, and from there to the point's.
  if (result.stiffness[0] > 0.0 && (tangents == 1 || result.stiffness[1] > 0.0)) {
    const Tangent compliance(1.0 / result.stiffness[0], tangents == 1 ? 0.0 : 1.0 / result.stiffness[1]);
    Eigen::Matrix2d axes;
    axes << result.axis[0], -result.axis[1], result.axis[1], result.axis[0];
    const Eigen::Matrix2d tangential = axes * compliance.asDiagonal() * axes.transpose();
    result.inverse.bottomRightCorner<2, 2>() = tangential;
    result.inverse.block<2, 1>(1, 0) = -tangential * slope;
    result.inverse.block<1, 2>(0, 1) = result.inverse.block<2, 1>(1, 0).transpose();
    result.inverse(0, 0) = 1.0 / result.normal + slope.dot(tangential * slope);
  }
  return result;
}

PaddedVector solve_point(const ContactPoint& point, const PointOperator& block, const PaddedVector& q, bool pressed) {
  double slip_stiffness = -1.0;
  return solve_point(point, block, q, pressed, slip_stiffness);
}

PaddedVector solve_point(const ContactPoint& point, const PointOperator& block, const PaddedVector& q, bool pressed,
                         double& slip_stiffness) {
  const PaddedVector open = PaddedVector::Zero();
  if (!(block.normal > 0.0)) return open;
  if (point.size > 1 && point.is_tresca() && pressed && q[0] >= 0.0) {
    const PaddedVector closed = solve_tresca(reduce(block, q), point.bound);
    return closed[0] > 0.0 ? closed : open;
  }
  if (!(q[0] < 0.0)) return open;
  if (!point.has_friction()) return {-q[0] / block.normal, 0.0, 0.0};
  if (point.bound == 0.0 && block.inverse(0, 0) > 0.0) {
    const PaddedVector stick = -(block.inverse * q);
    if (stick[0] >= 0.0 && stick.tail<2>().squaredNorm() <= squared(point.coefficient * stick[0])) return stick;
    if (point.size == 2) return slip_in_two_dimensions(point.coefficient, block, q);
  }
  const ReducedPoint reduced = reduce(block, q);
  return point.is_tresca() ? solve_tresca(reduced, point.bound) : solve_coulomb(reduced, point, slip_stiffness);
}

PaddedVector project_on_cone(double coefficient, const PaddedVector& r) {
  const double length = r.tail<2>().norm();
  if (length <= coefficient * r[0]) return r;
  if (coefficient * length <= -r[0]) return PaddedVector::Zero();
  const double normal = (r[0] + coefficient * length) / (1.0 + coefficient * coefficient);
  const double factor = length > 0.0 ? coefficient * normal / length : 0.0;
  return {normal, factor * r[1], factor * r[2]};
}

PaddedVector natural_map(const ContactPoint& point, const PaddedVector& reaction, const PaddedVector& motion) {
  const double c = 1.0 / point.diagonal;
  if (!point.has_friction()) return {std::min(reaction[0], c * motion[0]), 0.0, 0.0};
  if (point.bound > 0.0) return {c * alart_curnier_residual(point, c, reaction, motion), 0.0, 0.0};
  PaddedVector step = c * motion;
  step[0] += point.coefficient * step.tail<2>().norm();
  const PaddedVector arrived = reaction - step;
  // Inside the cone the difference is the step itself, without the cancellation.
  if (arrived.tail<2>().norm() <= point.coefficient * arrived[0]) return step;
  return reaction - project_on_cone(point.coefficient, arrived);
}

double alart_curnier_residual(const ContactPoint& point, double step, const PaddedVector& reaction,
                              const PaddedVector& motion) {
  const double normal = std::abs(std::min(motion[0], reaction[0] / step));
  const Tangent friction = reaction.tail<2>();
  const Tangent slip = motion.tail<2>();
  if (point.size == 1) return std::isfinite(motion[0]) ? normal : std::numeric_limits<double>::infinity();
  double tangential = tangential_residual(step, friction, slip, point.friction_limit(reaction[0]));
  if (point.is_tresca() && reaction[0] == 0.0) {
    // Grazing: any limit up to the bound, as long as u_N = 0.
    const double limit = std::min(point.bound, friction.norm());
    tangential = std::min(tangential, std::max(std::abs(motion[0]), tangential_residual(step, friction, slip, limit)));
  }
  return std::isfinite(motion.sum()) ? std::max(normal, tangential) : std::numeric_limits<double>::infinity();
}

}  // namespace ricochet
