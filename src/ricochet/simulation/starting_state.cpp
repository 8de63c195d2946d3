#include "ricochet/simulation/starting_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/solver/step_solver.hpp"

namespace ricochet {

namespace {

/// L(0) − K U − C V.
Vector residual_force(const SemidiscreteProblem& problem, const Vector& displacement, const Vector& velocity) {
  Vector load, internal;
  problem.loads.total(0.0, load);
  problem.internal_force->evaluate(displacement, internal);
  load -= internal;
  if (problem.has_damping() && velocity.size() > 0) load -= problem.damping * velocity;
  return load;
}

/// A stage in which every contact point is eligible by its gap at the given displacement.
Stage contact_stage(const SemidiscreteProblem& problem, const Vector& displacement, Vector right_hand_side) {
  Stage stage;
  stage.right_hand_side = std::move(right_hand_side);
  stage.prescribed.setZero(problem.supports.size());
  problem.gaps(displacement, stage.gap_offset);
  stage.gap_offset_rounding = problem.contact.gap_rounding;
  stage.eligible.assign(static_cast<std::size_t>(problem.contact.size()), 1);
  return stage;
}

void take_supports(const SemidiscreteProblem& problem, double step, State& state, Vector& support_acceleration) {
  Vector values, velocities;
  problem.supports.values(0.0, values);
  problem.supports.derivatives(0.0, step, velocities, support_acceleration);
  double largest_change = 0.0;
  double largest_velocity_change = 0.0;
  for (Index i = 0; i < problem.supports.size(); ++i) {
    const Index dof = problem.supports.dofs()[static_cast<std::size_t>(i)];
    largest_change = std::max(largest_change, std::abs(values[i] - state.displacement[dof]));
    largest_velocity_change = std::max(largest_velocity_change, std::abs(velocities[i] - state.velocity[dof]));
    state.displacement[dof] = values[i];
    state.velocity[dof] = velocities[i];
  }
  if (largest_change > 0.0 || largest_velocity_change > 0.0) {
    log::info(
        fmt::format("initial conditions on supported boundaries follow the supports: displacement changed by up to "
                    "{:.3g}, velocity by up to {:.3g}",
                    largest_change, largest_velocity_change));
  }
}

/// Massless contact nodes are in equilibrium with their surroundings at every instant, the first included.
void relax_contact_nodes(const SemidiscreteProblem& problem, State& state) {
  const auto solver = make_direct_step_solver(problem, {{0.0, 1.0, 0.0, StageDofs::contact}});
  const Stage stage =
      contact_stage(problem, state.displacement, residual_force(problem, state.displacement, state.velocity));
  StageSolution solution;
  solver->solve(0, stage, solution);
  state.displacement += solution.increment;
  state.forces.normal_reaction = solution.normal_reaction;
  const double change = solution.increment.size() > 0 ? solution.increment.lpNorm<Eigen::Infinity>() : 0.0;
  if (change > 0.0) {
    log::info(fmt::format(
        "contact nodes have no inertia: their initial displacement was moved by up to {:.3g} to equilibrium", change));
  }
}

/// Points that rest on their obstacle at t = 0: no gap, no normal velocity.
std::vector<char> resting_points(const SemidiscreteProblem& problem, const State& state) {
  Vector gap;
  problem.gaps(state.displacement, gap);
  const Vector rate = problem.contact.gap_operator * state.velocity;
  std::vector<char> resting(static_cast<std::size_t>(problem.contact.size()), 0);
  for (Index i = 0; i < problem.contact.size(); ++i) {
    const Index first = problem.contact.nodes[static_cast<std::size_t>(i)] * problem.dimension;
    const double rate_rounding =
        8.0 * std::numeric_limits<double>::epsilon() * state.velocity.segment(first, problem.dimension).lpNorm<1>();
    if (problem.is_massless[static_cast<std::size_t>(first)] != 0) continue;
    resting[static_cast<std::size_t>(i)] =
        gap[i] <= problem.contact.gap_rounding[i] && std::abs(rate[i]) <= rate_rounding ? 1 : 0;
  }
  return resting;
}

void find_acceleration(const SemidiscreteProblem& problem, const Vector& support_acceleration, State& state) {
  const auto solver = make_direct_step_solver(problem, {{1.0, 0.0, 0.0, StageDofs::massive}});
  Stage stage = contact_stage(problem, state.displacement, residual_force(problem, state.displacement, state.velocity));
  stage.prescribed = support_acceleration;
  stage.eligible = resting_points(problem, state);
  stage.gap_offset.setZero();  // the condition is on G a
  stage.gap_offset_rounding.setZero();
  StageSolution solution;
  solver->solve(0, stage, solution);
  state.acceleration = solution.increment;
  for (const Index dof : problem.massless_dofs) state.acceleration[dof] = 0.0;
  state.forces.normal_reaction += solution.normal_reaction;
}

/// Support reactions from the momentum equation itself: R = M a + C V + K U − L − Gᵀ r.
void find_support_reaction(const SemidiscreteProblem& problem, State& state) {
  Vector force = -residual_force(problem, state.displacement, state.velocity);
  force += problem.mass * state.acceleration;
  problem.add_contact_force(-state.forces.normal_reaction, Vector(), force);
  state.forces.support_reaction.resize(problem.supports.size());
  for (Index i = 0; i < problem.supports.size(); ++i) {
    state.forces.support_reaction[i] = force[problem.supports.dofs()[static_cast<std::size_t>(i)]];
  }
}

}  // namespace

Vector static_equilibrium(const SemidiscreteProblem& problem, const Vector& guess) {
  const SparseMatrix& stiffness = problem.internal_force->tangent();
  // Far below the lowest elastic frequency squared, far above rounding: ε only sets how fast the iteration converges.
  const double epsilon = 1e-8 * stiffness.diagonal().maxCoeff() / problem.mass.diagonal().maxCoeff();
  const auto solver = make_direct_step_solver(problem, {{epsilon, 1.0, 0.0, StageDofs::all}});
  Vector displacement = guess;
  Vector supported, reference;
  problem.supports.values(0.0, supported);
  StageSolution solution;
  Vector left_over;
  constexpr int limit = 300;
  for (int iteration = 0; iteration < limit; ++iteration) {
    Stage stage = contact_stage(problem, displacement, residual_force(problem, displacement, Vector()));
    for (Index i = 0; i < problem.supports.size(); ++i) {
      stage.prescribed[i] = supported[i] - displacement[problem.supports.dofs()[static_cast<std::size_t>(i)]];
    }
    solver->solve(0, stage, solution);
    displacement += solution.increment;
    left_over = epsilon * (problem.mass * solution.increment);
    problem.loads.total(0.0, reference);
    const double force =
        std::max({reference.lpNorm<Eigen::Infinity>(),
                  solution.normal_reaction.size() > 0 ? solution.normal_reaction.lpNorm<Eigen::Infinity>() : 0.0,
                  solution.support_reaction.size() > 0 ? solution.support_reaction.lpNorm<Eigen::Infinity>() : 0.0});
    if (left_over.lpNorm<Eigen::Infinity>() <= 1e-13 * force || (force == 0.0 && solution.increment.isZero(0.0)))
      return displacement;
  }
  Vector resultant = Vector::Zero(problem.dimension);
  for (Index node = 0; node < problem.nodes.cols(); ++node)
    resultant += left_over.segment(node * problem.dimension, problem.dimension);
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("initial.displacement = \"static\": there is no equilibrium under the loads at t = 0: after {} "
                  "iterations a resultant force of ({:.3g}, {:.3g}{}) still moves the body; add a [[support]] in the "
                  "direction in which it is free, or give the displacement by expressions",
                  limit, resultant[0], resultant[1],
                  resultant.size() == 3 ? fmt::format(", {:.3g}", resultant[2]) : ""));
}

State make_starting_state(const SemidiscreteProblem& problem, const InitialConditions& initial, double step) {
  State state;
  state.displacement = initial.static_equilibrium ? static_equilibrium(problem, Vector::Zero(problem.dof_count()))
                                                  : initial.displacement;
  state.velocity = initial.velocity;
  state.acceleration.setZero(problem.dof_count());
  state.forces.normal_reaction.setZero(problem.contact.size());
  Vector support_acceleration;
  take_supports(problem, step, state, support_acceleration);
  if (problem.has_singular_mass()) relax_contact_nodes(problem, state);
  find_acceleration(problem, support_acceleration, state);
  find_support_reaction(problem, state);
  if (problem.loads.varies()) problem.loads.varying(0.0, state.forces.varying_load);
  if (problem.has_damping()) state.forces.damping_force = problem.damping * state.velocity;
  return state;
}

}  // namespace ricochet
