#include "ricochet/scheme/contact_conditions.hpp"

#include <limits>

namespace ricochet {

void require_no_penetration(const SemidiscreteProblem& problem, const Vector& base, double time, Stage& stage) {
  problem.gaps(base, time, stage.gap_offset);
  stage.gap_offset_rounding = problem.contact.gap_rounding;
  stage.gap_factor = 1.0;
  stage.eligible.assign(static_cast<std::size_t>(problem.contact.size()), 1);
}

void require_friction(const SemidiscreteProblem& problem, const Vector& velocity, const ObstacleMotion& obstacle,
                      double slip_factor, Stage& stage) {
  if (!problem.contact.has_friction()) return;
  stage.slip_factor = slip_factor;
  stage.slip_offset.noalias() = problem.contact.tangential_trace * velocity;
  problem.trace_rounding(velocity, stage.slip_offset_rounding);
  if (obstacle.tangential.size() == 0) return;
  stage.slip_offset -= obstacle.tangential;
  const int tangents = problem.dimension - 1;
  for (Index i = 0; i < problem.contact.size(); ++i) {
    stage.slip_offset_rounding[i] +=
        8.0 * std::numeric_limits<double>::epsilon() * obstacle.tangential.segment(i * tangents, tangents).lpNorm<1>();
  }
}

void take_contact(const StageSolution& solution, const ObstacleMotion& obstacle, double duration, State& state) {
  state.forces.normal_reaction = solution.normal_reaction;
  state.forces.tangential_reaction = solution.tangential_reaction;
  state.forces.support_reaction = solution.support_reaction;
  state.contact_status = solution.contact_status;
  if (obstacle.normal.size() == 0) return;
  state.obstacle_increment.normal = duration * obstacle.normal;
  state.obstacle_increment.tangential = duration * obstacle.tangential;
}

}  // namespace ricochet
