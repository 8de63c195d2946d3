#include "ricochet/solver/contact/newton_iteration.hpp"
#include "ricochet/solver/contact/iteration_record.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

constexpr int step_limit = 200;
/// Halvings of a step.
constexpr int cut_limit = 12;
/// Full steps in one solve that may be taken against the merit.
constexpr int jump_limit = 12;
/// Required part of the first-order decrease.
constexpr double sufficient = 1e-4;
constexpr auto none = std::size_t(-1);

bool NewtonSystem::solve(const ContactSystem& system, const std::vector<PointEquation>& equations, Vector& change) {
  const bool solved =
      system.dense() != nullptr ? solve_dense(system, equations, change) : solve_sparse(system, equations, change);
  return solved && change.allFinite();
}

void NewtonSystem::assemble_dense(const ContactSystem& system, const std::vector<PointEquation>& equations) {
  const std::vector<ContactPoint>& points = system.points();
  const Matrix& w = *system.dense();
  const Index count = start_.back();
  if (matrix_.rows() != count) matrix_.resize(count, count);
  for (std::size_t b = 0; b < active_.size(); ++b) {
    const ContactPoint& column_point = points[active_[b]];
    for (Index k = 0; k < column_point.size; ++k) {
      const double* column = w.data() + (column_point.row + k) * w.rows();
      double* to = matrix_.data() + (start_[b] + k) * count;
      for (const std::size_t a : active_) {
        const ContactPoint& point = points[a];
        const Eigen::Matrix3d& by_motion = equations[a].by_motion;
        for (Index i = 0; i < point.size; ++i) {
          double sum = 0.0;
          for (Index j = 0; j < point.size; ++j) sum += by_motion(i, j) * column[point.row + j];
          *to++ = sum;
        }
      }
      const Index size = column_point.size;
      matrix_.block(start_[b], start_[b] + k, size, 1) += equations[active_[b]].by_reaction.block(0, k, size, 1);
    }
  }
}

bool NewtonSystem::solve_dense(const ContactSystem& system, const std::vector<PointEquation>& equations,
                               Vector& change) {
  const std::vector<ContactPoint>& points = system.points();
  active_.clear();
  start_.assign(1, 0);
  change.setZero(system.rows());
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (equations[k].by_motion.isZero(0.0)) {
      enter(points[k], PaddedVector(-equations[k].by_reaction.inverse() * equations[k].value), change);
    } else {
      active_.push_back(k);
      start_.push_back(start_.back() + points[k].size);
    }
  }
  if (active_.empty()) return true;
  system.multiply(change, fixed_motion_);
  right_.resize(start_.back());
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const ContactPoint& point = points[active_[a]];
    const PointEquation& equation = equations[active_[a]];
    const PaddedVector value = -equation.value - equation.by_motion * padded(point, fixed_motion_);
    for (Index k = 0; k < point.size; ++k) right_[start_[a] + k] = value[k];
  }
  assemble_dense(system, equations);
  factor_.compute(matrix_);
  if (!(factor_.smallest_pivot() > 4.0 * double(start_.back()) * machine_epsilon)) {
    for (std::size_t a = 0; a < active_.size(); ++a) {
      const ContactPoint& point = points[active_[a]];
      matrix_.block(start_[a], start_[a], point.size, point.size) +=
          proximal_size * point.diagonal * equations[active_[a]].by_motion.topLeftCorner(point.size, point.size);
    }
    factor_.compute(matrix_);
  }
  factor_.solve(right_, solution_);
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const ContactPoint& point = points[active_[a]];
    for (Index k = 0; k < point.size; ++k) change[point.row + k] = solution_[start_[a] + k];
  }
  return true;
}

/// Sets W's pattern with whole blocks on the diagonal, so that A W + B fits; kept for as long as it fits.
void NewtonSystem::find_pattern(const ContactSystem& system) {
  const SparseMatrix& w = *system.sparse();
  const std::vector<ContactPoint>& points = system.points();
  const bool same_operator = pattern_ == &w;
  pattern_ = &w;
  last_point_of_.swap(point_of_);
  point_of_.assign(std::size_t(w.rows()), none);
  for (std::size_t k = 0; k < points.size(); ++k) {
    for (Index row = points[k].row; row < points[k].row + points[k].size; ++row) point_of_[std::size_t(row)] = k;
  }
  if (same_operator && point_of_ == last_point_of_) return;
  std::vector<Eigen::Triplet<double, int>> entries;
  const auto add = [&](Index row, Index column) { entries.emplace_back(int(row), int(column), 0.0); };
  for (Index column = 0; column < w.cols(); ++column) {
    add(column, column);
    if (point_of_[std::size_t(column)] == none) continue;
    for (SparseMatrix::InnerIterator entry(w, column); entry; ++entry) {
      const std::size_t k = point_of_[std::size_t(entry.row())];
      if (k == none) continue;
      for (Index row = points[k].row; row < points[k].row + points[k].size; ++row) add(row, column);
    }
    const ContactPoint& own = points[point_of_[std::size_t(column)]];
    for (Index row = own.row; row < own.row + own.size; ++row) add(row, column);
  }
  sparse_matrix_.resize(w.rows(), w.cols());
  sparse_matrix_.setFromTriplets(entries.begin(), entries.end());
  sparse_factor_.reset();
}

bool NewtonSystem::solve_sparse(const ContactSystem& system, const std::vector<PointEquation>& equations,
                                Vector& change) {
  const SparseMatrix& w = *system.sparse();
  const std::vector<ContactPoint>& points = system.points();
  find_pattern(system);
  for (double proximal = 0.0; proximal <= proximal_size; proximal += proximal_size) {
    for (Index column = 0; column < w.cols(); ++column) {
      double* const values = sparse_matrix_.valuePtr();
      const auto* outer = sparse_matrix_.outerIndexPtr();
      const auto* inner = sparse_matrix_.innerIndexPtr();
      std::fill(values + outer[column], values + outer[column + 1], 0.0);
      const std::size_t own = point_of_[std::size_t(column)];
      if (own == none) {
        sparse_matrix_.coeffRef(column, column) = 1.0;
        continue;
      }
      const auto add = [&](const ContactPoint& point, const Eigen::Matrix3d& block, Index k, double factor) {
        const auto* at = std::lower_bound(inner + outer[column], inner + outer[column + 1], int(point.row));
        double* to = values + (at - inner);
        for (Index i = 0; i < point.size; ++i) to[i] += factor * block(i, k);
      };
      for (SparseMatrix::InnerIterator entry(w, column); entry; ++entry) {
        const std::size_t k = point_of_[std::size_t(entry.row())];
        if (k != none) add(points[k], equations[k].by_motion, entry.row() - points[k].row, entry.value());
      }
      const Index k = column - points[own].row;
      add(points[own], equations[own].by_reaction, k, 1.0);
      if (proximal > 0.0) add(points[own], equations[own].by_motion, k, proximal * points[own].diagonal);
    }
    right_.setZero(w.rows());
    for (std::size_t k = 0; k < points.size(); ++k) enter(points[k], PaddedVector(-equations[k].value), right_);
    if (!sparse_factor_.compute(sparse_matrix_)) continue;
    sparse_factor_.solve(right_, change);
    if (change.allFinite()) return true;
  }
  return false;
}

std::string NewtonContactSolver::refuses(const ContactSystem& system) const {
  return system.has_entries() ? "" : "Newton's method needs the entries of W, but only products with W are available";
}

double NewtonContactSolver::merit(const ContactSystem& system, const ContactIterate& iterate) const {
  double sum = 0.0;
  for (const ContactPoint& point : system.points()) {
    const PaddedVector r = padded(point, iterate.reaction);
    sum += point.diagonal * equation(point, r, padded(point, iterate.motion), false).value.squaredNorm();
  }
  return std::isfinite(sum) ? 0.5 * sum : std::numeric_limits<double>::infinity();
}

bool NewtonContactSolver::full_step(const ContactSystem& system, const ContactIterate& from, Vector& reaction,
                                    ContactSolution& solution) {
  equations_.clear();
  for (const ContactPoint& point : system.points())
    equations_.push_back(equation(point, padded(point, from.reaction), padded(point, from.motion), true));
  ++solution.factorizations;
  if (!linear_system_.solve(system, equations_, change_)) return false;
  reaction = from.reaction + change_;
  return true;
}

PointEquation projection_equation(const ContactPoint& point, const PaddedVector& reaction, const PaddedVector& motion,
                                  DiscRadius radius, bool derivatives) {
  PointEquation equation;
  const double c = 1.0 / point.diagonal;
  const PaddedVector tau = reaction - c * motion;
  const bool pressed = tau[0] > 0.0;
  equation.value[0] = pressed ? c * motion[0] : reaction[0];
  if (pressed && derivatives) {
    equation.by_motion(0, 0) = c;
    equation.by_reaction(0, 0) = 0.0;
  }
  if (!point.has_friction()) return equation;
  const double normal = radius == DiscRadius::of_trial ? tau[0] : reaction[0];
  const double limit = point.friction_limit(normal);
  const double length = tau.tail<2>().norm();
  if (length <= limit) {
    equation.value.tail<2>() = c * motion.tail<2>();
    equation.by_motion.bottomRightCorner<2, 2>().diagonal().setConstant(c);
    equation.by_reaction.bottomRightCorner<2, 2>().setZero();
    return equation;
  }
  const Eigen::Vector2d direction = tau.tail<2>() / length;
  equation.value.tail<2>() = reaction.tail<2>() - limit * direction;
  if (!(limit > 0.0) || !derivatives) return equation;
  const Eigen::Matrix2d turning = (limit / length) * (Eigen::Matrix2d::Identity() - direction * direction.transpose());
  equation.by_motion.bottomRightCorner<2, 2>() = c * turning;
  equation.by_reaction.bottomRightCorner<2, 2>() -= turning;
  if (point.is_bounded(normal)) return equation;
  equation.by_reaction.bottomLeftCorner<2, 1>() = -point.coefficient * direction;
  if (radius == DiscRadius::of_trial) equation.by_motion.bottomLeftCorner<2, 1>() = point.coefficient * c * direction;
  return equation;
}

/// Searches from `current` towards `trial_`: the whole, half, quarter, … of the step with a sufficiently small merit
/// becomes `current`.
bool NewtonContactSolver::search_line(const ContactSystem& system, ContactIterate& current, double reference) {
  double length = 1.0;
  for (int k = 0; k <= cut_limit; ++k, length *= 0.5) {
    if (k > 0) {
      cut_.reaction = current.reaction + length * (trial_.reaction - current.reaction);
      cut_.motion = current.motion + length * (trial_.motion - current.motion);
      cut_.size = current.size + length * (trial_.size - current.size);
    }
    ContactIterate& candidate = k == 0 ? trial_ : cut_;
    const double value = merit(system, candidate);
    if (!(value <= reference - 2.0 * sufficient * length * merit_)) continue;
    std::swap(current, candidate);
    merit_ = value;
    return true;
  }
  return false;
}

std::string NewtonContactSolver::iterate(const ContactSystem& system, const ContactOptions& options,
                                         ContactIterate& current, ContactSolution& solution) {
  if (system.is_solved(current, options.tolerance)) return "";
  const int limit = options.iteration_limit > 0 ? options.iteration_limit : step_limit;
  merit_ = merit(system, current);
  merits_.fill(merit_);
  best_ = current;
  double best = system.residual(current);
  int jumps = 0;
  for (int k = 0; k < limit; ++k) {
    ++solution.newton_steps;
    if (!full_step(system, current, trial_.reaction, solution)) {
      current = best_;
      return "the linear system of a Newton step is singular";
    }
    system.evaluate(trial_);
    const double residual = system.residual(trial_);
    note_iteration(system, options, "newton", residual, trial_.reaction, solution);
    if (system.is_solved(trial_, options.tolerance)) {
      std::swap(current, trial_);
      return "";
    }
    if (search_line(system, current, *std::ranges::max_element(merits_))) {
      merits_[std::size_t(k) % memory] = merit_;
    } else if (++jumps <= jump_limit && std::isfinite(residual)) {
      std::swap(current, trial_);
      merit_ = merit(system, current);
      merits_.fill(merit_);
    } else {
      current = best_;
      return "no fraction of a Newton step brings the point equations closer to zero";
    }
    const double reached = system.residual(current);
    if (reached < best) {
      best = reached;
      best_ = current;
    }
  }
  current = best_;
  return "the limit of Newton steps was reached";
}

}  // namespace ricochet
