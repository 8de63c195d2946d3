#include "ricochet/solver/mean_reaction.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/linear_algebra/anderson_acceleration.hpp"
#include "ricochet/solver/normal_path.hpp"

namespace ricochet {

namespace {

/// Part of the largest reaction that the mean may be off by; and what is left where rounding stops the rounds.
constexpr double tolerance = 1e-13, rounding_of_rounds = 1e-10;
constexpr int most_mean_rounds = 60, most_newton_steps = 60, patience_of_mean = 12;
/// Of the power iteration for λ, whose value is a lower bound.
constexpr int power_steps = 30;
constexpr double power_reserve = 1.05;

/// The largest eigenvalue λ of U⁻¹Z; not finite where U is not positive definite.
double largest_ratio(const Matrix& u, const Matrix& z) {
  const Eigen::LLT<Matrix> factor(u);
  const bool definite = factor.info() == Eigen::Success &&
                        factor.matrixLLT().diagonal().cwiseAbs2().minCoeff() > 1e-13 * u.diagonal().maxCoeff();
  if (!definite) return std::numeric_limits<double>::infinity();
  Vector x(u.rows());
  for (Index i = 0; i < x.size(); ++i) x[i] = 1.0 + 0.5 * std::sin(1.0 + 2.4 * static_cast<double>(i));
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

/// The least μ = 2θ − 1 with (1 − (1−θ)λ)/(1 + θλ) ≥ −ratio.
double least_end_weight(double lambda, double ratio) {
  if (!(lambda > 0.0)) return 0.0;
  return std::clamp(2.0 * (lambda - 1.0 - ratio) / (lambda * (1.0 + ratio)) - 1.0, 0.0, 1.0);
}

}  // namespace

void MeanReaction::prepare(Matrix u, Matrix z, const std::vector<Index>& row_offset, ReactionMean mean) {
  u_ = std::move(u);
  z_ = std::move(z);
  mu_ = 1.0;
  if (mean == ReactionMean::end) return;
  normal_rows_.assign(row_offset.begin(), row_offset.end() - 1);
  has_friction_ = row_offset.back() > static_cast<Index>(normal_rows_.size());
  normal_u_ = u_(normal_rows_, normal_rows_);
  const double lambda = largest_ratio(normal_u_, z_(normal_rows_, normal_rows_));
  usable_ = std::isfinite(lambda);
  if (!usable_) return;
  mu_ = mean == ReactionMean::path ? 0.0 : least_end_weight(lambda, has_friction_ ? 0.0 : 0.5);
}

void MeanReaction::take_end(const Vector& reaction) {
  acting_ = reaction;
  acting_weight_ = 1.0;
  path_work_ = reaction.size() > 0 ? normals(reaction).dot(start_gap_) : 0.0;
}

Vector MeanReaction::normals(const Vector& rows) const {
  return rows(normal_rows_);
}

/// With friction's part of y in q₀ and q₁ alike.
bool MeanReaction::find_mean(const Vector& acting, const Vector& offset, const Vector& reaction, Vector& mean) {
  const Vector motion = offset + z_ * acting;
  Vector of_friction = reaction;
  for (const Index row : normal_rows_) of_friction[row] = 0.0;
  const Vector shift = normals(u_ * of_friction);
  const Vector q0 = start_gap_ - normals(u_ * start_) + shift, q1 = normals(motion) + shift;
  mean = reaction;
  NormalPath path(normal_u_, eligible_);
  if (!path.follow(q0, q1, pressing_)) {
    reason_ = "the points that press were not found along the path of the step";
    return false;
  }
  for (std::size_t i = 0; i < normal_rows_.size(); ++i) {
    const auto at = static_cast<Index>(i);
    mean[normal_rows_[i]] = (1.0 - mu_) * path.mean()[at] + mu_ * reaction[normal_rows_[i]];
  }
  path_work_ = path.start().dot(start_gap_);
  return true;
}

/// Solves with ρ̄ − θρ = difference_: ρ̄ is then right for y; `error` says how far it is from the mean of the path, and
/// acting_ is ρ̄.
bool MeanReaction::solve_with(ContactProblem& contact, const Vector& offset, const std::function<bool()>& solve_contact,
                              ContactSolution& solution, double& error) {
  contact.offset = offset + z_ * difference_;
  if (!solve_contact()) {
    reason_ = "a contact problem on the way to it was not solved";
    return false;
  }
  const Vector acting = theta() * solution.reaction + difference_;
  Vector mean;
  if (!find_mean(acting, offset, solution.reaction, mean)) return false;
  const double size = std::max({solution.reaction.lpNorm<Eigen::Infinity>(), start_.lpNorm<Eigen::Infinity>(),
                                mean.lpNorm<Eigen::Infinity>(), acting.lpNorm<Eigen::Infinity>()});
  error = size > 0.0 ? (mean - acting).lpNorm<Eigen::Infinity>() / size : 0.0;
  acting_ = acting;
  difference_ = mean - theta() * solution.reaction;
  return true;
}

/// Without changes of status along the path the first round is right.
bool MeanReaction::rounds(ContactProblem& contact, const Vector& offset, const std::function<bool()>& solve_contact,
                          ContactSolution& solution) {
  AndersonAcceleration acceleration(8);
  double least = std::numeric_limits<double>::infinity();
  int last_progress = 0;
  const int limit = has_friction_ ? most_mean_rounds : 3;
  for (int round = 0; round < limit; ++round) {
    const Vector asked = difference_;
    double error = 0.0;
    if (!solve_with(contact, offset, solve_contact, solution, error)) return false;
    if (error <= tolerance) return true;
    if (error < 0.5 * least) {
      least = error;
      last_progress = round;
    } else if (error <= rounding_of_rounds && round - last_progress > 2) {
      return true;
    } else if (round - last_progress > patience_of_mean) {
      break;
    }
    difference_ = acceleration.next(asked, difference_);
  }
  reason_ = fmt::format("rounds stopped at {:.2g} of the reactions", least);
  return false;
}

/// Without friction ρ̄ − mean(o + Zρ̄) is, times Z, the gradient of a convex function: Newton's steps on it, shortened
/// where the gradient along them changes sign.
bool MeanReaction::newton(ContactProblem& contact, const Vector& offset, const std::function<bool()>& solve_contact,
                          ContactSolution& solution) {
  const Vector q0 = start_gap_ - u_ * start_;
  NormalPath path(normal_u_, eligible_);
  Vector mean;
  const auto evaluate = [&](const Vector& acting, Vector& residual) {
    if (!path.follow(q0, offset + z_ * acting, pressing_)) return false;
    mean = (1.0 - mu_) * path.mean() + mu_ * path.end();
    residual = acting - mean;
    return true;
  };
  Vector acting = acting_, residual, trial;
  if (!evaluate(acting, residual)) return false;
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0, last_progress = 0; k < most_newton_steps; ++k) {
    const double size = std::max(
        {mean.lpNorm<Eigen::Infinity>(), path.end().lpNorm<Eigen::Infinity>(), acting.lpNorm<Eigen::Infinity>()});
    const double error = residual.lpNorm<Eigen::Infinity>();
    if (error < 0.5 * least) {
      least = error;
      last_progress = k;
    }
    const bool stuck = k - last_progress > 6;
    if (error <= 0.1 * tolerance * size || (stuck && error <= rounding_of_rounds * size)) {
      difference_ = acting - theta() * path.end();
      double left = 0.0;
      return solve_with(contact, offset, solve_contact, solution, left) && left <= 10.0 * rounding_of_rounds;
    }
    const Matrix derivative = (1.0 - mu_) * path.mean_derivative() + mu_ * path.end_derivative();
    const Matrix jacobian = Matrix::Identity(z_.rows(), z_.cols()) + derivative * z_;
    const Vector step = jacobian.partialPivLu().solve(-residual);
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
  reason_ = "Newton's method did not settle";
  return false;
}

bool MeanReaction::solve(ContactProblem& contact, const Vector& offset, const Vector& start_gap, const Vector& start,
                         const std::function<bool()>& solve_contact, ContactSolution& solution) {
  start_gap_ = start_gap;
  start_ = start;
  acting_ = start;
  eligible_.assign(static_cast<std::size_t>(contact.points()), 1);
  for (Index i = 0; i < contact.points(); ++i) eligible_[static_cast<std::size_t>(i)] = contact.is_eligible(i) ? 1 : 0;
  pressing_.clear();
  for (const Index row : normal_rows_) pressing_.push_back(start_[row] > 0.0 ? 1 : 0);
  acting_weight_ = mu_;
  if (!usable_) {
    reason_ = "the compliance of the contact nodes is not positive definite on them";
    return false;
  }
  difference_ = (1.0 - theta()) * start_;
  if (rounds(contact, offset, solve_contact, solution)) return true;
  return !has_friction_ && newton(contact, offset, solve_contact, solution);
}

}  // namespace ricochet
