#pragma once

#include <array>
#include <cstddef>
#include <vector>

/// @file Mean of the stress along the path of the strain over a step.
///
/// From the displacement u⁺ at its start to u₁ the strain of a step varies linearly by ΔE = E(u₁) − E(u⁺) about its
/// mean Ē = ½ (E(u⁺) + E(u₁)). With Gauss points τ_q on [−½, ½] and weights w_q of sum 1 the mean stress of this path,
///   S̄ = Σ_q w_q S(Ē + τ_q ΔE),
/// satisfies S̄ : ΔE = W(E(u₁)) − W(E(u⁺)) up to an error of order |ΔE|^(2n+1) for n points. Where |ΔE| is large,
/// c ΔE with the number c of a cell that makes Σ ∫ (S̄ + c ΔE) : ΔE exact is added (O. Gonzalez, J. Nonlinear Sci. 6
/// (1996) 449–467); the fewer points there are, the larger is c. All strains of the path have a positive volume if both
/// ends have one.
namespace ricochet {

/// Rule for the path of a cell: number of Gauss points, and whether the work of the cell is made exact.
enum class PathRule : unsigned char { two_points, three_points, three_points_exact, five_points_exact };

/// One rule per cell, through all blocks. The rules stay the same while the equations of a step are solved, so that the
/// force is a continuous function of the displacements.
using PathRules = std::vector<PathRule>;

/// Returns the rule for the largest |ΔE|² (square of the Frobenius norm) in a cell. Relative to the change of the
/// energy the work of a cell is then wrong by some 10⁻⁹ at most.
[[nodiscard]] constexpr PathRule path_rule(double square_of_change) {
  constexpr double three_points = 1e-2, exact = 5e-2, five_points = 1e-1;
  return square_of_change > five_points * five_points     ? PathRule::five_points_exact
         : square_of_change > exact * exact               ? PathRule::three_points_exact
         : square_of_change > three_points * three_points ? PathRule::three_points
                                                          : PathRule::two_points;
}
[[nodiscard]] constexpr bool is_exact(PathRule rule) { return rule >= PathRule::three_points_exact; }

/// Gauss rule on [−½, ½]; the weights have the sum 1.
struct PathGaussRule {
  int count;
  std::array<double, 5> points, weights;
};
/// Gauss rules of all path rules, and the number of the one that a path rule uses.
[[nodiscard]] const std::array<PathGaussRule, 3>& path_gauss_rules();
[[nodiscard]] constexpr std::size_t gauss_rule_number(PathRule rule) {
  return rule == PathRule::five_points_exact ? 2 : rule == PathRule::two_points ? 0 : 1;
}

/// Direction of a derivative of D(x, Δ̂), the force of S̄ at the middle x = ½ (u⁺ + u₁) with the increment Δ̂ = u₁ − u⁺:
/// a motion ψ changes x by a ψ and Δ̂ by b ψ.
struct PathVariation {
  double middle = 0.0;     ///< a
  double increment = 0.0;  ///< b
};
/// ψ is a motion of the end u₁ with u⁺ held, or of the start u⁺ with u₁ held.
inline constexpr PathVariation of_path_end{0.5, 1.0}, of_path_start{0.5, -1.0};

}  // namespace ricochet
