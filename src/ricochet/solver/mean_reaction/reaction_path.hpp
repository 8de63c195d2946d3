#pragma once

#include <vector>

#include "ricochet/solver/mean_reaction/normal_path.hpp"

/// @file Reactions of all rows along the path of a step: normal ones as in normal_path.hpp, with tangential ones that
/// lead from those at the start to those at the end,
///   0 ≤ r(τ) ⟂ y_N(τ) ≥ 0,   y(τ) = q₀ + τ (q₁ − q₀) + U ρ(τ),   ρ = (r, ρ_T).
/// At each point ρ_T is one of
///   D r(τ)  if it slips at the end, D = ρ_T/r there: it is on the cone all the way;
///   linear  from κ times that at the start and 1 − κ of that at the end, to that at the end.
/// With constant ρ_T, κ = 0, its work is ρ_T1·Δy_T, which dissipates energy for any path. If the work of a linear one
/// creates energy, or its slip reverses, κ is reduced; a point on the cone changes to κ = 0. All points are linear if
/// reactions along the cone would jump or not lead to ρ₁ (U_NN + U_NT D need not be a P-matrix), if friction has a
/// bound of its own, and if U is singular on the normal rows.
namespace ricochet {

class ReactionPath {
 public:
  ReactionPath() = default;
  ReactionPath(const ReactionPath&) = delete;
  ReactionPath& operator=(const ReactionPath&) = delete;

  /// Sets the rows of points, the normal one first, and U of all rows, to which a reference is kept. `definite`: U is
  /// positive definite on normal rows.
  void prepare(const Matrix& u, const std::vector<Index>& row_offset, bool definite);

  /// Discards data of earlier steps, so that a resumed run has the same bits.
  void begin_step();
  /// From now on, until the next step, shares do not grow, and points that have left the cone stay off it: the mean is
  /// then the same function of ρ₁ in every iteration, except for finitely many changes.
  void freeze_shares() { shares_frozen_ = true; }

  struct Step {
    const Vector &q0, &q1, &start, &end;  ///< q₀, q₁, ρ₀, ρ₁, all rows
    const Vector& friction;               ///< per point: F; 0 if ρ_T is not bounded by F r alone
    const std::vector<char>&eligible, &pressing;
  };
  /// Returns false if the pressing points were not found.
  [[nodiscard]] bool follow(const Step& step);

  /// ∫ ρ dτ, all rows.
  [[nodiscard]] const Vector& mean() const { return mean_; }
  /// r(0+), per point.
  [[nodiscard]] const Vector& start() const { return selected_->start(); }
  /// Path of normal rows without friction.
  [[nodiscard]] NormalPath& normal() { return normal_; }
  /// ρ_T(0+)·(y_T(0+) − y_T0) + ∫ ρ_T·dy_T, y_T0 = 0, of all points. Each part is at most rounding.
  [[nodiscard]] double friction_work() const { return friction_work_; }

 private:
  [[nodiscard]] bool has_friction(std::size_t point) const { return row_offset_[point + 1] > row_offset_[point] + 1; }
  void choose_friction(const Step& step);
  void set_friction(const Step& step);
  [[nodiscard]] bool follow_normal(const Step& step);
  [[nodiscard]] bool leads_to_end(const Step& step) const;
  void compute_state(const Step& step, double time, const Vector& normal, Vector& reaction, Vector& motion) const;
  void find_works(const Step& step);
  [[nodiscard]] bool dissipates(const Step& step, bool is_last);

  const Matrix* u_ = nullptr;
  bool definite_ = true;
  std::vector<Index> row_offset_, normal_rows_;
  Matrix normal_u_, path_u_;
  NormalPath normal_, along_;  ///< along_: with friction proportional to the normal reactions
  NormalPath* selected_ = &normal_;
  std::vector<double> share_;        ///< κ per point; on_cone: ρ_T = D r
  std::vector<double> share_limit_;  ///< upper bounds of the shares
  bool shares_frozen_ = false;
  Vector ratio_;  ///< D per tangential row
  Vector friction_start_, friction_end_, normal_q0_, normal_q1_, work_, mean_;
  Vector reaction_, motion_, reaction_before_, motion_before_, all_;
  double friction_work_ = 0.0;
};

}  // namespace ricochet
