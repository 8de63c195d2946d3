#include <algorithm>

#include "ricochet/base/log.hpp"
#include "ricochet/scheme/response/forced_midpoint.hpp"
#include "ricochet/scheme/response/penalty_law.hpp"

namespace ricochet {

namespace {

/// Midpoint scheme with a penalty whose force is a discrete gradient of its energy (P. Hauret, P. Le Tallec, Comput.
/// Methods Appl. Mech. Engrg. 195 (2006) 4890–4916; the same force: F. Armero, E. Petőcz, 158 (1998) 269–300):
///   r_i = −(ψ_i(g₁)−ψ_i(g₀))/(g₁−g₀),   ψ_i(g) = ½ k_i min(g, 0)²,   f = 0.
/// J + Σψ_i(g_i) is conserved to rounding if gaps are linear and obstacles rest. Points penetrate by r/k; with a large
/// k contact forces oscillate. k_i is `penalty` times the stiffness n·Kn of the body at the point. No friction: the
/// source has none.
///
/// r decreases with g₁, so each step has one solution: Newton's method on g₁ = q + W r, W = G A⁻¹Gᵀ, for the points
/// that penetrate before or after.
class PenaltyMidpoint final : public ForcedMidpoint {
 public:
  PenaltyMidpoint(double step, double penalty) : ForcedMidpoint(step, "penalty-midpoint"), penalty_(penalty) {}

  void analyse(const SemidiscreteProblem& problem) override {
    ForcedMidpoint::analyse(problem);
    stiffness_ = penalty_ * point_stiffness(problem);
  }

  void start(const SemidiscreteProblem&, State& state, StageSolve&) override {
    if (!(state.forces.normal_reaction.sum() > 0.0)) return;
    log::warning(
        "scheme \"penalty-midpoint\": contact in the static equilibrium has no penetration, without which this scheme "
        "has no contact force: the body falls until it penetrates, and vibrates; start it slightly above the obstacle "
        "with damping, or use scheme \"reduced-kane\", with which it stays at rest");
  }

 protected:
  void step_changed(const SemidiscreteProblem&) override { response_.forget(); }

  /// Solves for the points that penetrate before or after, and for more of them if forces push others inside.
  bool find_forces(const SemidiscreteProblem& problem, const ContactRows& rows, const Unforced& unforced,
                   StageSolve& stages, Vector& normal) override {
    points_.clear();
    gap_ = unforced.gap;
    while (true) {
      const std::size_t before = points_.size();
      for (Index i = 0; i < gap_.size(); ++i) {
        const bool is_there = std::binary_search(points_.begin(), points_.begin() + static_cast<long>(before), i);
        if ((unforced.gap_before[i] < 0.0 || gap_[i] < 0.0) && !is_there) points_.push_back(i);
      }
      if (points_.size() == before) return before > 0;
      std::sort(points_.begin(), points_.end());
      const Matrix& w = response_.among(problem, rows, points_, stages);
      normal(points_) = penalty_forces(w, {stiffness_(points_), unforced.gap_before(points_), unforced.gap(points_)});
      gap_ = unforced.gap;
      for (const Index i : points_) gap_ += normal[i] * response_.column(problem, rows, i, stages);
    }
  }

  /// Contact energy Σψ.
  [[nodiscard]] double contact_energy(const Vector&, const Vector& gap) const override {
    return penalty_energy(stiffness_, gap);
  }

 private:
  double penalty_;
  ContactResponse response_{0};
  Vector stiffness_;           ///< k, per contact point
  Vector gap_;                 ///< g₁
  std::vector<Index> points_;  ///< that may press, ascending
};

}  // namespace

SchemeRegistration penalty_midpoint_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    return std::make_unique<PenaltyMidpoint>(step, parameters.number("penalty"));
  };
  return {"penalty-midpoint",
          make,
          {number_key("penalty", "1", {.default_value = "10", .range = {.above = 0.0, .at_most = 1e6}},
                      "Stiffness of the contact, in units of the body's own stiffness at a contact point.")}};
}

}  // namespace ricochet
