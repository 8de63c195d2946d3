#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/scheme/kane.hpp"
#include "ricochet/scheme/response/contact_response.hpp"
#include "ricochet/scheme/response/penalty_law.hpp"

namespace ricochet {

namespace {

/// The midpoint scheme with a penalty whose force is a discrete gradient of its energy (P. Hauret, P. Le Tallec,
/// Comput. Methods Appl. Mech. Engrg. 195 (2006) 4890–4916; the same force: F. Armero, E. Petőcz, 158 (1998) 269–300):
///   M (V₁−V₀)/h + C ΔU/h + K (U₀+U₁)/2 = L_½ + Gᵀ r,   ΔU = h (V₀+V₁)/2,   r_i = −(ψ_i(g₁)−ψ_i(g₀))/(g₁−g₀),
///   ψ_i(g) = ½ k_i min(g, 0)².
/// J + Σψ_i(g_i) is kept to rounding where gaps are linear and obstacles rest. Points penetrate by r/k; a large k makes
/// forces rattle. k_i is `penalty` times the stiffness n·Kn of the body at the point. No friction: the source has none.
///
/// r decreases with g₁, so each step has one solution: Newton's method on g₁ = q + W r, W = G A⁻¹Gᵀ, for the points
/// that are or come inside.
class PenaltyMidpoint final : public Kane {
 public:
  PenaltyMidpoint(double step, double penalty) : Kane(step, "penalty-midpoint"), penalty_(penalty) {}

  [[nodiscard]] double force_instant() const override { return -0.5; }
  /// Σψ.
  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const override {
    problem.gaps(state.displacement, state.time, looked_at_);
    return penalty_energy(stiffness_, looked_at_);
  }
  /// What the forces take from the body the penalty stores.
  [[nodiscard]] StepCorrections step_corrections(const SemidiscreteProblem&) const override {
    return {.contact_work = stored_};
  }

  void analyse(const SemidiscreteProblem& problem) override {
    Kane::analyse(problem);
    stiffness_ = penalty_ * point_stiffness(problem);
    if (!problem.contact.has_friction() && !problem.contact.follows_motion()) return;
    throw Error(ErrorKind::invalid_input,
                "scheme \"penalty-midpoint\" takes neither friction nor curved obstacles; take friction out, or use "
                "scheme \"reduced-kane\"");
  }

  void start(const SemidiscreteProblem&, State& state, StageSolve&) override {
    if (!(state.forces.normal_reaction.sum() > 0.0)) return;
    log::warning(
        "scheme \"penalty-midpoint\": contact that presses in the static equilibrium has no penetration, without which "
        "there is no force here: the body falls until it has, and vibrates; start it slightly above the obstacle "
        "with damping, or use scheme \"reduced-kane\", which rests");
  }

  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override {
    const double end = state.time + step();
    problem.gaps(state.displacement, state.time, before_);
    normal_.setZero(before_.size());
    Stage& stage = balance(problem, state, stages);
    if (problem.has_moving_obstacles()) equations().observe_obstacles(problem, state.time + 0.5 * step(), base());
    // Without forces, then with them.
    const StageSolution* solution = &solve_with_forces(problem, normal_, 0, stages);
    place_ = base() + solution->increment;
    problem.gaps(place_, end, free_);
    find_forces(problem, *stage.rows, stages);
    if (!points_.empty()) {
      balance(problem, state, stages);
      solution = &solve_with_forces(problem, normal_, 0, stages);
    }
    solution_.increment = solution->increment;
    solution_.support_reaction = solution->support_reaction;
    solution_.normal_reaction = normal_;
    solution_.contact_status.assign(static_cast<std::size_t>(normal_.size()), ContactStatus::open);
    for (const Index i : points_) {
      if (normal_[i] > 0.0) solution_.contact_status[static_cast<std::size_t>(i)] = ContactStatus::slip;
    }
    take(problem, stage, solution_, state, increment);
    problem.gaps(state.displacement, end, gap_);
    stored_ = penalty_energy(stiffness_, gap_) - penalty_energy(stiffness_, before_);
  }

 protected:
  void step_changed(const SemidiscreteProblem&) override { response_.forget(); }

 private:
  /// On the points that are or come inside: more of them where forces bring others there.
  void find_forces(const SemidiscreteProblem& problem, const ContactRows& rows, StageSolve& stages) {
    points_.clear();
    gap_ = free_;
    while (true) {
      const std::size_t before = points_.size();
      for (Index i = 0; i < gap_.size(); ++i) {
        const bool is_there = std::binary_search(points_.begin(), points_.begin() + static_cast<long>(before), i);
        if ((before_[i] < 0.0 || gap_[i] < 0.0) && !is_there) points_.push_back(i);
      }
      if (points_.size() == before) return;
      std::sort(points_.begin(), points_.end());
      const Matrix& w = response_.among(problem, rows, points_, stages);
      normal_(points_) = penalty_forces(w, {stiffness_(points_), before_(points_), free_(points_)});
      gap_ = free_;
      for (const Index i : points_) gap_ += normal_[i] * response_.column(problem, rows, i, stages);
    }
  }

  double penalty_, stored_ = 0.0;
  ContactResponse response_{0};
  Vector stiffness_;            ///< k, per contact point
  Vector before_, free_, gap_;  ///< g₀, g₁ without forces, g₁
  Vector normal_, place_;       ///< r, U₁
  std::vector<Index> points_;   ///< that may press, ascending
  StageSolution solution_;
  mutable Vector looked_at_;  ///< work space
};

}  // namespace

SchemeRegistration penalty_midpoint_scheme() {
  const auto make = [](double step, const Parameters& parameters) {
    return std::make_unique<PenaltyMidpoint>(step, parameters.number("penalty"));
  };
  return {"penalty-midpoint",
          make,
          {{.name = "penalty",
            .type = KeyType::number,
            .unit = "1",
            .standard = "10",
            .range = {.above = 0.0, .at_most = 1e6},
            .doc = "Stiffness of the contact, in units of the body's own stiffness at a contact point."}}};
}

}  // namespace ricochet
