#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "ricochet/solver/contact/cone_formulation.hpp"
#include "ricochet/solver/contact/newton_iteration.hpp"

namespace ricochet {

namespace {

/// Smallest eigenvalue of (x² + y²)^½ in the derivatives, relative to its largest.
constexpr double smallest_root = 1e-6;

/// Multiplication by x in the algebra of the cone: x∘y = (x·y, x_N y_T + y_N x_T).
Eigen::Matrix3d arrow(const PaddedVector& x) {
  Eigen::Matrix3d result = x[0] * Eigen::Matrix3d::Identity();
  result.block<1, 2>(0, 1) = x.tail<2>().transpose();
  result.block<2, 1>(1, 0) = x.tail<2>();
  return result;
}

/// Function of A. Fischer and W. Burmeister on the second-order cone (M. Fukushima, Z.-Q. Luo, P. Tseng, SIAM J. Optim.
/// 12 (2002) 436–460): with L the self-dual cone |x_T| ≤ x_N,
///   f = x + y − (x² + y²)^½ = 0   ⟺   L ∋ x ⟂ y ∈ L,
/// squares and roots those of the cone's algebra. K* ∋ û ⟂ r ∈ K is transformed to it, with s = max(1, F), by
///   x = (û_N/s, F û_T/s)/w,   y = (s r_N, s r_T/F),   û = u + (F |u_T|, 0, 0).
/// If (x² + y²)^½ is singular, its derivatives are those with its small eigenvalue raised (smoothing of the derivatives
/// only: X. Chen, L. Qi, D. Sun, Math. Comp. 67 (1998) 519–540).
class NewtonFischerBurmeister final : public NewtonContactSolver {
 protected:
  [[nodiscard]] std::string refuses(const ContactSystem& system) const override {
    const std::string reason = refuse_bounds(system);
    return reason.empty() ? NewtonContactSolver::refuses(system) : reason;
  }
  [[nodiscard]] PointEquation equation(const ContactPoint& point, const PaddedVector& reaction,
                                       const PaddedVector& motion, bool derivatives) const override;
  std::string iterate(const ContactSystem& system, const ContactOptions& options, ContactIterate& current,
                      ContactSolution& solution) override {
    std::string reason = NewtonContactSolver::iterate(system, options, current, solution);
    if (reason.empty() && open_points(system, current)) system.evaluate(current);
    return reason;
  }
};

PointEquation scalar_equation(double c, double reaction, double motion) {
  PointEquation equation;
  const double x = c * motion;
  const double length = std::hypot(x, reaction);
  // x + y − |(x, y)| = 2 x y/(x + y + |(x, y)|), without the cancellation.
  const double sum = x + reaction;
  equation.value[0] = sum > 0.0 ? 2.0 * x * reaction / (sum + length) : sum - length;
  equation.by_motion(0, 0) = c * (1.0 - (length > 0.0 ? x / length : 0.0));
  equation.by_reaction(0, 0) = 1.0 - (length > 0.0 ? reaction / length : 0.0);
  return equation;
}

PointEquation NewtonFischerBurmeister::equation(const ContactPoint& point, const PaddedVector& reaction,
                                                const PaddedVector& motion, bool derivatives) const {
  const double c = 1.0 / point.diagonal;
  if (!point.has_friction()) return scalar_equation(c, reaction[0], motion[0]);
  const double friction = point.coefficient;
  const double s = std::max(1.0, friction);
  const double slip = motion.tail<2>().norm();
  const double tangential = c * friction / s;
  const PaddedVector x(c / s * (motion[0] + friction * slip), tangential * motion[1], tangential * motion[2]);
  const PaddedVector y(s * reaction[0], s / friction * reaction[1], s / friction * reaction[2]);
  // x² + y² and its root, by their eigenvalues.
  const double mean = x.squaredNorm() + y.squaredNorm();
  const Eigen::Vector2d off = 2.0 * (x[0] * x.tail<2>() + y[0] * y.tail<2>());
  const double radius = off.norm();
  double high = std::sqrt(mean + radius);
  double low = std::sqrt(std::max(0.0, mean - radius));
  const auto root = [&] {
    const double part = radius > 0.0 ? 0.5 * (high - low) / radius : 0.0;
    return PaddedVector(0.5 * (high + low), part * off[0], part * off[1]);
  };
  PointEquation equation;
  equation.value = x + y - root();
  if (!derivatives || !(high > 0.0)) return equation;
  low = std::max(low, smallest_root * high);
  const Eigen::Matrix3d inverse = arrow(root()).inverse();
  const Eigen::Matrix3d by_x = Eigen::Matrix3d::Identity() - inverse * arrow(x);
  const Eigen::Matrix3d by_y = Eigen::Matrix3d::Identity() - inverse * arrow(y);
  Eigen::Matrix3d x_by_motion = PaddedVector(c / s, tangential, tangential).asDiagonal();
  if (slip > 0.0) x_by_motion.block<1, 2>(0, 1) = (tangential / slip) * motion.tail<2>().transpose();
  equation.by_motion = by_x * x_by_motion;
  equation.by_reaction = by_y * PaddedVector(s, s / friction, s / friction).asDiagonal();
  return equation;
}

}  // namespace

ContactSolverRegistration newton_fischer_burmeister_solver() {
  return {"newton-fischer-burmeister",
          {[] { return std::make_unique<NewtonFischerBurmeister>(); },
           "semi-smooth Newton on the Fischer-Burmeister function of the second-order cone"}};
}

}  // namespace ricochet
