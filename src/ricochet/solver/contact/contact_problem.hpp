#pragma once

#include <memory>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/solver/contact/contact_operator.hpp"

/// @file The contact problem of a step, independent of finite elements and time.
namespace ricochet {

/// Point i has the rows row_offset[i] … row_offset[i+1]−1: its normal, then (if it can have friction) its d−1 tangents.
/// The unknowns are the reactions r and the motion u (velocities or gaps, as q is) with
///   u = q + W r,
/// and at every eligible point
///   0 ≤ r_N ⟂ u_N ≥ 0,   |r_T| ≤ b,   r_T = −b u_T/|u_T| where u_T ≠ 0,
/// with b = F r_N (Coulomb; no bound), b = min(F r_N, bound) (Coulomb's law with a limit), or b = bound where r_N > 0
/// and b = 0 where r_N = 0 (Tresca: F = 0 < bound); r_i = 0 at the others. The disc |r_T| ≤ b is not replaced by a
/// polygon. Without bounds this is the cone complementarity problem of De Saxcé,
///   K* ∋ û ⟂ r ∈ K,   û = u + (F |u_T|, 0, 0),   K = {|r_T| ≤ F r_N},
/// the form in which FCLib states it.
///
/// Tresca's b jumps at r_N = 0, and a solution need not exist then: friction can hold up a point that would penetrate
/// without it. The law is closed there: at a grazing point (r_N = 0 = u_N) any b in [0, bound] is admitted, the limit
/// of b = min(bound, k r_N) for k → ∞.
struct ContactProblem {
  std::shared_ptr<const ContactOperator> contact_operator;  ///< W
  Vector offset;                                            ///< q, per row
  std::vector<Index> row_offset;                            ///< points + 1
  Vector friction_coefficient;                              ///< F ≥ 0, per point
  Vector friction_bound;                                    ///< per point, in units of r; 0 if none. Empty: none
                                                            ///< anywhere
  Vector offset_rounding;            ///< size of the rounding error of q, per row. Empty: q is exact
  std::vector<char> eligible;        ///< per point: may have a reaction. Empty: all
  std::vector<Index> point_numbers;  ///< in the original problem; empty: 0, 1, …. For reports
  /// Whether W is symmetric and positive semi-definite. If it is neither, "automatic" still solves problems that are
  /// near enough to such ones, as those of an exact tangent; other solvers require it.
  bool is_symmetric = true;
  double reaction_scale = 1.0;  ///< factor of r relative to the force (a power of two). For reports, not used by
                                ///< solvers

  ContactProblem() = default;
  /// `dimension` rows per point: 1 (no friction), 2 or 3. One F for all points.
  ContactProblem(Index dimension, Matrix w, Vector q, double friction);
  ContactProblem(Index dimension, std::shared_ptr<const ContactOperator> w, Vector q, Vector friction);

  [[nodiscard]] Index points() const { return Index(row_offset.size()) - 1; }
  [[nodiscard]] Index rows() const { return offset.size(); }
  [[nodiscard]] bool is_eligible(Index point) const { return eligible.empty() || eligible[std::size_t(point)] != 0; }
  [[nodiscard]] Index number_of(Index point) const {
    return point_numbers.empty() ? point : point_numbers[std::size_t(point)];
  }
  [[nodiscard]] double bound(Index point) const { return friction_bound.size() > 0 ? friction_bound[point] : 0.0; }
  /// Throws Error(invalid_input), which names the point, if sizes do not agree, or a coefficient or bound is negative
  /// or not finite. Errors in q and W are reported by the solvers (ContactOutcome::invalid_data).
  void validate() const;
};

/// Returns whether these are first rows of points, in the order of the points; `distinct`: each at most once. The rows
/// may be any numbers.
[[nodiscard]] bool are_first_rows(const std::vector<Index>& row_offset, const std::vector<Index>& rows, bool distinct);

}  // namespace ricochet
