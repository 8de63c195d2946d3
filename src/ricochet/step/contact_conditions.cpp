#include "ricochet/step/contact_conditions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace ricochet {

namespace {

/// Rows of the stage that may be overwritten because no one else refers to them. A completed step keeps the rows with
/// which it was solved, so there are as many as there are steps and stages in use, and only the first ones allocate.
ContactRows& writable_rows(const SemidiscreteProblem& problem, Stage& stage) {
  for (std::shared_ptr<ContactRows>& rows : stage.row_storage) {
    if (rows.use_count() > 1 && stage.rows != rows) continue;
    if (rows.use_count() > 2) continue;
    if (stage.rows != rows) {
      *rows = *stage.rows;
      stage.rows = rows;
    }
    return *rows;
  }
  stage.row_storage.push_back(
      std::make_shared<ContactRows>(stage.rows != nullptr ? *stage.rows : *problem.contact.rows));
  stage.rows = stage.row_storage.back();
  return *stage.row_storage.back();
}

/// Updates the rows to a displacement and a time, or to the step that ends there.
void update_rows(const SemidiscreteProblem& problem, const Vector& displacement, double time, const StepStart* start,
                 Stage& stage) {
  if (!problem.contact.follows_motion()) {
    if (stage.rows != problem.contact.rows) stage.rows = problem.contact.rows;
    return;
  }
  problem.contact.geometry->update(displacement, time, start, writable_rows(problem, stage));
}

/// Makes every point eligible except those whose condition another point enforces.
void set_eligible(const SemidiscreteProblem& problem, Stage& stage) {
  stage.conditions.eligible.assign(std::size_t(problem.contact.size()), 1);
  if (problem.contact.follows_motion()) problem.contact.geometry->deactivate_points(stage.conditions.eligible);
}

/// Computes the gaps at the end of a step, or at an instant.
void compute_gaps(const SemidiscreteProblem& problem, const Vector& displacement, double time, bool of_step,
                  Vector& gap) {
  problem.gaps(displacement, time, gap);
  if (of_step && problem.contact.follows_motion()) problem.contact.geometry->allow_overlap(gap);
}

/// Computes the slip rate at δ = 0 and its rounding error.
void compute_slip_offset(const SemidiscreteProblem& problem, const Vector& velocity, const Vector& obstacle,
                         Stage& stage) {
  stage.rows->tangential_motion(velocity, stage.conditions.slip.offset);
  problem.trace_rounding(velocity, stage.conditions.slip.rounding);
  if (obstacle.size() == 0) return;
  stage.conditions.slip.offset -= obstacle;
  const int tangents = problem.dimension - 1;
  for (Index i = 0; i < problem.contact.size(); ++i) {
    stage.conditions.slip.rounding[i] +=
        8.0 * std::numeric_limits<double>::epsilon() * obstacle.segment(i * tangents, tangents).lpNorm<1>();
  }
}

/// Relative tolerance below which obstacle velocities count as equal. The remaining error of the iterations for the
/// position is at rounding level if the stage is solved exactly, but not if it is solved iteratively.
constexpr double same_velocity = 1e-10;

/// Computes the obstacle velocities at the contact points displaced by an increment.
void obstacle_velocity_at(const SemidiscreteProblem& problem, const Vector& increment, ContactMotion& motion,
                          ObstacleMotion& velocity) {
  motion.work.displacement = motion.obstacle_displacement + motion.obstacle_instant.factor * increment;
  problem.obstacle_velocity(motion.work.displacement, motion.obstacle_instant.time, motion.obstacle_instant.span,
                            velocity);
}

/// Largest difference, as a motion over the step, between the obstacle velocities at the solution and those used in its
/// conditions, at points that carry a force. Negative if they agree.
double obstacle_error(const SemidiscreteProblem& problem, const StageSolution& solution, const Vector& increment,
                      const Stage& stage, ContactMotion& motion) {
  obstacle_velocity_at(problem, increment, motion, motion.work.obstacle);
  project_motion(*stage.rows, motion.work.obstacle);
  const bool has_friction = stage.conditions.slip.offset.size() > 0;
  const double duration =
      has_friction ? stage.conditions.gap.factor / stage.conditions.slip.factor : motion.obstacle_instant.span;
  const Index tangents = problem.dimension - 1;
  double error = -std::numeric_limits<double>::infinity();
  for (Index i = 0; i < problem.contact.size(); ++i) {
    if (!(solution.normal_reaction[i] > 0.0)) continue;
    const auto along = motion.work.obstacle.tangential.segment(i * tangents, tangents);
    const double speed = std::hypot(motion.work.obstacle.normal[i], along.norm());
    const double wrong = std::hypot(motion.work.obstacle.normal[i] - stage.obstacle.normal[i],
                                    (along - stage.obstacle.tangential.segment(i * tangents, tangents)).norm());
    const double rounding = has_friction ? stage.conditions.slip.rounding[i] : 0.0;
    error = std::max(error, duration * (wrong - same_velocity * speed - rounding));
  }
  return error;
}

/// Stores the data from which the conditions are re-evaluated.
void store_motion(const Vector& base, double time, const StepStart* start, Stage& stage) {
  if (!stage.motion) stage.motion.emplace();
  ContactMotion& motion = *stage.motion;
  motion.displacement = base;
  motion.time = time;
  motion.reevaluates_obstacles = false;
  if (start == nullptr) {
    motion.start.resize(0);
    return;
  }
  motion.start = start->displacement;
  motion.start_time = start->time;
}

}  // namespace

void evaluate_obstacle_velocity(const SemidiscreteProblem& problem, const Vector& displacement,
                                const ObstacleInstant& instant, Stage& stage) {
  problem.obstacle_velocity(displacement, instant.time, instant.span, stage.obstacle);
  stage.has_obstacle_velocity = true;
  if (!stage.motion || !problem.has_rotating_obstacles()) return;
  stage.motion->reevaluates_obstacles = true;
  stage.motion->obstacle_displacement = displacement;
  stage.motion->obstacle_instant = instant;
}

void require_no_penetration(const SemidiscreteProblem& problem, const Vector& base, double time, Stage& stage,
                            const StepStart* start) {
  update_rows(problem, base, time, start, stage);
  compute_gaps(problem, base, time, start != nullptr, stage.conditions.gap.offset);
  stage.conditions.gap.rounding = stage.rows->gap_rounding;
  stage.conditions.gap.factor = 1.0;
  set_eligible(problem, stage);
  if (problem.contact.follows_motion() || problem.has_rotating_obstacles()) store_motion(base, time, start, stage);
}

void prepare_no_penetration(const SemidiscreteProblem& problem, const Vector& base, double time, Stage& stage,
                            const StepStart* start) {
  problem.contact.geometry->prepare_update(base, time, start, writable_rows(problem, stage));
  store_motion(base, time, start, stage);
}

void require_no_approach(const SemidiscreteProblem& problem, const Vector& displacement, double time,
                         const Vector& velocity, double gap_factor, ObstacleMotion& obstacle, double step,
                         Stage& stage) {
  update_rows(problem, displacement, time, nullptr, stage);
  stage.motion.reset();
  stage.conditions.gap.factor = gap_factor;
  problem.gaps(displacement, time, stage.conditions.gap.offset);
  // A displacement is the sum of its increments, and this condition on velocities corrects none of their rounding
  // errors: a point that slides or rests drifts by one unit of rounding per step.
  problem.trace_rounding(displacement, stage.conditions.gap.rounding);
  set_eligible(problem, stage);
  for (Index i = 0; i < problem.contact.size(); ++i) {
    const bool touches =
        stage.conditions.gap.offset[i] <= stage.rows->gap_rounding[i] + stage.conditions.gap.rounding[i];
    if (!touches) stage.conditions.eligible[std::size_t(i)] = 0;
  }
  problem.trace_rounding(velocity, stage.conditions.gap.offset);
  stage.conditions.gap.rounding = stage.conditions.gap.rounding / step + stage.conditions.gap.offset;
  stage.rows->normal_motion(velocity, stage.conditions.gap.offset);
  if (obstacle.normal.size() == 0) return;
  project_motion(*stage.rows, obstacle);
  stage.conditions.gap.offset -= obstacle.normal;
}

void require_friction(const SemidiscreteProblem& problem, const Vector& velocity, double slip_factor, Stage& stage) {
  if (!problem.contact.has_friction()) return;
  if (!std::exchange(stage.has_obstacle_velocity, false) && problem.has_moving_obstacles())
    throw std::logic_error("evaluate_obstacle_velocity() has not been called before require_friction()");
  stage.conditions.slip.factor = slip_factor;
  project_motion(*stage.rows, stage.obstacle);
  compute_slip_offset(problem, velocity, stage.obstacle.tangential, stage);
  if (stage.motion) stage.motion->velocity = velocity;
}

void linearize_contact(const SemidiscreteProblem& problem, const Vector& increment, Stage& stage) {
  ContactMotion& motion = *stage.motion;
  motion.work.displacement = motion.displacement + stage.conditions.gap.factor * increment;
  const StepStart start{motion.start, motion.start_time};
  update_rows(problem, motion.work.displacement, motion.time, motion.start.size() > 0 ? &start : nullptr, stage);
  set_eligible(problem, stage);
  compute_gaps(problem, motion.work.displacement, motion.time, motion.start.size() > 0, stage.conditions.gap.offset);
  stage.rows->normal_motion(increment, motion.work.gap_change);
  stage.conditions.gap.offset -= stage.conditions.gap.factor * motion.work.gap_change;
  if (motion.reevaluates_obstacles) obstacle_velocity_at(problem, increment, motion, stage.obstacle);
  project_motion(*stage.rows, stage.obstacle);
  if (stage.conditions.slip.offset.size() == 0) return;
  compute_slip_offset(problem, motion.velocity, stage.obstacle.tangential, stage);
}

LinearizationError linearization_error(const SemidiscreteProblem& problem, const StageSolution& solution, Stage& stage,
                                       Vector& gap) {
  ContactMotion& motion = *stage.motion;
  const Vector& increment = solution.contact_motion();
  motion.work.displacement = motion.displacement + stage.conditions.gap.factor * increment;
  compute_gaps(problem, motion.work.displacement, motion.time, motion.start.size() > 0, gap);
  stage.rows->normal_motion(increment, motion.work.gap_change);
  problem.trace_rounding(increment, motion.work.gap_change_rounding);
  constexpr double none = -std::numeric_limits<double>::infinity();
  LinearizationError error{none, none};
  for (Index i = 0; i < gap.size(); ++i) {
    if (stage.conditions.eligible[std::size_t(i)] == 0) continue;
    // The residual of the linear condition is the solver's and is there for any rows; it is not a linearization error.
    const double beside =
        std::abs(gap[i] - (stage.conditions.gap.offset[i] + stage.conditions.gap.factor * motion.work.gap_change[i]));
    const double wrong = solution.normal_reaction[i] > 0.0 ? beside : std::min(-gap[i], beside);
    const double rounding = stage.conditions.gap.rounding[i];
    error.beyond_rounding = std::max(error.beyond_rounding, wrong - rounding);
    // Both gaps are rounded, and the contribution of the increment is subtracted and added again.
    error.beyond_all_rounding =
        std::max(error.beyond_all_rounding,
                 wrong - 2.0 * (rounding + stage.conditions.gap.factor * motion.work.gap_change_rounding[i]));
  }
  if (motion.reevaluates_obstacles) {
    const double obstacle = obstacle_error(problem, solution, increment, stage, motion);
    error.beyond_rounding = std::max(error.beyond_rounding, obstacle);
    error.beyond_all_rounding = std::max(error.beyond_all_rounding, obstacle);
  }
  error.beyond_rounding = problem.ranks->maximum(error.beyond_rounding);
  error.beyond_all_rounding = problem.ranks->maximum(error.beyond_all_rounding);
  return error;
}

}  // namespace ricochet
