#include "ricochet/scheme/semi_explicit/nonlinear_contact_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Key of State::memory; its first number is the step from which on the factor may be renewed.
constexpr const char* contact_renewal = "layer_renewal";
/// Iterations that count as many, and steps for which a new factor is kept: it costs as much as some tens of
/// evaluations of the internal force.
constexpr int renewal_iterations = 8;
constexpr double steps_between_renewals = 100.0;
/// Iterations before acceleration begins.
constexpr int plain_iterations = 2;

double largest_on_contact(const SemidiscreteProblem& problem, const Vector& values) {
  double largest = 0.0;
  for (const Index dof : problem.contact_dofs) {
    if (!std::isfinite(values[dof])) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::abs(values[dof]));
  }
  return largest;
}

}  // namespace

void NonlinearContactEquilibrium::analyse(const SemidiscreteProblem& problem) {
  contact_cells_ = problem.internal_force_at_contact();
  reach_ = problem.nodes.cwiseAbs().maxCoeff();
}

void NonlinearContactEquilibrium::start(State& state) const {
  if (contact_cells_) state.memory[contact_renewal].setZero(State::memory_numbers);
}

void NonlinearContactEquilibrium::renew_where_slow(const SemidiscreteProblem& problem, State& state,
                                                   StageSolve& stages) {
  if (!problem.has_contact_dofs() || progress_.iterations() <= renewal_iterations) return;
  double& from = state.memory.at(contact_renewal, State::memory_numbers)[0];
  if (double(state.step) < from) return;
  from = double(state.step) + steps_between_renewals;
  stages.renew_operators(state.displacement, state.displacement);
}

/// Moves contact nodes; `contact_increment` has the increments of contact dofs.
void NonlinearContactEquilibrium::move_to(const SemidiscreteProblem& problem, const State& state,
                                          const Vector& contact_increment, Vector& increment, Vector& end) {
  problem.scatter_contact(contact_increment, increment);
  for (const Index dof : problem.contact_dofs) end[dof] = state.displacement[dof] + increment[dof];
}

/// Evaluates f at the end. If the last change inverts a cell, half of it is taken, then half of that.
void NonlinearContactEquilibrium::evaluate(const SemidiscreteProblem& problem, const State& state, Vector& increment,
                                           Vector& end) {
  double part = 1.0;
  for (int halving = 0;; ++halving) {
    try {
      contact_cells_->evaluate(end, force_);
      return;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged || !moved_ || halving == max_halvings) throw;
    }
    part *= 0.5;
    point_ -= part * move_;
    move_to(problem, state, point_, increment, end);
  }
}

void NonlinearContactEquilibrium::require(const SemidiscreteProblem& problem, const State& state, const Vector& load,
                                          double step, const Vector& increment, const Vector& end, Stage& stage) {
  for (const Index dof : problem.contact_dofs) stage.right_hand_side.force[dof] = load[dof] - force_[dof];
  require_no_penetration(problem, end, state.time + step, stage);
  if (problem.has_moving_obstacles()) {
    middle_ = state.displacement + 0.5 * increment;
    evaluate_obstacle_velocity(problem, middle_, {state.time + 0.5 * step, step, 0.5}, stage);
  }
  if (!problem.contact.has_friction()) return;
  rate_ = increment / step;
  require_friction(problem, rate_, 1.0 / step, stage);
}

const StageSolution* NonlinearContactEquilibrium::solve(const SemidiscreteProblem& problem, const State& state,
                                                        const Vector& load, double step, StageSolve& stages,
                                                        Vector& increment, Vector& end) {
  if (!problem.has_contact_dofs()) return nullptr;
  stages.rotate_operators(end);
  Stage& stage = stages.stage(0);
  if (stage.right_hand_side.force.size() != problem.dof_count())
    stage.right_hand_side.force.setZero(problem.dof_count());
  stage.right_hand_side.prescribed.setZero(
      problem.supports.size());  // supported nodes are at their prescribed displacements
  progress_.start(4.0 * std::numeric_limits<double>::epsilon() * (reach_ + largest_on_contact(problem, end)),
                  stages.renewal_price());
  moved_ = false;
  point_.resize(Index(problem.contact_dofs.size()));
  image_.resize(point_.size());
  problem.gather_contact(increment, point_);
  evaluate(problem, state, increment, end);
  acceleration_.restart();
  double last = std::numeric_limits<double>::infinity();
  while (true) {
    require(problem, state, load, step, increment, end, stage);
    const StageSolution& solution = stages.solve(0);
    const double correction = largest_on_contact(problem, solution.increment);
    image_.setZero();
    if (std::isfinite(correction)) problem.gather_contact(solution.increment, image_);
    image_ += point_;
    const NewtonProgress::Advice advice = progress_.assess(correction, image_.lpNorm<Eigen::Infinity>());
    if (advice == NewtonProgress::Advice::done) {
      move_to(problem, state, image_, increment, end);
      return &solution;
    }
    if (advice == NewtonProgress::Advice::failed) {
      throw Error(ErrorKind::not_converged,
                  fmt::format("Newton's method found no equilibrium of the contact nodes in {} iterations (the last "
                              "correction moves a node by {:.3g})",
                              progress_.iterations(), correction));
    }
    if (correction > last) acceleration_.restart();
    last = correction;
    const bool accelerates = progress_.iterations() > plain_iterations && advice != NewtonProgress::Advice::renew;
    if (accelerates) acceleration_.advance(point_, image_, image_);
    move_ = image_ - point_;
    point_ = image_;
    moved_ = true;
    move_to(problem, state, point_, increment, end);
    evaluate(problem, state, increment, end);
    if (advice != NewtonProgress::Advice::renew) continue;
    stages.renew_operators(end, end);
    acceleration_.restart();
    progress_.count_renewal();
    progress_.restart();
  }
}

}  // namespace ricochet
