#pragma once

/// @file The number σ of finite_layer.hpp, which makes the work of a step's forces the change of its energy, found
/// beside the places of the step.
namespace ricochet {

/// The balance at the last places asks for a σ, and the places depend on σ: what two rounds say of that tells where
/// both agree (the secant method). Where strains change next to contact nodes alone, as where one begins to touch,
/// places answer σ so that the work hardly does (dσ_asked/dσ near 1, "weak"): then a σ is kept for some rounds, in
/// which places settle, before the next one; and where that does not help, to the end.
class EnergySecant {
 public:
  /// Of a step: σ = 0.
  void start();
  /// With the σ that the balance asks for at places that were found with value(), what that balance lacks, the size
  /// below which that is too near to rounding to tell a slope, and whether these places have converged. True where a
  /// weak σ was changed: corrections of places are judged anew.
  bool choose(double asked, double lacking, double near_rounding, bool has_converged);
  [[nodiscard]] double value() const { return sigma_; }
  [[nodiscard]] bool is_weak() const { return is_weak_; }
  /// Several changes in a row brought nothing: it stays as it is.
  [[nodiscard]] bool is_settled() const { return vain_ >= most_vain; }

 private:
  static constexpr int most_vain = 3;  ///< changes in a row that do not halve what the energy lacks

  double sigma_ = 0.0;
  /// σ of the round before and what the balance of energy asked for then; NaN before the second round.
  double sigma_before_ = 0.0, asked_before_ = 0.0;
  double slope_ = 0.0;  ///< dσ_asked/dσ, the last; not finite: none
  bool is_weak_ = false;
  int settling_ = 0, vain_ = 0;  ///< rounds with this σ; changes in a row that brought nothing
  double least_lacking_ = 0.0;
};

}  // namespace ricochet
