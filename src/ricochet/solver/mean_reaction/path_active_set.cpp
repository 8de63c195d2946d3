#include "ricochet/solver/mean_reaction/path_active_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

/// Part of U_pp that remains after elimination of the set, at which p depends on the set.
constexpr double dependent = 1e-11;

/// Computes x = U⁻¹x on the set.
void PathActiveSet::solve(Vector& x) const {
  const auto count = Index(set_.size());
  const auto lower = factor_.topLeftCorner(count, count).triangularView<Eigen::Lower>();
  lower.solveInPlace(x);
  lower.transpose().solveInPlace(x);
}

/// Appends a point. Returns false if it depends on those of the set.
bool PathActiveSet::append(const Matrix& u, Index point, double tolerance) {
  const auto count = Index(set_.size());
  if (factor_.rows() <= count) factor_.conservativeResize(u.rows(), u.cols());
  row_ = u(set_, point);
  factor_.topLeftCorner(count, count).triangularView<Eigen::Lower>().solveInPlace(row_);
  const double schur = u(point, point) - row_.squaredNorm();
  if (schur <= tolerance * u(point, point)) return false;
  factor_.row(count).head(count) = row_;
  factor_(count, count) = std::sqrt(schur);
  set_.push_back(point);
  return true;
}

/// Factorizes as many of the requested points as are independent.
void PathActiveSet::factorize(const Matrix& u) {
  set_.clear();
  for (const Index point : requested_) (void)append(u, point, dependent);
}

void PathActiveSet::remove(const Matrix& u, std::size_t index) {
  requested_ = set_;
  requested_.erase(requested_.begin() + std::ptrdiff_t(index));
  const auto last = Index(requested_.size());
  for (auto i = Index(index); i < last; ++i) reaction_[i] = reaction_[i + 1];
  reaction_.conservativeResize(last);
  factorize(u);
}

/// Starts from the guess, without dependent points and those that would pull.
void PathActiveSet::start(const Matrix& u, const Vector& q) {
  factorize(u);
  for (;;) {
    reaction_ = -q(set_);
    solve(reaction_);
    requested_.clear();
    for (std::size_t i = 0; i < set_.size(); ++i) {
      if (reaction_[Index(i)] >= 0.0) requested_.push_back(set_[i]);
    }
    if (requested_.size() == set_.size()) return;
    factorize(u);
  }
}

/// Raises the reaction of a point until its gap closes; points that would pull leave the set on the way.
bool PathActiveSet::add_point(const Matrix& u, Index point, double gap) {
  double own = 0.0;
  for (;;) {
    direction_ = u(set_, point);
    const double whole = u(point, point);
    Vector& change = direction_;
    row_ = change;
    solve(change);
    const double schur = whole - row_.dot(change);
    double length = schur > dependent * whole ? -gap / schur : std::numeric_limits<double>::infinity();
    std::size_t leaves = set_.size();
    for (std::size_t i = 0; i < set_.size(); ++i) {
      const auto at = Index(i);
      if (change[at] <= 0.0 || reaction_[at] >= length * change[at]) continue;
      length = reaction_[at] / change[at];
      leaves = i;
    }
    if (!(length < std::numeric_limits<double>::infinity())) return false;
    reaction_ -= length * change;
    own += length;
    gap += length * schur;
    if (leaves < set_.size()) {
      remove(u, leaves);
      continue;
    }
    if (!append(u, point, 0.1 * dependent)) return false;  // found independent above, in another way
    reaction_.conservativeResize(reaction_.size() + 1);
    reaction_[reaction_.size() - 1] = own;
    return true;
  }
}

bool PathActiveSet::find(const Matrix& u, const Vector& q, const std::vector<char>& eligible, double gap_rounding,
                         std::vector<char>& pressing) {
  requested_.clear();
  for (std::size_t i = 0; i < pressing.size(); ++i) {
    if (pressing[i] != 0 && eligible[i] != 0) requested_.push_back(Index(i));
  }
  start(u, q);
  const std::size_t max_iterations = 20 * pressing.size() + 100;
  for (std::size_t iteration = 0; iteration < max_iterations; ++iteration) {
    gap_ = q;
    for (std::size_t i = 0; i < set_.size(); ++i) gap_ += reaction_[Index(i)] * u.col(set_[i]);
    for (const Index point : set_) gap_[point] = 0.0;
    Index deepest = -1;
    for (Index i = 0; i < gap_.size(); ++i) {
      if (eligible[std::size_t(i)] == 0 || gap_[i] >= -gap_rounding) continue;
      if (deepest < 0 || gap_[i] < gap_[deepest]) deepest = i;
    }
    if (deepest < 0) {
      std::ranges::fill(pressing, char{0});
      for (const Index point : set_) pressing[std::size_t(point)] = 1;
      return true;
    }
    if (!add_point(u, deepest, gap_[deepest])) return false;
    // Discards the rounding accumulated in the reactions on the way.
    row_ = -q(set_);
    solve(row_);
    reaction_ = row_.cwiseMax(0.0);
  }
  return false;
}

}  // namespace ricochet
