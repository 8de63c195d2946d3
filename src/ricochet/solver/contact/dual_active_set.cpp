#include "ricochet/solver/contact/dual_active_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

/// Multiple of the rounding of its terms below which a curvature is zero. It need not be sharp: a smaller one makes a
/// long step, which ends with the first reaction that vanishes.
constexpr double vanishing = 8.0;
/// Likewise if no reaction vanishes and a long step would be taken.
constexpr double contradicting = 64.0;
/// Rounding in d, relative to its largest entry.
constexpr double negligible = 1e-12;
/// Largest number of corrections of the reactions for the rounding in u_P.
constexpr int corrections = 3;

/// Computes d_P and s of a row that enters. The rounding of L Lᵀ is that of √W_ii √W_jj, entry by entry.
DualActiveSet::Entry DualActiveSet::examine(Index entering) {
  const Matrix& w = *system_->dense();
  const auto count = Index(rows_.size());
  forward_.resize(count);
  for (Index i = 0; i < count; ++i) forward_[i] = w(rows_[std::size_t(i)], entering);
  const auto lower = factor_.topLeftCorner(count, count).triangularView<Eigen::Lower>();
  lower.solveInPlace(forward_);
  direction_ = -forward_;
  lower.transpose().solveInPlace(direction_);
  double terms = std::sqrt(w(entering, entering));
  for (Index i = 0; i < count; ++i) {
    const Index at = rows_[std::size_t(i)];
    terms += std::abs(direction_[i]) * std::sqrt(w(at, at));
  }
  return {w(entering, entering) - forward_.squaredNorm(), machine_epsilon * terms * terms};
}

/// Appends the point examined by examine.
void DualActiveSet::append(Index point, double curvature) {
  const auto count = Index(rows_.size());
  if (factor_.rows() <= count) {
    const Index size = std::min(system_->rows(), std::max<Index>(2 * count, 16));
    factor_.conservativeResize(size, size);
  }
  factor_.row(count).head(count) = forward_.transpose();
  factor_(count, count) = std::sqrt(curvature);
  set_.push_back(point);
  rows_.push_back(row_of(point));
}

/// Removes a row from L by rotations, which leave it triangular.
void DualActiveSet::remove(std::size_t position) {
  const auto count = Index(rows_.size());
  for (auto i = Index(position); i + 1 < count; ++i) {
    factor_.row(i).head(i + 2) = factor_.row(i + 1).head(i + 2);
    const double diagonal = factor_(i, i), beside = factor_(i, i + 1);
    const double length = std::hypot(diagonal, beside);
    const double cosine = diagonal / length, sine = beside / length;
    factor_(i, i) = length;
    for (Index k = i + 2; k < count; ++k) {
      const double one = factor_(k, i), other = factor_(k, i + 1);
      factor_(k, i) = cosine * one + sine * other;
      factor_(k, i + 1) = cosine * other - sine * one;
    }
  }
  rows_.erase(rows_.begin() + std::ptrdiff_t(position));
  set_.erase(set_.begin() + std::ptrdiff_t(position));
}

/// Starts from the pressing points, as far as they are independent and press without the others.
void DualActiveSet::start(const ContactIterate& current) {
  set_.clear();
  rows_.clear();
  std::vector<Index> pressing;
  for (Index k = 0; k < point_count(); ++k) {
    if (current.reaction[row_of(k)] > 0.0) pressing.push_back(k);
  }
  while (true) {
    set_.clear();
    rows_.clear();
    for (const Index k : pressing) {
      const Entry entry = examine(row_of(k));
      if (entry.curvature > contradicting * entry.rounding) append(k, entry.curvature);
    }
    solve_set(system_->offset());
    pressing.clear();
    for (std::size_t i = 0; i < set_.size(); ++i) {
      if (direction_[Index(i)] >= 0.0) pressing.push_back(set_[i]);
    }
    if (pressing.size() == set_.size()) return;
  }
}

/// Computes −W_PP⁻¹ u_P in `direction_`.
void DualActiveSet::solve_set(const Vector& motion) {
  const auto count = Index(rows_.size());
  direction_.resize(count);
  for (Index i = 0; i < count; ++i) direction_[i] = -motion[rows_[std::size_t(i)]];
  const auto lower = factor_.topLeftCorner(count, count).triangularView<Eigen::Lower>();
  lower.solveInPlace(direction_);
  lower.transpose().solveInPlace(direction_);
}

/// Makes u_P zero to rounding and evaluates. Points whose reaction would thereby change its sign leave.
void DualActiveSet::correct(ContactIterate& current) {
  for (int k = 0; k < corrections; ++k) {
    system_->evaluate(current);
    const bool is_zero = std::ranges::all_of(
        set_, [&](Index point) { return std::abs(current.motion[row_of(point)]) <= 0.25 * floor_of(point, current); });
    if (is_zero) return;
    solve_set(current.motion);
    for (std::size_t i = rows_.size(); i-- > 0;) {
      double& reaction = current.reaction[rows_[i]];
      reaction += direction_[Index(i)];
      if (reaction >= 0.0) continue;
      reaction = 0.0;
      remove(i);
    }
  }
  system_->evaluate(current);
}

double DualActiveSet::floor_of(Index point, const ContactIterate& current) const {
  return system_->floor_of(system_->points()[std::size_t(point)], current).normal;
}

/// Returns −1 if no point outside of P penetrates.
Index DualActiveSet::most_violated(const ContactIterate& current) const {
  Index result = -1;
  double deepest = 0.0;
  for (Index k = 0; k < point_count(); ++k) {
    if (excused_[std::size_t(k)] != 0 || std::ranges::find(set_, k) != set_.end()) continue;
    const double motion = current.motion[row_of(k)];
    if (motion >= -floor_of(k, current) || motion >= deepest) continue;
    deepest = motion;
    result = k;
  }
  return result;
}

/// Returns whether the motion that these conditions require is out of reach by more than the rounding of all of them;
/// and, if s is not zero but hidden by its rounding, whether it would be larger than the data (both in the energy
/// norm).
bool DualActiveSet::is_contradiction(Index entering, const Entry& entry, const ContactIterate& current) const {
  const double lack = -current.motion[row_of(entering)];
  if (!(lack > std::sqrt(contradicting * entry.rounding) * system_->data())) return false;
  double rounding = floor_of(entering, current);
  for (std::size_t i = 0; i < set_.size(); ++i)
    rounding += std::max(direction_[Index(i)], 0.0) * floor_of(set_[i], current);
  return lack > rounding;
}

void DualActiveSet::note_contradiction(Index entering) {
  const auto number = [&](Index k) { return system_->points()[std::size_t(k)].point; };
  double largest = 1.0;
  for (const double part : direction_) largest = std::max(largest, part);
  contradiction_.assign(1, number(entering));
  for (std::size_t i = 0; i < set_.size(); ++i) {
    if (direction_[Index(i)] > 1e-9 * largest) contradiction_.push_back(number(set_[i]));
  }
  std::ranges::sort(contradiction_);
}

/// Returns false if the point contradicts others, or no further progress is possible.
bool DualActiveSet::enter(Index entering, ContactIterate& current, int& iterations, int limit) {
  const Index at = row_of(entering);
  double motion = current.motion[at];
  for (; iterations < limit; ++iterations) {
    const Entry entry = examine(at);
    const bool depends = !(entry.curvature > vanishing * entry.rounding);
    // Rounding in d must not let a point leave.
    const double smallest = -negligible * std::max(1.0, direction_.size() > 0 ? direction_.cwiseAbs().maxCoeff() : 0.0);
    double step = depends ? std::numeric_limits<double>::infinity() : -motion / entry.curvature;
    std::size_t leaving = set_.size();
    for (std::size_t i = 0; i < set_.size(); ++i) {
      const double rate = direction_[Index(i)];
      if (!(rate < smallest)) continue;
      const double reached = current.reaction[rows_[i]] / -rate;
      if (reached >= step) continue;
      step = reached;
      leaving = i;
    }
    if (leaving == set_.size() && !(entry.curvature > contradicting * entry.rounding)) {
      if (is_contradiction(entering, entry, current)) note_contradiction(entering);
      return false;
    }
    for (std::size_t i = 0; i < set_.size(); ++i) {
      double& reaction = current.reaction[rows_[i]];
      reaction = i == leaving ? 0.0 : std::max(reaction + step * direction_[Index(i)], 0.0);
    }
    current.reaction[at] += step;
    if (leaving == set_.size()) {
      append(entering, entry.curvature);
      ++iterations;
      return true;
    }
    if (!depends) motion += step * entry.curvature;
    remove(leaving);
  }
  return false;
}

std::string DualActiveSet::solve(const ContactSystem& system, ContactIterate& current, int& iterations) {
  system_ = &system;
  contradiction_.clear();
  excused_.assign(system.points().size(), 0);
  start(current);
  current.reaction.setZero(system.rows());
  solve_set(system.offset());
  for (std::size_t i = 0; i < rows_.size(); ++i) current.reaction[rows_[i]] = direction_[Index(i)];
  bool excused = false;
  const int limit = iterations + 1000 + 20 * int(point_count());
  while (iterations < limit) {
    correct(current);
    const Index entering = most_violated(current);
    if (entering < 0) return excused ? "contact conditions contradict one another, or nearly do" : "";
    if (enter(entering, current, iterations, limit)) continue;
    if (!contradiction_.empty()) return "contact conditions contradict one another: no motion meets them all";
    excused_[std::size_t(entering)] = 1;
    excused = true;
  }
  return "the active set still changes at the iteration limit";
}

}  // namespace ricochet
