#include "ricochet/solver/active_set.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace ricochet {

namespace {
/// Block steps without fewer violations before single ones are taken.
constexpr int patience = 8;
/// Rounding of a sum, in units of the sum of absolute values.
constexpr double rounding = 32.0 * std::numeric_limits<double>::epsilon();
}  // namespace

void ActiveSetSolver::collect_indices(const ComplementarityProblem& problem) {
  const auto count = static_cast<std::size_t>(problem.offset->size());
  active_.resize(count, 0);
  indices_.clear();
  for (std::size_t i = 0; i < count; ++i) {
    if ((*problem.eligible)[i] == 0) active_[i] = 0;
    if (active_[i] != 0) indices_.push_back(static_cast<Index>(i));
  }
}

/// r on the active points from W_AA r_A = −q_A. The factor is kept while the set is.
bool ActiveSetSolver::solve_active(const ComplementarityProblem& problem) {
  const auto count = static_cast<Index>(indices_.size());
  if (indices_ != factored_indices_) {
    block_.resize(count, count);
    for (Index j = 0; j < count; ++j) {
      for (Index i = 0; i < count; ++i) {
        block_(i, j) =
            (*problem.operator_matrix)(indices_[static_cast<std::size_t>(i)], indices_[static_cast<std::size_t>(j)]);
      }
    }
    // A power of two brings the diagonal near one: the square roots, and so the bits, do not depend on the unit system.
    if (count > 0) block_ *= std::ldexp(1.0, -std::ilogb(block_.diagonal().maxCoeff()));
    factor_.compute(block_);
    factored_indices_ = indices_;
    if (count > 0 && factor_.info() != Eigen::Success) {
      factored_indices_.clear();
      return false;
    }
  }
  active_reaction_.resize(count);
  for (Index i = 0; i < count; ++i) active_reaction_[i] = -(*problem.offset)[indices_[static_cast<std::size_t>(i)]];
  if (count > 0) {
    factor_.solveInPlace(active_reaction_);
    double largest = 0.0;
    for (const Index i : indices_) largest = std::max(largest, (*problem.operator_matrix)(i, i));
    active_reaction_ *= std::ldexp(1.0, -std::ilogb(largest));
  }
  return true;
}

void ActiveSetSolver::find_violations(const ComplementarityProblem& problem) {
  const Matrix& w = *problem.operator_matrix;
  violations_.clear();
  for (std::size_t k = 0, i = 0; i < active_.size(); ++i) {
    if (active_[i] != 0) {
      if (active_reaction_[static_cast<Index>(k)] < 0.0) violations_.push_back(static_cast<Index>(i));
      ++k;
      continue;
    }
    if ((*problem.eligible)[i] == 0) continue;
    const auto row = static_cast<Index>(i);
    double value = (*problem.offset)[row];
    double size = std::abs(value);
    for (std::size_t j = 0; j < indices_.size(); ++j) {
      const double term = w(indices_[j], row) * active_reaction_[static_cast<Index>(j)];
      value += term;
      size += std::abs(term);
    }
    if (value < -((*problem.offset_rounding)[row] + rounding * size)) violations_.push_back(row);
  }
}

void ActiveSetSolver::solve(const ComplementarityProblem& problem, ComplementaritySolution& solution) {
  solution.solved = false;
  solution.iterations = 0;
  const auto count = static_cast<int>(problem.offset->size());
  const int limit = 1000 + 20 * count;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int blocks_left = patience;
  while (solution.iterations < limit) {
    collect_indices(problem);
    ++solution.iterations;
    if (!solve_active(problem)) {
      solution.reason = "the contact operator is not positive definite: contact conditions depend on one another";
      return;
    }
    find_violations(problem);
    if (violations_.empty()) {
      solution.reaction.setZero(count);
      for (std::size_t k = 0; k < indices_.size(); ++k)
        solution.reaction[indices_[k]] = active_reaction_[static_cast<Index>(k)];
      solution.solved = true;
      return;
    }
    if (violations_.size() < fewest) {
      fewest = violations_.size();
      blocks_left = patience;
    } else if (blocks_left > 0) {
      --blocks_left;
    }
    if (blocks_left > 0) {
      for (const Index i : violations_) active_[static_cast<std::size_t>(i)] ^= 1;
    } else {
      active_[static_cast<std::size_t>(violations_.back())] ^= 1;
    }
  }
  solution.reason = "the active set still changes after the largest number of iterations";
}

}  // namespace ricochet
