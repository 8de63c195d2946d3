#pragma once

#include <algorithm>
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
/// ends have one. The work is a difference of energies because S = ∂W/∂E: a law with a state would need a path that is
/// followed point by point, its dissipation in the balance of the step, and no exact work.
namespace ricochet {

/// Rule for the path of a cell, in ascending accuracy: rules are raised in this order.
enum class PathRule : unsigned char { two_points, three_points, three_points_exact, five_points_exact };

/// Properties of a rule.
struct PathRuleProperties {
  PathRule rule;
  int points;    ///< number of Gauss points
  bool exact;    ///< whether the work of the cell is made exact
  double above;  ///< |ΔE| (Frobenius norm) in a cell above which the rule is chosen
};
inline constexpr std::array<PathRuleProperties, 4> path_rule_table{{{PathRule::two_points, 2, false, 0.0},
                                                                    {PathRule::three_points, 3, false, 1e-2},
                                                                    {PathRule::three_points_exact, 3, true, 5e-2},
                                                                    {PathRule::five_points_exact, 5, true, 1e-1}}};
[[nodiscard]] constexpr const PathRuleProperties& properties_of(PathRule rule) {
  return path_rule_table[std::size_t(rule)];
}
static_assert([] {
  for (std::size_t k = 0; k < path_rule_table.size(); ++k)
    if (path_rule_table[k].rule != PathRule(k)) return false;
  return true;
}());
[[nodiscard]] constexpr bool is_exact(PathRule rule) { return properties_of(rule).exact; }

/// One rule per cell, through all blocks. The rules stay the same while the equations of a step are solved, so that the
/// force is a continuous function of the displacements.
using PathRules = std::vector<PathRule>;

/// Returns the rule for the largest |ΔE|² in a cell. Relative to the change of the energy the work of a cell is then
/// wrong by some 10⁻⁹ at most.
[[nodiscard]] constexpr PathRule path_rule(double square_of_change) {
  PathRule result = path_rule_table.front().rule;
  for (const PathRuleProperties& each : path_rule_table)
    if (square_of_change > each.above * each.above) result = each.rule;
  return result;
}

/// Gauss rule on [−½, ½]; the weights have the sum 1.
struct PathGaussRule {
  int count;
  std::array<double, 5> points, weights;
};
/// Gauss rules with the numbers of points that occur in path_rule_table.
[[nodiscard]] const std::array<PathGaussRule, 3>& path_gauss_rules();
[[nodiscard]] inline const PathGaussRule& gauss_rule_of(PathRule rule) {
  return *std::ranges::find(path_gauss_rules(), properties_of(rule).points, &PathGaussRule::count);
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
