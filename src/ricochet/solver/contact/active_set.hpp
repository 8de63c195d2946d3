#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "ricochet/linear_algebra/principal_factor.hpp"
#include "ricochet/solver/contact/contact_system.hpp"
#include "ricochet/solver/contact/dual_active_set.hpp"

/// @file Frictionless contact problems.
namespace ricochet {

/// Primal–dual active set method as block principal pivoting: all points on the wrong side change sides at once. If
/// that has not reduced their number for several steps (cycling), only the one with the largest index changes (Murty's
/// rule), which terminates for every positive definite W; as soon as the number has fallen, blocks are used again. J.
/// J. Júdice, F. M. Pires, Comput. Oper. Res. 21 (1994) 587–596. Starts from the points that have a reaction.
///
/// Wrong sides are r_i < 0 (no tolerance: no returned reaction is negative) and u_i below −(rounding of q_i + that of W
/// r). The factor follows the set (PrincipalFactor). If W is singular on a set that occurs, or so nearly that the
/// result is no solution, conditions depend on one another: DualActiveSet.
class PrimalDualActiveSet {
 public:
  /// Solves a system whose points have no friction, with entries in dense form. Counts its steps in `iterations`.
  /// Returns the reason of a failure, or nothing: `current` is the solution, evaluated. Shows the iterate after every
  /// step to `watch`, if given.
  using Watch = std::function<void(const ContactIterate& current)>;
  std::string solve(const ContactSystem& system, double tolerance, ContactIterate& current, int& iterations,
                    int& factorizations, const Watch& watch = {});
  /// Points of the problem that no motion satisfies together, see DualActiveSet.
  [[nodiscard]] const std::vector<Index>& contradiction() const { return dependent_.contradiction(); }
  void reset() {
    factor_.reset();
    base_.clear();
    has_base_to_factor_ = false;
  }

  /// Rows of the factor's base set, see IterativeContactSolver.
  [[nodiscard]] const std::vector<Index>& base() const { return base_; }
  void set_base(std::vector<Index> base) {
    reset();
    base_ = std::move(base);
    has_base_to_factor_ = true;
  }
  [[nodiscard]] bool keeps_row(Index problem_row) const { return std::ranges::binary_search(base_, problem_row); }

 private:
  void renumber(const ContactSystem& system);
  std::string pivot(const ContactSystem& system, ContactIterate& current, int& iterations, int& factorizations,
                    const Watch& watch);
  bool solve_active(const ContactSystem& system, ContactIterate& current);
  void find_violations(const ContactSystem& system, const ContactIterate& current);

  std::vector<char> active_;    ///< per point
  std::vector<Index> indices_;  ///< rows of active points
  std::vector<std::size_t> violations_;
  PrincipalFactor factor_;
  std::vector<Index> base_;  ///< of the factor, by rows of the problem
  std::vector<Index> renumbered_;
  bool has_base_to_factor_ = false;  ///< after set_base
  Vector right_, solution_;
  DualActiveSet dependent_;
  ContactIterate start_;
};

}  // namespace ricochet
