#include "ricochet/solver/coulomb_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

namespace {
constexpr double epsilon = std::numeric_limits<double>::epsilon();
/// Rounding of a sum, in units of the sum of absolute values.
constexpr double rounding = 32.0 * epsilon;
/// Of the data's size, beyond rounding: accepted where nothing improves any more.
constexpr double loosest = 1e-12;
/// Sweeps before the first Newton step: from zero, and from an earlier solution.
constexpr int cold_sweeps = 20;
constexpr int warm_sweeps = 3;
/// Newton steps in a row before the sweeps take over again.
constexpr int newton_limit = 30;
/// Of sweeps and Newton in turn; the number of sweeps doubles every time.
constexpr int round_limit = 6;
/// Part of a point's correction that is taken.
constexpr double smallest_damping = 0.125;
/// Of long runs of sweeps at the very end, and their length in entries of W.
constexpr int last_rounds = 20;
constexpr double last_work = 2e7;
/// Halvings of a Newton step.
constexpr int cut_limit = 8;

double squared(double value) {
  return value * value;
}
}  // namespace

void CoulombSolver::reset() {
  warm_start_.resize(0);
  newton_.reset();
}

void CoulombSolver::set_warm_start(Vector reaction) {
  warm_start_ = std::move(reaction);
  newton_.reset();
}

/// The points, and the powers of two in which they compare.
void CoulombSolver::prepare(const CoulombProblem& problem) {
  const Matrix& w = *problem.operator_matrix;
  points_.clear();
  double largest = 0.0;
  for (std::size_t i = 0; i + 1 < problem.first->size(); ++i) {
    if ((*problem.eligible)[i] == 0) continue;
    CoulombPoint point;
    point.point = static_cast<Index>(i);
    point.first = (*problem.first)[i];
    point.size = (*problem.first)[i + 1] - point.first;
    if (point.size > 1) {
      point.coefficient = (*problem.friction_coefficient)[point.point];
      point.bound = (*problem.friction_bound)[point.point];
    }
    points_.push_back(point);
    largest = std::max(largest, w.diagonal().segment(point.first, point.size).maxCoeff());
  }
  data_size_ = 0.0;
  // The root of a power of two is one only for even powers: W's largest diagonal is brought between one and two first.
  const double unit = std::isnormal(largest) ? std::ldexp(1.0, -std::ilogb(largest)) : 1.0;
  for (CoulombPoint& point : points_) {
    const double diagonal = w.diagonal().segment(point.first, point.size).maxCoeff();
    if (std::isnormal(diagonal) && diagonal > 0.0) {
      point.step = std::ldexp(1.0, -std::ilogb(diagonal));
      point.weight = std::ldexp(1.0, -(std::ilogb(diagonal * unit) >> 1));
    }
    // Written so that what is not a number is kept.
    const double size = point.weight * problem.offset->segment(point.first, point.size).cwiseAbs().sum();
    if (!(size <= data_size_)) data_size_ = size;
  }
}

/// ρ = 0 is a solution.
bool CoulombSolver::is_open(const CoulombProblem& problem) const {
  return std::all_of(points_.begin(), points_.end(), [&](const CoulombPoint& point) {
    const double u = (*problem.offset)[point.first];
    return u >= -((*problem.offset_rounding)[point.first] + rounding * std::abs(u));
  });
}

/// u of a ρ, its rounding, and what the natural map says of it.
void CoulombSolver::evaluate(const CoulombProblem& problem, CoulombIterate& iterate) const {
  const Matrix& w = *problem.operator_matrix;
  iterate.motion = *problem.offset;
  iterate.size = iterate.motion.cwiseAbs();
  for (const CoulombPoint& point : points_) {
    for (Index row = point.first; row < point.first + point.size; ++row) {
      const double rho = iterate.reaction[row];
      if (rho == 0.0) continue;
      iterate.motion += rho * w.col(row);
      iterate.size += std::abs(rho) * w.col(row).cwiseAbs();
    }
  }
  measure(problem, iterate);
}

void CoulombSolver::measure(const CoulombProblem& problem, CoulombIterate& iterate) const {
  iterate.merit = 0.0;
  iterate.residual = 0.0;
  iterate.beyond_floor = 0.0;
  iterate.exact = true;
  for (const CoulombPoint& point : points_) {
    const PointVector rho = iterate.reaction.segment(point.first, point.size);
    const PointVector u = iterate.motion.segment(point.first, point.size);
    const double value = natural_residual(point, rho, u);
    const PointVector own = rounding * iterate.size.segment(point.first, point.size);
    const double floor = (problem.offset_rounding->segment(point.first, point.size) + own).maxCoeff();
    iterate.exact = iterate.exact && value <= own.maxCoeff();
    iterate.merit += squared(point.weight * value);
    iterate.residual = std::max(iterate.residual, point.weight * value);
    if (!(value <= floor)) iterate.beyond_floor = std::max(iterate.beyond_floor, point.weight * (value - floor));
  }
  if (!std::isfinite(iterate.merit)) iterate.beyond_floor = std::numeric_limits<double>::infinity();
}

/// The last ρ where it is still admissible.
void CoulombSolver::start(const CoulombProblem& problem) {
  Vector& reaction = current_.reaction;
  reaction.setZero(problem.offset->size());
  if (warm_start_.size() == reaction.size() && warm_start_.allFinite()) {
    for (const CoulombPoint& point : points_) {
      auto rho = reaction.segment(point.first, point.size);
      rho = warm_start_.segment(point.first, point.size);
      rho[0] = std::max(rho[0], 0.0);
      const double limit = point.friction_limit(rho[0]);
      const double length = rho.tail(point.size - 1).norm();
      if (length > limit) rho.tail(point.size - 1) *= limit / length;
    }
  }
}

/// Projected block Gauss–Seidel, in the order of the points. Ends early when it has found which points are open, stick
/// and slip, as far as two sweeps can tell. True: solved.
bool CoulombSolver::sweep(const CoulombProblem& problem, int sweeps, CoulombSolution& solution) {
  const Matrix& w = *problem.operator_matrix;
  Vector& u = current_.motion;
  sweep_status_.assign(points_.size(), 0);
  int unchanged = 0;
  for (int k = 1; k <= sweeps && unchanged < 2; ++k) {
    ++solution.iterations;
    bool changed = false;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const CoulombPoint& point = points_[i];
      auto rho = current_.reaction.segment(point.first, point.size);
      if (u[point.first] >= 0.0 && rho.isZero(0.0)) continue;
      const PointMatrix block = w.block(point.first, point.first, point.size, point.size);
      const PointVector offset = u.segment(point.first, point.size) - block * rho;
      const PointVector found = solve_point(point, block, offset, rho[0] > 0.0);
      char status = found[0] > 0.0 ? 1 : 0;
      if (status != 0 && point.has_friction()) {
        const double length = found.tail(point.size - 1).norm();
        if (length < point.friction_limit(found[0]) * (1.0 - 8.0 * epsilon)) status = 2;
      }
      const PointVector next = damping_ < 1.0 ? PointVector(rho + damping_ * (found - rho)) : found;
      changed = changed || status != sweep_status_[i];
      sweep_status_[i] = status;
      for (Index row = 0; row < point.size; ++row) {
        const double change = next[row] - rho[row];
        if (change != 0.0) u += change * w.col(point.first + row);
      }
      rho = next;
    }
    unchanged = changed || sweeps > cold_sweeps ? 0 : unchanged + 1;
    if (sweeps > cold_sweeps && k % 16 == 0) {
      evaluate(problem, current_);
      if (current_.beyond_floor == 0.0 || !std::isfinite(current_.merit)) break;
    }
  }
  evaluate(problem, current_);
  if (current_.merit < best_.merit) best_ = current_;
  return current_.beyond_floor == 0.0;
}

/// From `current_` towards the full step `trial_`: the whole, half, quarter, … of it with a smaller merit becomes
/// `current_`.
bool CoulombSolver::search_line(const CoulombProblem& problem) {
  double length = 1.0;
  for (int k = 0; k <= cut_limit; ++k, length *= 0.5) {
    if (k > 0) {
      cut_.reaction = current_.reaction + length * (trial_.reaction - current_.reaction);
      cut_.motion = current_.motion + length * (trial_.motion - current_.motion);
      cut_.size = current_.size + length * (trial_.size - current_.size);
      measure(problem, cut_);
    }
    CoulombIterate& candidate = k == 0 ? trial_ : cut_;
    if (candidate.merit < (1.0 - 1e-4 * length) * current_.merit) {
      std::swap(current_, candidate);
      return true;
    }
  }
  return false;
}

/// Without the line search an active set may pass through a large residual: where conditions depend on one another, two
/// points have to be pressed against each other until one of them slips.
bool CoulombSolver::newton(const CoulombProblem& problem, bool line_search, CoulombSolution& solution) {
  for (int k = 0; k < newton_limit; ++k) {
    ++solution.iterations;
    ++solution.newton_steps;
    if (!newton_.step(problem, points_, current_, trial_.reaction)) return false;
    if (newton_.has_factored()) ++solution.factorizations;
    evaluate(problem, trial_);
    if (newton_.refine(trial_, trial_.reaction)) evaluate(problem, trial_);
    if (trial_.beyond_floor == 0.0) {
      std::swap(current_, trial_);
      return true;
    }
    bool moved = true;
    if (line_search) {
      moved = search_line(problem);
    } else {
      std::swap(current_, trial_);
    }
    if (moved && current_.merit < best_.merit) best_ = current_;
    if (!moved) return false;
  }
  return false;
}

/// Puts ρ on the law where rounding has left it beside, tells the states, and has the last word.
bool CoulombSolver::finish(const CoulombProblem& problem, CoulombSolution& solution) {
  trial_.reaction.setZero(problem.offset->size());
  for (const CoulombPoint& point : points_) {
    const auto rho = current_.reaction.segment(point.first, point.size);
    PointVector tau = rho - point.step * current_.motion.segment(point.first, point.size);
    auto result = trial_.reaction.segment(point.first, point.size);
    const bool grazing = point.is_tresca() && rho[0] == 0.0;
    if (grazing) result = rho;
    if (!(rho[0] > 0.0)) continue;
    result = rho;
    if (point.size == 1) continue;
    tau[0] = 0.0;
    const double limit = point.friction_limit(rho[0]);
    const double length = tau.norm();
    auto friction = result.tail(point.size - 1);
    if (length >= limit && length > 0.0) friction = tau.tail(point.size - 1) * (limit / length);
    const double size = friction.norm();
    if (size > limit) friction *= limit / size;
  }
  evaluate(problem, trial_);
  if (!(trial_.beyond_floor <= loosest * data_size_)) return false;
  std::swap(current_, trial_);
  for (const CoulombPoint& point : points_)
    solution.status[static_cast<std::size_t>(point.point)] = status_of(problem, point);
  return true;
}

/// A sweep or an old ρ is accepted as soon as the rounding of q covers what is left. A Newton step leaves much less,
/// and a scheme that asks whether a gap is zero to rounding sees the difference: klr-conserving would open the point.
bool CoulombSolver::polish(const CoulombProblem& problem, CoulombSolution& solution) {
  if (!current_.exact) newton(problem, true, solution);
  return finish(problem, solution);
}

ContactStatus CoulombSolver::status_of(const CoulombProblem& problem, const CoulombPoint& point) const {
  const auto rho = current_.reaction.segment(point.first, point.size);
  if (rho.isZero(0.0)) return ContactStatus::open;
  if (!point.has_friction()) return ContactStatus::closed;
  const auto tangents = Eigen::seqN(point.first + 1, point.size - 1);
  const double limit = point.friction_limit(rho[0]) * (1.0 - 8.0 * epsilon);
  if (rho.tail(point.size - 1).norm() < limit) return ContactStatus::stick;
  const double floor = ((*problem.offset_rounding)(tangents) + rounding * current_.size(tangents)).maxCoeff();
  return current_.motion(tangents).norm() > floor ? ContactStatus::slip : ContactStatus::stick;
}

/// Sweeps and Newton in turn, from `current_`.
bool CoulombSolver::alternate(const CoulombProblem& problem, int sweeps, int rounds, CoulombSolution& solution) {
  best_ = current_;
  for (int round = 1; round <= rounds; ++round) {
    if (sweep(problem, sweeps, solution) && polish(problem, solution)) return true;
    if (newton(problem, true, solution) && finish(problem, solution)) return true;
    current_ = best_;
    if (newton(problem, false, solution) && finish(problem, solution)) return true;
    current_ = best_;
    if (best_.beyond_floor <= loosest * data_size_ && finish(problem, solution)) return true;
    current_ = best_;
    sweeps = cold_sweeps << round;
  }
  return false;
}

bool CoulombSolver::iterate(const CoulombProblem& problem, CoulombSolution& solution) {
  evaluate(problem, current_);
  if (current_.beyond_floor == 0.0 && polish(problem, solution)) return true;
  const bool cold = current_.reaction.isZero(0.0);
  damping_ = 1.0;
  if (alternate(problem, cold ? cold_sweeps : warm_sweeps, round_limit, solution)) return true;
  // Strong friction can make whole corrections circle; parts of them, from zero, then often arrive.
  fallback_ = best_;
  for (damping_ = 0.5; damping_ >= smallest_damping && std::isfinite(fallback_.merit); damping_ *= 0.5) {
    current_.reaction.setZero();
    evaluate(problem, current_);
    if (alternate(problem, 2 * cold_sweeps, round_limit, solution)) return true;
  }
  if (!std::isfinite(fallback_.merit)) {
    std::swap(current_, fallback_);
    return false;
  }
  return sweep_on(problem, solution);
}

/// The last resort: Gauss–Seidel for as long as it comes closer, with Newton tried now and then. Where conditions
/// depend on one another it may creep, and still arrive.
bool CoulombSolver::sweep_on(const CoulombProblem& problem, CoulombSolution& solution) {
  damping_ = 1.0;
  std::swap(current_, fallback_);
  const double rows = static_cast<double>(problem.offset->size());
  const int sweeps = static_cast<int>(std::clamp(last_work / (rows * rows), 100.0, 4000.0));
  for (int k = 0; k < last_rounds; ++k) {
    const double merit = current_.merit;
    best_ = current_;
    if (sweep(problem, sweeps, solution) && polish(problem, solution)) return true;
    if (!(current_.merit < 0.5 * merit)) break;
    fallback_ = current_;
    if (newton(problem, false, solution) && finish(problem, solution)) return true;
    current_ = fallback_;
  }
  std::swap(current_, best_);
  return false;
}

void CoulombSolver::solve(const CoulombProblem& problem, CoulombSolution& solution) {
  solution.solved = false;
  solution.reason = "";
  solution.iterations = solution.newton_steps = solution.factorizations = 0;
  solution.reaction.setZero(problem.offset->size());
  solution.status.assign(problem.first->size() - 1, ContactStatus::open);
  prepare(problem);
  if (!std::isfinite(data_size_)) {
    solution.residual = data_size_;
    solution.reason = "the data of the contact problem are not finite";
    return;
  }
  solution.residual = 0.0;
  solution.solved = is_open(problem);
  if (solution.solved) {
    warm_start_ = solution.reaction;
    return;
  }
  start(problem);
  solution.solved = iterate(problem, solution);
  solution.reaction = current_.reaction;
  solution.residual = current_.residual / data_size_;
  if (solution.solved) {
    warm_start_ = solution.reaction;
  } else {
    solution.reason =
        std::isfinite(current_.merit)
            ? "the conditions of contact and friction are still not met after the largest number of iterations"
            : "the iteration diverged: the contact operator is not positive definite";
  }
}

}  // namespace ricochet
