#include "ricochet/solver/mean_reaction/mean_reaction.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "ricochet/base/dense_decompositions.hpp"

namespace ricochet {

namespace {

/// Error of the mean relative to the largest reaction: the tolerance, and the limit if rounding stops the iterations.
constexpr double tolerance = 1e-13, rounding_limit = 1e-10;
constexpr int iterations_before_freeze = 2, max_mean_iterations = 60, max_newton_steps = 60;
constexpr int patience_of_mean = 12;
/// Steps of the power iteration for λ, whose value is a lower bound, and its reserve.
constexpr int power_steps = 30;
constexpr double power_reserve = 1.05;
/// Part of the largest diagonal entry of U that is added to U, if it is not definite, for λ.
constexpr double own_compliance = 1e-10;

/// Returns the largest eigenvalue λ of U⁻¹Z; not finite if U is not positive definite.
double largest_ratio(const Matrix& u, const Matrix& z) {
  const SmallCholesky factor(u);
  const bool definite =
      factor.positive_definite() && factor.lower().diagonal().cwiseAbs2().minCoeff() > 1e-13 * u.diagonal().maxCoeff();
  if (!definite) return std::numeric_limits<double>::infinity();
  Vector x(u.rows());
  for (Index i = 0; i < x.size(); ++i) x[i] = 1.0 + 0.5 * std::sin(1.0 + 2.4 * double(i));
  double ratio = 0.0;
  for (int k = 0; k < power_steps; ++k) {
    const Vector image = z * x;
    ratio = std::max(ratio, x.dot(image) / x.dot(u * x));
    x = factor.solve(image);
    const double size = x.lpNorm<Eigen::Infinity>();
    if (!(size > 0.0)) return 0.0;
    x /= size;
  }
  return power_reserve * ratio;
}

/// Returns the least μ = 2θ − 1 with (1 − (1−θ)λ)/(1 + θλ) ≥ −ratio.
double least_end_weight(double lambda, double ratio) {
  if (!(lambda > 0.0)) return 0.0;
  return std::clamp(2.0 * (lambda - 1.0 - ratio) / (lambda * (1.0 + ratio)) - 1.0, 0.0, 1.0);
}

}  // namespace

void MeanReaction::prepare(Matrix u, Matrix z, const std::vector<Index>& row_offset, ActingReaction mean) {
  u_ = std::move(u);
  z_ = std::move(z);
  mu_ = 1.0;
  if (mean == ActingReaction::end) return;
  normal_rows_.assign(row_offset.begin(), row_offset.end() - 1);
  has_friction_ = row_offset.back() > Index(normal_rows_.size());
  normal_u_ = u_(normal_rows_, normal_rows_);
  const Matrix normal_z = z_(normal_rows_, normal_rows_);
  double lambda = largest_ratio(normal_u_, normal_z);
  is_dependent_ = !std::isfinite(lambda);
  if (is_dependent_) {
    Matrix regular = normal_u_;
    regular.diagonal().array() += own_compliance * regular.diagonal().maxCoeff();
    lambda = largest_ratio(regular, normal_z);
  }
  usable_ = std::isfinite(lambda);
  if (!usable_) return;
  path_.prepare(u_, row_offset, !is_dependent_);
  mu_ = mean == ActingReaction::path_mean ? 0.0 : least_end_weight(lambda, has_friction_ ? 0.0 : 0.5);
}

void MeanReaction::set_end_reaction(const Vector& reaction) {
  acting_ = reaction;
  acting_weight_ = 1.0;
  path_work_ = reaction.size() > 0 ? normals(reaction).dot(start_gap_) : 0.0;
  has_path_ = false;
}

Vector MeanReaction::normals(const Vector& rows) const { return rows(normal_rows_); }

bool MeanReaction::find_mean(const Vector& acting, const Vector& offset, const Vector& reaction, Vector& mean) {
  has_path_ = !(start_.isZero(0.0) && reaction.isZero(0.0) && acting.isZero(0.0));
  if (!has_path_) {  // open at both ends: straight gaps are open in between, regardless of rounding
    mean.setZero(reaction.size());
    path_work_ = 0.0;
    return true;
  }
  q1_ = offset;
  q1_.noalias() += z_ * acting;
  if (!path_.follow({q0_, q1_, start_, reaction, friction_, eligible_, pressing_})) {
    reason_ = "the points in contact were not found along the path of the step";
    return false;
  }
  mean = (1.0 - mu_) * path_.mean() + mu_ * reaction;
  path_work_ = path_.start().dot(start_gap_);
  return true;
}

/// Largest difference, measured by the motion of contact points if different reactions may be the same force.
double MeanReaction::difference_of(const Vector& mean, const Vector& acting) const {
  const Vector difference = mean - acting;
  if (!is_dependent_) return difference.lpNorm<Eigen::Infinity>();
  const double compliance = (u_.diagonal() + z_.diagonal()).maxCoeff();
  return (u_ * difference + z_ * difference).lpNorm<Eigen::Infinity>() / compliance;
}

/// Solves with ρ̄ − θρ = difference_, for which ρ̄ is consistent with y; `error` is its distance from the mean of the
/// path, and acting_ is ρ̄.
bool MeanReaction::solve_with(ContactProblem& contact, const Vector& offset, const std::function<bool()>& solve_contact,
                              ContactSolution& solution, double& error) {
  contact.offset = offset + z_ * difference_;
  if (!solve_contact()) {
    reason_ = "a contact problem of its iteration was not solved";
    return false;
  }
  const Vector acting = theta() * solution.reaction + difference_;
  Vector mean;
  if (!find_mean(acting, offset, solution.reaction, mean)) return false;
  const double size = std::max({solution.reaction.lpNorm<Eigen::Infinity>(), start_.lpNorm<Eigen::Infinity>(),
                                mean.lpNorm<Eigen::Infinity>(), acting.lpNorm<Eigen::Infinity>()});
  error = size > 0.0 ? difference_of(mean, acting) / size : 0.0;
  acting_ = is_dependent_ ? mean : acting;
  difference_ = mean - theta() * solution.reaction;
  return true;
}

/// Iterates on the difference. Without changes of status along the path the first iteration is exact.
bool MeanReaction::iterate(ContactProblem& contact, const Vector& offset, const std::function<bool()>& solve_contact,
                           ContactSolution& solution) {
  acceleration_.restart();
  double best_error = std::numeric_limits<double>::infinity();
  int last_progress = 0;
  const int patience = has_friction_ ? patience_of_mean : 5;  // followed by Newton's method
  for (int iteration = 0; iteration < max_mean_iterations; ++iteration) {
    const Vector previous = difference_;
    double error = 0.0;
    if (!solve_with(contact, offset, solve_contact, solution, error)) return false;
    if (error <= tolerance) return true;
    if (error < 0.5 * best_error) {
      best_error = error;
      last_progress = iteration;
    } else if (error <= rounding_limit && iteration - last_progress > 2) {
      return true;
    } else if (iteration - last_progress > patience) {
      break;
    }
    if (iteration == iterations_before_freeze) path_.freeze_shares();
    acceleration_.advance(previous, difference_, difference_);
  }
  reason_ = fmt::format("iterations stopped at an error of {:.2g} of the reactions", best_error);
  return false;
}

/// Without friction ρ̄ − mean(o + Zρ̄), multiplied by Z, is the gradient of a convex function: Newton's method for it,
/// with steps shortened if the gradient along them changes sign.
bool MeanReaction::newton(ContactProblem& contact, const Vector& offset, const std::function<bool()>& solve_contact,
                          ContactSolution& solution) {
  NormalPath& path = path_.normal();
  Vector mean;
  const auto evaluate = [&](const Vector& acting, Vector& residual) {
    if (!path.follow(q0_, offset + z_ * acting, eligible_, pressing_)) return false;
    mean = (1.0 - mu_) * path.mean() + mu_ * path.end();
    residual = acting - mean;
    return true;
  };
  Vector acting = acting_, residual, trial;
  reason_ = "the points in contact were not found along the path of the step";
  if (!evaluate(acting, residual)) return false;
  double best_error = std::numeric_limits<double>::infinity();
  for (int k = 0, last_progress = 0; k < max_newton_steps; ++k) {
    const double size = std::max(
        {mean.lpNorm<Eigen::Infinity>(), path.end().lpNorm<Eigen::Infinity>(), acting.lpNorm<Eigen::Infinity>()});
    const double error = difference_of(mean, acting);
    if (error < 0.5 * best_error) {
      best_error = error;
      last_progress = k;
    }
    const bool stuck = k - last_progress > 6;
    if (error <= 0.1 * tolerance * size || (stuck && error <= rounding_limit * size)) {
      difference_ = acting - theta() * path.end();
      double final_error = 0.0;
      return solve_with(contact, offset, solve_contact, solution, final_error) && final_error <= 10.0 * rounding_limit;
    }
    const Matrix derivative = (1.0 - mu_) * path.mean_derivative() + mu_ * path.end_derivative();
    // If nothing presses on the path, rows of I + DZ are those of the identity.
    pressed_.clear();
    for (Index i = 0; i < derivative.cols(); ++i) {
      if (derivative(i, i) != 0.0) pressed_.push_back(i);
    }
    Vector step = -residual;
    if (!pressed_.empty()) {
      const Matrix on_pressed = derivative(pressed_, pressed_), motion = z_(pressed_, pressed_);
      Vector right = -residual;
      for (const Index i : pressed_) right[i] = 0.0;
      const Vector rest = -residual(pressed_) - on_pressed * Vector(z_ * right)(pressed_);
      const Index count = on_pressed.rows();
      const Vector solved = PivotedLu(Matrix::Identity(count, count) + on_pressed * motion).solve(rest);
      step(pressed_) = solved;
    }
    const Vector weights = z_ * step;
    const double slope = weights.dot(residual);
    double length = 1.0;
    for (int search = 0; search < 40; ++search) {
      trial = acting + length * step;
      if (!evaluate(trial, residual)) return false;
      const double here = weights.dot(residual);
      if (here <= -0.5 * slope) break;
      length *= 0.5;
    }
    acting = trial;
  }
  reason_ = "Newton's method did not converge";
  return false;
}

bool MeanReaction::solve(ContactProblem& contact, const Vector& offset, const Vector& start_gap, const Vector& start,
                         const std::function<bool()>& solve_contact, ContactSolution& solution) {
  start_gap_ = start_gap;
  start_ = start;
  acting_ = start;
  eligible_.assign(std::size_t(contact.points()), 1);
  for (Index i = 0; i < contact.points(); ++i) eligible_[std::size_t(i)] = contact.is_eligible(i) ? 1 : 0;
  pressing_.clear();
  for (const Index row : normal_rows_) pressing_.push_back(start_[row] > 0.0 ? 1 : 0);
  acting_weight_ = mu_;
  if (!usable_) {
    reason_ = "the compliance matrix of the contact nodes is not positive definite";
    return false;
  }
  friction_ = contact.friction_coefficient;
  if (contact.friction_bound.size() > 0) friction_ = (contact.friction_bound.array() > 0.0).select(0.0, friction_);
  q0_ = -(u_ * start_);
  for (std::size_t i = 0; i < normal_rows_.size(); ++i) q0_[normal_rows_[i]] += start_gap_[Index(i)];
  has_path_ = true;
  path_.begin_step();
  difference_ = (1.0 - theta()) * start_;
  if (iterate(contact, offset, solve_contact, solution)) return true;
  if (has_friction_) return false;
  path_.normal().keep_derivatives(true);
  const bool found = newton(contact, offset, solve_contact, solution);
  path_.normal().keep_derivatives(false);
  return found;
}

}  // namespace ricochet
