#include "ricochet/scheme/reduced/finite_strain_exact.hpp"

#include "ricochet/scheme/reduced/massless_contact_step.hpp"

namespace ricochet {

void ExactTangentEquations::start(const State& state) {
  proximal_weight_ = 0.0;
  equations_.is_stiffened = false;
  solution_ = {};
  solution_.normal_reaction = state.forces.normal_reaction;
  solution_.tangential_reaction = state.forces.tangential_reaction;
}

NewtonEquations::Iteration ExactTangentEquations::iterate() {
  const StepTask& task = iterate_.task();
  const std::size_t number = MasslessContactStep::midpoint_stage(task.problem);
  Stage& stage = task.stages.stage(number);
  last_solution_ = solution_;
  iterate_.begin_correction();
  iterate_.balance_middle(stage);
  auto& [middle, end] = iterate_.now();
  if (task.problem.has_contact_dofs()) {
    no_motion_.setZero(end.size());
    iterate_.require_contact(end, no_motion_, stage);
    iterate_.find_end_residual(end_residual_);
  } else {
    stage.conditions.eligible.clear();
    stage.motion.reset();
  }
  const StepIterate at{task.problem,
                       iterate_.contact_cells(),
                       task.step,
                       task.state,
                       iterate_.path_rules(),
                       middle,
                       end,
                       iterate_.path_increment(),
                       stage.right_hand_side.force,
                       end_residual_,
                       stage};
  tangent_.assemble(at, solution_, proximal_weight_, equations_);
  task.stages.solve_exactly(number, equations_, solution_, unknowns_);
  tangent_.write_increments(unknowns_, correction_.middle, correction_.end);
  middle += correction_.middle;
  end += correction_.end;
  return iterate_.sizes();
}

void ExactTangentEquations::take_back() {
  iterate_.take_correction_back();
  solution_ = last_solution_;
  iterate_.evaluate();
}

}  // namespace ricochet
