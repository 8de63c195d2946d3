#include "ricochet/simulation/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

/// Of the dofs that the stage solves for; a stage of contact nodes need not look at the whole body.
bool is_finite(const SemidiscreteProblem& problem, StageDofs dofs, const Vector& increment) {
  if (dofs != StageDofs::contact) return increment.allFinite();
  return std::all_of(problem.contact_dofs.begin(), problem.contact_dofs.end(),
                     [&](Index dof) { return std::isfinite(increment[dof]); });
}

}  // namespace

Simulation::Simulation(const SemidiscreteProblem& problem, Scheme& scheme, const InitialConditions& initial,
                       const StepSolverOptions& options)
    : problem_(problem), scheme_(scheme) {
  if (!scheme_.takes_nonlinear_force()) require_linear(*problem_.internal_force, "this time scheme");
  scheme_.analyse(problem_);
  state_ = make_starting_state(problem_, initial, scheme_.step(), options);
  scheme_.start(problem_, state_);
  make_solver(options);
  account_ = std::make_unique<EnergyAccount>(problem_, scheme_, state_);
}

Simulation::Simulation(const SemidiscreteProblem& problem, Scheme& scheme, const Snapshot& snapshot,
                       const StepSolverOptions& options)
    : problem_(problem), scheme_(scheme) {
  state_ = load_state(problem_, snapshot, "state");
  scheme_.analyse(problem_);
  // Whatever would be chosen for the steps that are left: another method has other bits.
  StepSolverOptions kept = options;
  kept.chosen = saved_methods(snapshot, "solver", scheme_.operators(problem_).size());
  make_solver(kept);
  solver_->load(snapshot, "solver");
  account_ = std::make_unique<EnergyAccount>(problem_, scheme_, state_, snapshot, "account");
}

void Simulation::save(Snapshot& snapshot) const {
  ricochet::save(state_, snapshot, "state");
  solver_->save(snapshot, "solver");
  account_->save(snapshot, "account");
}

void Simulation::make_solver(const StepSolverOptions& options) {
  const std::vector<OperatorCoefficients> operators = scheme_.operators(problem_);
  solver_ = make_step_solver(problem_, operators, options);
  stages_.resize(operators.size());
  for (std::size_t number = 0; number < operators.size(); ++number) {
    stages_[number].dofs = operators[number].dofs;
    stages_[number].stage.rows = problem_.contact.rows;
  }
}

Stage& Simulation::stage(std::size_t number) {
  return stages_.at(number).stage;
}

const StageSolution& Simulation::solve(std::size_t number) {
  auto& [stage, solution, dofs] = stages_.at(number);
  solver_->solve(number, stage, solution);
  if (problem_.ranks->any(!is_finite(problem_, dofs, solution.increment))) {
    throw Error(ErrorKind::not_converged,
                "the displacement is no longer finite, so the motion has grown beyond all bounds; use a stable scheme "
                "(reduced-kane with mass \"equivalent\")");
  }
  iterations_ += solution.iterations;
  return solution;
}

void Simulation::advance() {
  iterations_ = 0;
  // Rows that follow the motion go on from those of the state, whatever was solved in between.
  if (problem_.contact.follows_motion()) {
    for (SolvedStage& each : stages_) each.stage.rows = state_.forces.rows;
  }
  try {
    scheme_.advance(problem_, state_, *this, increment_);
  } catch (const Error& problem) {
    const std::string advice = problem.kind() == ErrorKind::not_converged
                                   ? "; try a smaller time.step, or a finer mesh where contact begins"
                                   : "";
    throw Error(problem.kind(), fmt::format("step {} (t = {:.9g}, step size {:.3g}, {} contact points): {}{}",
                                            state_.step + 1, state_.time + scheme_.step(), scheme_.step(),
                                            problem_.contact.size(), problem.what(), advice));
  }
  state_.iterations = iterations_;
  state_.step += 1;
  state_.time = static_cast<double>(state_.step) * scheme_.step();
  account_->enter_step(increment_, state_);
}

}  // namespace ricochet
