#include <cmath>

#include "ricochet/solver/contact/cone_formulation.hpp"
#include "ricochet/solver/contact/iteration_record.hpp"
#include "ricochet/solver/contact/iterative_contact_solver.hpp"

namespace ricochet {

namespace {

constexpr int gradient_iterations = 50000;
/// Iterations in which the residual must halve if the correction is to be updated in every iteration.
constexpr int halving_patience = 400;
/// Part of its residual to which a problem with the correction held is solved before the correction is updated.
constexpr double frozen_accuracy = 0.1;
/// Factors of the estimate of W's largest eigenvalue: its decrease after an iteration, and its increase if too small.
constexpr double slackening = 0.97, tightening = 1.5;

/// Accelerated projected gradient method. For a given De Saxcé correction s = F |u_T| the problem is to minimize
///   ½ rᵀ W r + (q + s n)ᵀ r   on   r ∈ K,
/// which is solved by
///   r⁺ = P_K(y − (W y + q + s n)/(L w)),   y = r + β (r − r⁻),
/// with Nesterov's β, restarted if it points uphill (B. O'Donoghue, E. Candès, Found. Comput. Math. 15 (2015) 715–732),
/// and 1/L the longest step for which the quadratic is bounded by its value with L in place of W (A. Beck, M. Teboulle,
/// SIAM J. Imaging Sci. 2 (2009) 183–202). s follows y at every iteration; if that brings no more progress (strong
/// friction) it is held until the problem with it is nearly solved. One product with W per iteration. On contact
/// problems: H. Mazhar, T. Heyn, D. Negrut, A. Tasora, ACM Trans. Graph. 34 (2015) 32.
class AcceleratedGradient final : public IterativeContactSolver {
 protected:
  [[nodiscard]] std::string refuses(const ContactSystem& system) const override { return refuse_bounds(system); }
  std::string iterate(const ContactSystem& system, const ContactOptions& options, ContactIterate& current,
                      ContactSolution& solution) override;

 private:
  void advance(const ContactSystem& system, const ContactIterate& current);
  void step(const ContactSystem& system);
  void accelerate(const ContactSystem& system, const ContactIterate& current);
  [[nodiscard]] double correction(const ContactSystem& system, std::size_t k, const PaddedVector& motion) const;
  void freeze(const ContactSystem& system, const ContactIterate& current, double residual);
  [[nodiscard]] bool is_frozen_problem_solved(const ContactSystem& system, const ContactIterate& current) const;

  Vector start_reaction_, start_motion_;  ///< y and W y + q
  Vector step_;                           ///< r⁺ − y
  ContactIterate next_;
  FirstOrderVerdict verdict_;
  Vector frozen_;  ///< s per point, while it is frozen
  bool is_frozen_ = false;
  double target_ = 0.0;      ///< for the residual of the problem with s frozen
  double eigenvalue_ = 1.0;  ///< L
  double theta_ = 1.0;       ///< of Nesterov's sequence
};

/// Correction s of a point.
double AcceleratedGradient::correction(const ContactSystem& system, std::size_t k, const PaddedVector& motion) const {
  if (is_frozen_) return frozen_[Index(k)];
  return system.points()[k].coefficient * motion.tail<2>().norm();
}

void AcceleratedGradient::freeze(const ContactSystem& system, const ContactIterate& current, double residual) {
  const std::vector<ContactPoint>& points = system.points();
  is_frozen_ = true;
  frozen_.resize(Index(points.size()));
  for (std::size_t k = 0; k < points.size(); ++k)
    frozen_[Index(k)] = points[k].coefficient * padded(points[k], current.motion).tail<2>().norm();
  target_ = frozen_accuracy * residual;
}

bool AcceleratedGradient::is_frozen_problem_solved(const ContactSystem& system, const ContactIterate& current) const {
  for (std::size_t k = 0; k < system.points().size(); ++k) {
    const ContactPoint& point = system.points()[k];
    const PaddedVector r = padded(point, current.reaction);
    PaddedVector slope = padded(point, current.motion);
    slope[0] += frozen_[Index(k)];
    const PaddedVector change = r - project(point, PaddedVector(r - slope / point.diagonal));
    if (!(change.norm() * std::sqrt(point.diagonal) <= target_)) return false;
  }
  return true;
}

/// Computes r⁺ and its u for the present L.
void AcceleratedGradient::step(const ContactSystem& system) {
  next_.reaction.setZero(system.rows());
  for (std::size_t k = 0; k < system.points().size(); ++k) {
    const ContactPoint& point = system.points()[k];
    const PaddedVector y = padded(point, start_reaction_);
    PaddedVector slope = padded(point, start_motion_);
    slope[0] += correction(system, k, slope);
    enter(point, project(point, y - slope / (eigenvalue_ * point.diagonal)), next_.reaction);
  }
  system.multiply(next_.reaction, next_.motion);
  next_.motion += system.offset();
  step_ = next_.reaction - start_reaction_;
}

void AcceleratedGradient::advance(const ContactSystem& system, const ContactIterate& current) {
  for (int k = 0; k < 60; ++k) {
    step(system);
    const double curvature = step_.dot(next_.motion - start_motion_);
    if (!(curvature > eigenvalue_ * weighted_product(system, step_, step_))) break;
    eigenvalue_ *= tightening;
  }
  accelerate(system, current);
  eigenvalue_ *= slackening;
}

void AcceleratedGradient::accelerate(const ContactSystem& system, const ContactIterate& current) {
  start_reaction_ = next_.reaction - current.reaction;
  if (weighted_product(system, step_, start_reaction_) < 0.0) theta_ = 1.0;
  const double squared = theta_ * theta_;
  const double following = 0.5 * (std::sqrt(squared * (squared + 4.0)) - squared);
  const double beta = theta_ * (1.0 - theta_) / (squared + following);
  theta_ = following;
  start_reaction_ = next_.reaction + beta * start_reaction_;
  start_motion_ = next_.motion + beta * (next_.motion - current.motion);
}

std::string AcceleratedGradient::iterate(const ContactSystem& system, const ContactOptions& options,
                                         ContactIterate& current, ContactSolution& solution) {
  if (system.is_solved(current, options.tolerance)) return "";
  const int limit = options.iteration_limit > 0 ? options.iteration_limit : gradient_iterations;
  verdict_.start(system, options.tolerance, current);
  start_reaction_ = current.reaction;
  start_motion_ = current.motion;
  eigenvalue_ = theta_ = 1.0;
  is_frozen_ = false;
  double compared = verdict_.best();
  int next_comparison = halving_patience;
  for (int k = 1; k <= limit; ++k) {
    advance(system, current);
    std::swap(current.reaction, next_.reaction);
    std::swap(current.motion, next_.motion);
    const double residual = system.residual(current);
    note_iteration(system, options, "gradient", residual, current.reaction, solution);
    if (!std::isfinite(residual)) break;
    if (is_frozen_ && is_frozen_problem_solved(system, current)) freeze(system, current, residual);
    if (!is_frozen_ && k == next_comparison) {
      if (!(verdict_.best() < 0.5 * compared)) freeze(system, current, residual);
      compared = verdict_.best();
      next_comparison += halving_patience;
    }
    if (verdict_.is_solved(system, k, residual, current)) return "";
  }
  return verdict_.finish(system, current) ? "the limit of gradient steps was reached"
                                          : "the gradient steps diverged: W is not positive semi-definite";
}

}  // namespace

ContactSolverRegistration accelerated_gradient_solver() {
  return {"accelerated-gradient",
          {[] { return std::make_unique<AcceleratedGradient>(); },
           "Nesterov's projected gradient method with restarts; needs only products with W"}};
}

}  // namespace ricochet
