#pragma once

#include "ricochet/contact/contact_members.hpp"
#include "ricochet/step/stage.hpp"

/// @file The members of stages and their solutions, listed once as those of contact_members.hpp are. A new member needs
/// a place here; tests count them.
namespace ricochet {

template <class Visitor, PossiblyConst<ContactConditions> Conditions>
void persist(Visitor& visit, Conditions& conditions) {
  using enum ContactAxis;
  visit(ContactAxes{point}, conditions.eligible, conditions.gap.offset, conditions.gap.rounding,
        conditions.slip.rounding, conditions.frictionless);
  visit(ContactAxes{tangent}, conditions.slip.offset);
  visit(ContactAxes{}, conditions.gap.factor, conditions.slip.factor);
}

template <class Visitor, PossiblyConst<MeanStart> Start>
void persist(Visitor& visit, Start& start) {
  using enum ContactAxis;
  visit(ContactAxes{point}, start.gap, start.normal_reaction);
  visit(ContactAxes{tangent}, start.tangential_reaction);
}

template <class Visitor, PossiblyConst<Stage> AnyStage>
void persist(Visitor& visit, AnyStage& stage) {
  persist(visit, stage.conditions);
  persist(visit, stage.start);
  visit(ContactAxes{}, stage.rows, stage.right_hand_side, stage.linearization, stage.motion, stage.obstacle,
        stage.has_obstacle_velocity, stage.row_storage);
}

template <class Visitor, PossiblyConst<StageSolution> Solution>
void persist(Visitor& visit, Solution& solution) {
  using enum ContactAxis;
  visit(ContactAxes{point}, solution.normal_reaction, solution.mean_normal_reaction, solution.contact_status);
  visit(ContactAxes{tangent}, solution.tangential_reaction, solution.mean_tangential_reaction);
  visit(ContactAxes{}, solution.end_weight, solution.support_reaction, solution.increment, solution.iterations,
        solution.newton_iterations, solution.follower_load, solution.contact_increment, solution.path_contact_work,
        solution.path_friction_work);
}

}  // namespace ricochet
