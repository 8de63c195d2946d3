#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Contact law of Nitsche's method over a step of the midpoint rule.
namespace ricochet {

/// Per point: s the force that balances the stress of the body, g the gap, Γ a stiffness, p = s − Γ g. The obstacle's
/// force r and f = Sᵀ q are
///   r = [½(p₀+p₁)]₊ where p₀ > 0, else ½[p₁]₊;   Γ q = ½(s₀+s₁) − r,
/// and s₁ = s + S A⁻¹(Gᵀr + Sᵀq), g₁ = g + G A⁻¹(Gᵀr + Sᵀq) from s and g, those without forces.
class NitscheLaw {
 public:
  /// `response` is [G; S] A⁻¹ [G; S]ᵀ, 2 points × 2 points; `stiffness` is Γ, with Γ − ½ S A⁻¹Sᵀ positive definite.
  NitscheLaw(const Matrix& response, const Vector& stiffness);

  /// p₀, s₀ and, without forces, s and g.
  struct Points {
    Vector p_before, s_before, s, gap;
  };
  /// Allocates nothing while no point presses.
  void solve(const Points& points, Vector& r, Vector& q);

 private:
  Vector stiffness_;
  Matrix q_of_stress_, q_of_r_;  ///< q = q_of_stress ½(s₀+s) + q_of_r r
  Matrix p_of_q_;                ///< change of p₁ due to f
  Matrix compliance_;            ///< decrease of p₁/Γ per r; with 2/Γ, symmetric
  Vector mean_, p_;              ///< work space
  std::vector<char> first_;
};

/// −½Σs²/Γ + ½Σ[p]₊²/Γ, the contribution of Nitsche's method to the energy.
[[nodiscard]] double nitsche_energy(const Vector& stiffness, const Vector& stress_force, const Vector& p);
/// Dissipation of the law in a step: Σ 1/Γ times 0 if p₀, p₁ > 0; ½p₁² if p₀ > 0 ≥ p₁ and r > 0; ½p₀² if r = 0 < p₀;
/// ½p₁|p₀| if p₁ > 0 ≥ p₀.
[[nodiscard]] double nitsche_dissipation(const Vector& stiffness, const Vector& p_before, const Vector& p_after);

}  // namespace ricochet
