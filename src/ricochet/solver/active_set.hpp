#pragma once

#include <Eigen/Cholesky>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file The frictionless contact problem on the condensed operator. Knows nothing of finite elements or time.
namespace ricochet {

/// Find r with 0 ≤ r_i ⟂ y_i = q_i + (W r)_i ≥ 0 for eligible i, r_i = 0 otherwise. W is symmetric positive definite on
/// the eligible points.
struct ComplementarityProblem {
  const Matrix* operator_matrix = nullptr;  ///< W
  const Vector* offset = nullptr;           ///< q
  const Vector* offset_rounding = nullptr;  ///< size of the rounding error of q
  const std::vector<char>* eligible = nullptr;
};

struct ComplementaritySolution {
  Vector reaction;     ///< r ≥ 0, exactly zero where not active
  int iterations = 0;  ///< factorizations or re-solves of the active block
  bool solved = false;
  const char* reason = "";  ///< why not, when not solved
};

/// Primal–dual active set, as block principal pivoting: all points on the wrong side change sides at once. When that
/// has not reduced their number for several steps (cycling), only the one with the largest index changes (Murty's
/// rule), which ends for every positive definite W; as soon as the number has fallen, blocks are used again. J. J.
/// Júdice, F. M. Pires, Comput. Oper. Res. 21 (1994) 587–596. The last active set is the next start.
///
/// Wrong sides are r_i < 0 (no tolerance: what is returned is never negative) and y_i below −(rounding of q_i + that of
/// W r).
class ActiveSetSolver {
 public:
  void solve(const ComplementarityProblem& problem, ComplementaritySolution& solution);
  /// Forgets the warm start and the factor. Call it before a problem with another operator: as long as the active set
  /// stays, the factor of its block is used again.
  void reset() {
    active_.clear();
    factored_indices_.clear();
  }
  /// The active set, for inspection and for a warm start from a checkpoint.
  [[nodiscard]] const std::vector<char>& active() const { return active_; }
  void set_active(std::vector<char> active) { active_ = std::move(active); }

 private:
  void collect_indices(const ComplementarityProblem& problem);
  bool solve_active(const ComplementarityProblem& problem);
  void find_violations(const ComplementarityProblem& problem);

  std::vector<char> active_;             ///< per point
  std::vector<Index> indices_;           ///< of active points
  std::vector<Index> factored_indices_;  ///< those of the current factor
  std::vector<Index> violations_;
  Matrix block_;
  Eigen::LLT<Matrix> factor_;
  Vector active_reaction_;
};

}  // namespace ricochet
