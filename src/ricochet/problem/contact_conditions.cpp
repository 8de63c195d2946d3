#include "ricochet/problem/contact_conditions.hpp"

#include <limits>

namespace ricochet {

void require_no_penetration(const SemidiscreteProblem& problem, const Vector& base, double time, Stage& stage) {
  problem.gaps(base, time, stage.gap_offset);
  stage.gap_offset_rounding = problem.contact.gap_rounding;
  stage.gap_factor = 1.0;
  stage.eligible.assign(static_cast<std::size_t>(problem.contact.size()), 1);
}

void require_no_approach(const SemidiscreteProblem& problem, const Vector& displacement, double time,
                         const Vector& velocity, const ObstacleMotion& obstacle, double step, Stage& stage) {
  problem.gaps(displacement, time, stage.gap_offset);
  stage.eligible.resize(static_cast<std::size_t>(problem.contact.size()));
  for (Index i = 0; i < problem.contact.size(); ++i) {
    const bool touches = stage.gap_offset[i] <= problem.contact.gap_rounding[i];
    stage.eligible[static_cast<std::size_t>(i)] = touches ? 1 : 0;
  }
  problem.trace_rounding(displacement, stage.gap_offset);
  problem.trace_rounding(velocity, stage.gap_offset_rounding);
  stage.gap_offset_rounding += stage.gap_offset / step;
  stage.gap_offset.noalias() = problem.contact.gap_operator * velocity;
  if (obstacle.normal.size() > 0) stage.gap_offset -= obstacle.normal;
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

}  // namespace ricochet
