#pragma once

/// @file Secant iteration for the scalar σ of finite_strain_step.hpp, for which the work of a step's forces is the
/// change of its energy. It runs along with the iterations for the displacements of the step.
namespace ricochet {

/// The energy balance at the last displacements determines a required σ, and the displacements depend on σ: two
/// iterations show where both agree (secant method). Where strains change only next to contact nodes, as when one
/// begins to touch, displacements respond to σ such that the work hardly changes (dσ_required/dσ near 1, "weak"): then
/// a σ is kept for some iterations, in which displacements settle, before the next one; if that does not help, to the
/// end.
class EnergySecant {
 public:
  /// Starts a step with σ = 0.
  void start();
  /// Updates σ from the value `required` that the balance requires at displacements found with value(), the energy
  /// defect `defect` of that balance, the size below which a defect is too near to rounding to determine a slope, and
  /// whether these displacements have converged. Returns true if a weak σ was changed: corrections of displacements are
  /// then judged anew.
  bool choose(double required, double defect, double near_rounding, bool has_converged);
  [[nodiscard]] double value() const { return sigma_; }
  [[nodiscard]] bool is_weak() const { return is_weak_; }
  /// True if several changes in a row brought no progress: σ stays as it is.
  [[nodiscard]] bool is_settled() const { return stalled_changes_ >= max_stalled_changes; }

 private:
  static constexpr int max_stalled_changes = 3;  ///< changes in a row that do not halve the energy defect

  double sigma_ = 0.0;
  /// σ of the previous iteration and the value that the balance then required; NaN before the second iteration.
  double sigma_before_ = 0.0, required_before_ = 0.0;
  double slope_ = 0.0;  ///< last dσ_required/dσ; not finite if none
  bool is_weak_ = false;
  int settling_ = 0, stalled_changes_ = 0;  ///< iterations with this σ; changes in a row without progress
  double smallest_defect_ = 0.0;
};

}  // namespace ricochet
