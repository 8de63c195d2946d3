#include "ricochet/base/error.hpp"
#include "ricochet/scheme/reduced/finite_strain_step.hpp"

/// @file Treatment of iterations of a step that make no progress.
namespace ricochet {

/// Freezes pairs from now on, until the step is done. Returns false if there is nothing to freeze, or it is frozen
/// already.
bool FiniteStrainStep::freeze_pairs(const SemidiscreteProblem& problem) {
  if (!problem.contact.follows_motion() || !problem.contact.geometry->freeze()) return false;
  progress_.restart();
  acceleration_.restart();
  return true;
}

void FiniteStrainStep::apply_advice(const SemidiscreteProblem& problem, NewtonProgress::Advice advice,
                                    const Iteration& iteration, FailureMode mode, StageSolve& stages) {
  const int done = progress_.iterations();
  const bool is_slow = done >= thresholds_.early_iterations &&
                       progress_.expected_iterations(iteration.increment) > thresholds_.early_iterations;
  if (mode == FailureMode::early && (is_slow || done >= thresholds_.max_early_iterations))
    throw progress_.failure(iteration.correction);
  // Pairs may change from iteration to iteration.
  const bool is_stuck =
      advice == NewtonProgress::Advice::failed ||
      (advice == NewtonProgress::Advice::renew && progress_.iterations() > thresholds_.max_pair_iterations);
  if (is_stuck && mode == FailureMode::late && freeze_pairs(problem)) return;
  if (advice == NewtonProgress::Advice::failed) throw progress_.failure(iteration.correction);
  if (advice != NewtonProgress::Advice::renew) return;
  stages.renew_operators(middle_, end_);
  progress_.count_renewal();
  progress_.restart();
  acceleration_.restart();
}

/// Throws Error(not_converged), which names a cell inverted by the displacements of this iteration, if any: operators
/// are meaningless there, and the error of a stage does not show the cause.
void FiniteStrainStep::throw_if_inverted(const SemidiscreteProblem& problem) {
  problem.internal_force->evaluate(end_, scratch_);
  problem.internal_force->evaluate(middle_, scratch_);
}

/// Raises the rules of path_force() once near the solution and once at it. Returns whether the force has changed.
bool FiniteStrainStep::raise_rules(const SemidiscreteProblem& problem, bool is_solution) {
  const int raises = is_solution ? 2 : 1;
  if (raises_ >= raises) return false;
  raises_ = raises;
  path_increment_ = 2.0 * (end_ - middle_);
  return problem.internal_force->raise_path_rules(middle_, path_increment_, path_rules_);
}

/// Evaluates the forces of the flight, or of a part of it that inverts no cell: velocities of quasi-static motion,
/// which alternate from step to step, may lead far away.
void FiniteStrainStep::evaluate_prediction(const SemidiscreteProblem& problem, double step, const State& state) {
  last_middle_ = last_end_ = state.displacement;
  (void)evaluate_with_halving(problem, step, state);
}

bool FiniteStrainStep::evaluate_with_halving(const SemidiscreteProblem& problem, double step, const State& state) {
  for (int halving = 0;; ++halving) {
    try {
      evaluate(problem, step, state);
      return halving > 0;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged || halving == max_halvings) throw;
    }
    middle_ = 0.5 * (middle_ + last_middle_);
    end_ = 0.5 * (end_ + last_end_);
  }
}

}  // namespace ricochet
