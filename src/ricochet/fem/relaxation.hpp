#pragma once

#include <Eigen/Core>
#include <cmath>

#include "ricochet/base/instruction_sets.hpp"

/// @file Stress relaxation: viscoelastic branches in addition to a material law (generalized
/// Maxwell model, Prony series).
///
/// A branch is a spring 2gμ in series with a dashpot whose internal strain A is a symmetric deviator in the undeformed
/// configuration, as Green's strain E is, and hence invariant under rotations. With q = dev E − A
///   energy gμ q : q,   stress 2gμ q (second Piola–Kirchhoff),   τ dA/dt = q,   dissipation (2gμ/τ) q : q ≥ 0
/// per undeformed volume. At small strain the shear modulus after a jump is μ (1 + Σ g e^(−t/τ)): the law is the
/// long-term response, and volumetric changes do not relax.
///
/// A step is solved in closed form for a strain that varies linearly from 2Ē − E₁ to E₁ over the time h, with Ē the
/// mean strain of the step. With x = h/τ and θ = 1/(1−e^(−x)) − 1/x, which increases from ½ to 1 with x,
///   q̄ = (dev(2(1−θ)Ē + (2θ−1)E₁) − A)/(1 + θx)  is the mean of q over the step,   A₁ = A + x q̄,
/// and for any h and J = 2Ē − E₀ − E₁,
///   2gμ q̄ : (E₁−E₀) = gμ (|q₁|² − |q₀|²) + 𝒟 + 2(1−θ) gμ J : (q₁−q₀),   𝒟 = gμ ((2θ−1)|q₁−q₀|² + 2x|q̄|²) ≥ 0.
/// If J = 0, 𝒟 is the exact dissipation ∫ (2gμ/τ)|q|² dt. (J is not zero if contact nodes without inertia jump at the
/// start of a step: finite_strain_step.hpp.) Long steps cause no oscillations; a branch then is relaxed at the end of
/// the step. (R. L. Taylor, K. S. Pister, G. L. Goudreau, Int. J. Numer. Methods Engrg. 2 (1970) 45–59, integrate
/// linear changes of the strain in this way.)
namespace ricochet {

template <class A, class B>
[[nodiscard]] double double_dot(const Eigen::MatrixBase<A>& a, const Eigen::MatrixBase<B>& b) {
  return a.cwiseProduct(b).sum();
}

/// Update of a branch over a step. Strains are matrices, or tensors of symmetric_tensor.hpp: of one point or of a pack.
class RelaxationRule {
 public:
  /// Requires x = h/τ > 0.
  explicit RelaxationRule(double x) : x_(x), excess_(excess(x)), scale_(1.0 / (1.0 + 0.5 * (1.0 + excess_) * x)) {}

  /// Returns q̄ from the deviators of Ē and E₁.
  template <class Strain>
  [[nodiscard]] RICOCHET_PART_OF_CALLER Strain mean(const Strain& middle, const Strain& end,
                                                    const Strain& internal) const {
    return scale_ * ((1.0 - excess_) * middle + excess_ * end - internal);
  }
  /// ∂q̄/∂Ē for given E₀: 1 for short h, and about 2τ/h for long h.
  [[nodiscard]] double stiffness() const { return (1.0 + excess_) * scale_; }
  /// ∂q̄/∂Ē at a given change ΔE = 2 (E₁ − Ē), and ∂q̄/∂ΔE at a given Ē.
  [[nodiscard]] double mean_stiffness() const { return scale_; }
  [[nodiscard]] double change_stiffness() const { return 0.5 * excess_ * scale_; }
  /// Returns A₁.
  template <class Strain>
  [[nodiscard]] RICOCHET_PART_OF_CALLER Strain next(const Strain& middle, const Strain& end,
                                                    const Strain& internal) const {
    return internal + x_ * mean(middle, end, internal);
  }
  /// Returns 𝒟/gμ, with E₀.
  template <class Strain>
  [[nodiscard]] RICOCHET_PART_OF_CALLER auto dissipation(const Strain& start, const Strain& middle, const Strain& end,
                                                         const Strain& internal) const {
    const Strain acting = mean(middle, end, internal);
    const Strain change = end - start - x_ * acting;
    return excess_ * double_dot(change, change) + 2.0 * x_ * double_dot(acting, acting);
  }
  /// Returns 2(1−θ)|q|² + 2(2θ−1) q₁:E of a strain E, with A at the start of the step. At E₀ + J half of its derivative
  /// is 2q̄ − q₁, the stress at the start of the path with the mean q̄ and the end value q₁.
  template <class Strain>
  [[nodiscard]] RICOCHET_PART_OF_CALLER auto start_energy(const Strain& strain, const Strain& internal,
                                                          const Strain& elastic_end) const {
    const Strain elastic = strain - internal;
    return (1.0 - excess_) * double_dot(elastic, elastic) + 2.0 * excess_ * double_dot(elastic_end, strain);
  }

 private:
  /// 2θ − 1 = coth(x/2) − 2/x.
  static double excess(double x) {
    const double y = 0.5 * x, square = y * y;
    if (y > 0.25) return 1.0 / std::tanh(y) - 1.0 / y;
    constexpr double series[] = {-1382.0 / 638512875.0, 2.0 / 93555.0, -1.0 / 4725.0,
                                 2.0 / 945.0,           -1.0 / 45.0,   1.0 / 3.0};
    double sum = 4.0 / 18243225.0;
    for (const double coefficient : series) sum = coefficient + square * sum;
    return y * sum;
  }

  double x_, excess_, scale_;
};

}  // namespace ricochet
