#pragma once

#include <string>
#include <vector>

#include "ricochet/solver/contact/contact_system.hpp"

/// @file Frictionless contact problems whose conditions depend on one another.
namespace ricochet {

/// Dual active set method of D. Goldfarb and A. Idnani (Math. Program. 27 (1983) 1–33) for
///   min ½ rᵀW r + qᵀr,  r ≥ 0,   W positive semi-definite,
/// which has one motion u = q + W r if it has a solution, however many reactions produce it. It keeps a set P of points
/// with u_P = 0, r_P ≥ 0 and a positive definite W_PP. The point j with the deepest penetration enters along
///   d_P = −W_PP⁻¹ W_Pj,  d_j = 1,   on which u_P stays zero and u_j grows by s = W_jj + W_jP d_P per unit,
/// until u_j = 0 or a reaction of P vanishes; that point leaves P. If j depends on P, s is zero and u_j waits until
/// enough points have left. If s is zero and no reaction decreases, d ≥ 0 with W d = 0 proves that no motion meets all
/// conditions: these points contradict one another.
class DualActiveSet {
 public:
  /// Solves on the normal rows of the points only: friction is left out. Requires entries in dense form. Starts from
  /// the points that press in `current`. Returns the reason of a failure, or nothing: `current` is the solution,
  /// evaluated. Counts the points that enter or leave in `iterations`.
  std::string solve(const ContactSystem& system, ContactIterate& current, int& iterations);
  /// Points of the problem that no motion satisfies together, ascending, after `solve`; empty: none were found.
  [[nodiscard]] const std::vector<Index>& contradiction() const { return contradiction_; }

 private:
  /// Effect of a point's entry.
  struct Entry {
    double curvature = 0.0;  ///< s
    double rounding = 0.0;   ///< size of the terms of s, times ε
  };

  [[nodiscard]] Index point_count() const { return Index(system_->points().size()); }
  [[nodiscard]] Index row_of(Index point) const { return system_->points()[std::size_t(point)].row; }
  [[nodiscard]] double floor_of(Index point, const ContactIterate& current) const;
  void start(const ContactIterate& current);
  Entry examine(Index entering);
  void append(Index point, double curvature);
  void remove(std::size_t position);
  void solve_set(const Vector& motion);
  void correct(ContactIterate& current);
  [[nodiscard]] Index most_violated(const ContactIterate& current) const;
  bool enter(Index entering, ContactIterate& current, int& iterations, int limit);
  [[nodiscard]] bool is_contradiction(Index entering, const Entry& entry, const ContactIterate& current) const;
  void note_contradiction(Index entering);

  const ContactSystem* system_ = nullptr;
  std::vector<Index> set_;     ///< P: numbers of the system's points, in the order of the factor
  std::vector<Index> rows_;    ///< their normal rows
  Matrix factor_;              ///< W_PP = L Lᵀ in its lower left corner
  Vector forward_;             ///< L⁻¹ W_Pj
  Vector direction_;           ///< d_P
  std::vector<char> excused_;  ///< per point of the system: no room for it, possibly due to rounding
  std::vector<Index> contradiction_;
};

}  // namespace ricochet
