#include "ricochet/scheme/reduced/massless_contact_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

/// Relative error up to which C_c = ηK_c holds.
constexpr double same_damping = 1e-12;

void MasslessContactStep::analyse(const SemidiscreteProblem& problem) {
  const auto has_inertia = [&](Index dof) { return problem.is_massless[std::size_t(dof)] == 0; };
  if (std::ranges::any_of(problem.contact_dofs, has_inertia)) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("scheme \"{}\" needs a mass without inertia on the contact nodes, which it keeps in "
                            "equilibrium: set mass.type = \"equivalent\", or use scheme \"contact-stabilized\", which "
                            "creates no energy with this mass",
                            scheme_));
  }
  if (!problem.internal_force->is_linear()) return;
  stiffness_.analyse(problem);
  find_damping(problem);
}

void MasslessContactStep::change_step(const SemidiscreteProblem& problem, double step) {
  step_ = step;
  if (damps_ && !one_damping_) damped_rows_.analyse(problem, 1.0, 2.0 / step_);
}

void MasslessContactStep::require_frictionless_planes(const SemidiscreteProblem& problem) const {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorKind::invalid_input, fmt::format("scheme \"{}\" {}; use scheme \"reduced-kane\"", scheme_, what));
  };
  if (problem.contact.has_friction()) refuse("does not support friction: its energy balance then has no definite sign");
  if (problem.contact.follows_motion())
    refuse("supports only planes, and bodies at small strain: it needs gaps that are linear in the motion");
  if (damps_contact_nodes())
    refuse(
        "does not support stiffness damping at contact nodes, whose positions must be functions of those of the other "
        "nodes");
}

void MasslessContactStep::find_damping(const SemidiscreteProblem& problem) {
  damps_ = false;
  one_damping_ = true;
  eta_ = 0.0;
  if (!problem.has_damping()) return;
  ContactStiffness damping;
  damping.analyse(problem, 0.0, 1.0);
  // Ranks have parts of these; C_c = ηK_c holds for each part or not at all.
  const auto norm = [&](const SparseRowMatrix& rows) { return std::sqrt(problem.ranks->sum(rows.squaredNorm())); };
  const double size = norm(damping.rows());
  if (size == 0.0) return;
  damps_ = true;
  eta_ = size / norm(stiffness_.rows());
  const SparseRowMatrix difference = damping.rows() - eta_ * stiffness_.rows();
  one_damping_ = norm(difference) <= same_damping * size;
  if (one_damping_) return;
  damped_rows_.analyse(problem, 1.0, 2.0 / step_);
  log::info(fmt::format(
      "scheme \"{}\": the materials at contact nodes differ in damping.stiffness; in the equilibrium of these "
      "nodes, which have no inertia, the damping force therefore counts twice, so that fast vibrations of "
      "the surface are damped more than elsewhere (docs/energy.md, section Damping); with one value for the "
      "materials at the contact it counts once",
      scheme_));
}

std::vector<OperatorCoefficients> MasslessContactStep::operators(const SemidiscreteProblem& problem,
                                                                 ActingReaction acting) const {
  const double h = step_;
  OperatorCoefficients midpoint{.mass = 4.0 / (h * h), .stiffness = 1.0, .damping = 2.0 / h};
  if (!problem.has_contact_dofs()) return {midpoint};
  const OperatorCoefficients contact_operator{
      .mass = 0.0, .stiffness = 1.0, .damping = one_damping_ ? 1.0 / h : 2.0 / h, .dofs = StageDofs::contact};
  midpoint.condensed_operator = int(condensed_stage);
  midpoint.condensed_weight = one_damping_ ? 1.0 / (1.0 + 2.0 * eta_ / h) : 1.0;
  midpoint.acting = acting;
  return {contact_operator, midpoint};
}

void MasslessContactStep::balance(const SemidiscreteProblem& problem, const State& state, Stage& stage) {
  load_ = problem.loads.constant();
  load_change_.setZero(Index(problem.contact_dofs.size()));
  if (problem.loads.varies()) {
    problem.loads.varying(state.time, previous_varying_);
    problem.loads.varying(state.time + step_, mean_varying_);
    for (std::size_t i = 0; i < problem.contact_dofs.size(); ++i) {
      const Index dof = problem.contact_dofs[i];
      load_change_[Index(i)] = mean_varying_[dof] - previous_varying_[dof];
    }
    mean_varying_ = 0.5 * (previous_varying_ + mean_varying_);  // the mean, from now on
    load_ += mean_varying_;
  }
  base_ = state.displacement + (0.5 * step_) * state.velocity;
  equations_.balance_with(problem, load_, base_, state.velocity, stage);
  const auto half_way = [&](Index dof, double end) { return 0.5 * (state.displacement[dof] + end) - base_[dof]; };
  equations_.prescribe(problem, state.time + step_, half_way, stage);
}

/// Computes K u₀ as K base less K of the small difference: no digits are lost to a rigid motion.
void MasslessContactStep::find_residual(const SemidiscreteProblem& problem, const State& state) {
  stiffness_.multiply(state.velocity, residual_);
  residual_ *= 0.5 * step_;
  for (std::size_t i = 0; i < problem.contact_dofs.size(); ++i) {
    const auto at = Index(i);
    const Index dof = problem.contact_dofs[i];
    residual_[at] += load_[dof] - 0.5 * load_change_[at] - equations_.internal_force()[dof];
  }
}

void MasslessContactStep::set_contact_force(const SemidiscreteProblem& problem, const Vector& force, Stage& stage) {
  if (stage.right_hand_side.force.size() != problem.dof_count())
    stage.right_hand_side.force.setZero(problem.dof_count());
  for (std::size_t i = 0; i < problem.contact_dofs.size(); ++i)
    stage.right_hand_side.force[problem.contact_dofs[i]] = force[Index(i)];
  stage.right_hand_side.prescribed.setZero(problem.supports.size());
}

const Vector& MasslessContactStep::solve_contact_nodes(const SemidiscreteProblem& problem,
                                                       const Vector& right_hand_side, StageSolve& stages) {
  Stage& stage = stages.stage(condensed_stage);
  set_contact_force(problem, right_hand_side, stage);
  stage.motion.reset();
  stage.conditions.eligible.assign(std::size_t(problem.contact.size()), 0);
  return stages.solve(condensed_stage).increment;
}

void MasslessContactStep::advance(const SemidiscreteProblem& problem, ActingReaction acting, State& state,
                                  StageSolve& stages, Vector& increment) {
  const double h = step_;
  const bool has_contact_nodes = problem.has_contact_dofs();
  Stage& stage = stages.stage(midpoint_stage(problem));
  balance(problem, state, stage);
  contact_base_ = state.displacement + h * state.velocity;  // at the end, at δ = 0
  if (has_contact_nodes) {
    find_residual(problem, state);
    const double eta_part = one_damping_ ? eta_ / h : 0.0, weight = 1.0 / (1.0 + 2.0 * eta_part);
    contact_right_hand_side_ = residual_ - eta_part * load_change_;
    const Vector& shift = solve_contact_nodes(problem, contact_right_hand_side_, stages);
    for (const Index dof : problem.contact_dofs) contact_base_[dof] -= weight * shift[dof];
  }
  contact_.require(problem, acting, h, state, contact_base_, equations_, stage);

  const StageSolution& solution = solve(problem, state, stage, stages);
  increment = h * state.velocity + 2.0 * solution.increment;
  for (const Index dof : problem.contact_dofs)
    increment[dof] = contact_base_[dof] - state.displacement[dof] + 2.0 * solution.contact_increment[dof];
  start_displacement_ = state.displacement;
  move(problem, solution.increment, increment, state);
  store_forces(problem, stage, solution, increment, state);
  contact_.update_drift(problem, start_displacement_, state);
  if (has_contact_nodes) correct(problem, acting, stage, solution, increment, state, stages);
}

/// Repeats the solve while the gyroscopic force of rigid bodies changes: it depends on their rotation in the step.
const StageSolution& MasslessContactStep::solve(const SemidiscreteProblem& problem, const State& state, Stage& stage,
                                                StageSolve& stages) {
  const StageSolution* solution = &stages.solve(midpoint_stage(problem));
  if (problem.free_bodies.empty() || !problem.free_bodies.front()->has_gyroscopic_force()) return *solution;
  gyroscopic_force_.setZero(problem.dof_count());
  constexpr int max_iterations = 100;
  // Torques stop converging at the rounding of the stage; if their change is below this, they have settled.
  constexpr double near = 1e-11;
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0;; ++iteration) {
    predicted_end_ = state.displacement + step_ * state.velocity + 2.0 * solution->increment;
    next_gyroscopic_force_.setZero(problem.dof_count());
    for (const auto& body : problem.free_bodies)
      body->add_gyroscopic_force(predicted_end_, state.velocity, step_, next_gyroscopic_force_);
    const double size =
        stage.right_hand_side.force.lpNorm<Eigen::Infinity>() + next_gyroscopic_force_.lpNorm<Eigen::Infinity>();
    const double change = (next_gyroscopic_force_ - gyroscopic_force_).lpNorm<Eigen::Infinity>();
    if (change <= 4.0 * std::numeric_limits<double>::epsilon() * size) return *solution;
    if (change > 0.5 * last && change <= near * size) return *solution;
    last = change;
    if (iteration == max_iterations || !std::isfinite(change))
      throw Error(ErrorKind::not_converged,
                  "the rotation of a rigid body was not found: it rotates too far in one step");
    stage.right_hand_side.force += next_gyroscopic_force_ - gyroscopic_force_;
    gyroscopic_force_ = next_gyroscopic_force_;
    solution = &stages.solve(midpoint_stage(problem));
  }
}

void MasslessContactStep::move(const SemidiscreteProblem& problem, const Vector& solution, const Vector& increment,
                               State& state) const {
  state.displacement += increment;
  state.velocity += (4.0 / step_) * solution;               // 2 (u₁−u₀)/h − v₀
  state.acceleration = (4.0 / (step_ * step_)) * solution;  // (v₁−v₀)/h
  follow_without_inertia(problem, increment, step_, state);
}

void MasslessContactStep::store_forces(const SemidiscreteProblem& problem, const Stage& stage,
                                       const StageSolution& solution, const Vector& increment, State& state) {
  equations_.store_contact(stage, solution, step_, state);
  if (problem.loads.varies()) state.forces.varying_load = mean_varying_;
  if (!problem.has_damping()) return;
  problem.damping.evaluate(increment, state.forces.damping_force);
  state.forces.damping_force *= 1.0 / step_;
}

MasslessContactStep::ContactNodeWork MasslessContactStep::contact_node_work(const SemidiscreteProblem& problem,
                                                                            const ContactRows& rows,
                                                                            const StageSolution& solution,
                                                                            const Vector& increment,
                                                                            StageSolve& stages) {
  (one_damping_ ? stiffness_ : damped_rows_).multiply(increment, contact_stiffness_force_);
  const Vector& solved = solve_contact_nodes(problem, contact_stiffness_force_, stages);
  const double factor = one_damping_ ? 1.0 + eta_ / step_ : 1.0;
  static_increment_.resize(contact_stiffness_force_.size());
  excess_reaction_force_.setZero(problem.dof_count());
  normal_ = solution.acting_normal() - 0.5 * solution.normal_reaction;
  tangential_ = solution.acting_tangential() - 0.5 * solution.tangential_reaction;
  rows.add_force(normal_, tangential_, excess_reaction_force_);
  ContactNodeWork work{0.0, 0.0};
  for (std::size_t i = 0; i < problem.contact_dofs.size(); ++i) {
    const auto at = Index(i);
    static_increment_[at] = factor * solved[problem.contact_dofs[i]];
    work.reactions += static_increment_[at] * (excess_reaction_force_[problem.contact_dofs[i]] + 0.5 * residual_[at]);
    work.load += 0.5 * static_increment_[at] * load_change_[at];
  }
  return work;
}

/// Work of changing loads on contact nodes under a mean: ½ zᵀΔL for the part μ of the end reactions, and
/// −ΔLᵀK_cc⁻¹Hᵀ(ρ̄_path − ½(ρ₀+ρ)) for the rest. Uses the nodal forces a = Hᵀ(ρ̄ − ½ρ) + ½r₀ from contact_node_work.
double MasslessContactStep::load_work_of_mean(const SemidiscreteProblem& problem, double mu, double at_end,
                                              StageSolve& stages) {
  if (!problem.ranks->any(!load_change_.isZero(0.0))) return 0.0;
  const Vector& shift = solve_contact_nodes(problem, load_change_, stages);
  double of_reactions = 0.0, of_change = 0.0;
  for (std::size_t i = 0; i < problem.contact_dofs.size(); ++i) {
    const auto at = Index(i);
    const Index dof = problem.contact_dofs[i];
    of_reactions += shift[dof] * (excess_reaction_force_[dof] + 0.5 * residual_[at]);
    of_change += 0.5 * shift[dof] * load_change_[at];
  }
  return mu * at_end - of_reactions + mu * (at_end - of_change);
}

void MasslessContactStep::correct(const SemidiscreteProblem& problem, ActingReaction acting, const Stage& stage,
                                  const StageSolution& solution, const Vector& increment, const State& state,
                                  StageSolve& stages) {
  const ContactNodeWork work = contact_node_work(problem, *stage.rows, solution, increment, stages);
  if (acting == ActingReaction::end) {
    corrections_ = {.load_work = work.load,
                    .numerical_dissipation = 0.5 * static_increment_.dot(contact_stiffness_force_)};
    return;
  }
  const bool touches = problem.ranks->any(solution.mean_normal_reaction.size() > 0);
  const double mu = touches ? solution.end_weight : 0.0;
  corrections_ = {.load_work = load_work_of_mean(problem, mu, work.load, stages)};
  if (touches) {
    motion_from_obstacles(*stage.rows, increment, state.obstacle_increment, gap_change_);
    const double along = (1.0 - mu) * solution.path_contact_work - mu * solution.normal_reaction.dot(stage.start.gap);
    corrections_.contact_work = along - solution.mean_normal_reaction.dot(gap_change_);
    if (problem.contact.has_friction()) {
      slip_on_obstacles(*stage.rows, increment, state.obstacle_increment, slip_change_);
      corrections_.friction_work = (1.0 - mu) * solution.path_friction_work -
                                   mu * solution.tangential_reaction.dot(slip_change_) +
                                   solution.mean_tangential_reaction.dot(slip_change_);
    }
  }
  corrections_.numerical_dissipation =
      corrections_.contact_work + corrections_.friction_work + work.reactions + corrections_.load_work;
}

}  // namespace ricochet
