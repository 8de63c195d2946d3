#include "ricochet/run/cost_estimate.hpp"

#include <cmath>

#include "ricochet/base/timer.hpp"
#include "ricochet/solver/stage/memory_estimate.hpp"

namespace ricochet {

namespace {

/// Returns the time of a second call, as the first one allocates.
template <class Call>
double seconds_of(const Call& call) {
  call();
  const Timer timer;
  call();
  return timer.seconds();
}

double rows_of_contact(const SemidiscreteProblem& problem, double points) {
  return (problem.contact.has_friction() ? double(problem.dimension) : 1.0) * points;
}

/// Returns the time of a dense contact problem: iterations read its matrix, and some factorize it.
double dense_seconds(double rows) {
  constexpr double iterations = 100.0, factorizations = 3.0;
  return iterations * sizeof(double) * rows * rows / estimated_bytes_per_second +
         factorizations * rows * rows * rows / 3.0 / estimated_operations_per_second;
}

void estimate_iterations(const SemidiscreteProblem& problem, const Scheme& scheme, CostEstimate& cost) {
  const bool is_explicit = std::isfinite(scheme.stability_limit(problem).value_or(HUGE_VAL));
  if (!problem.internal_force->is_linear()) {
    cost.least_iterations = is_explicit ? 1 : 5;
    cost.most_iterations = is_explicit ? 10 : 30;
  } else if (problem.contact.follows_motion()) {
    cost.least_iterations = 1;
    cost.most_iterations = 10;
  }
}

/// Estimates a step. An iteration evaluates the force of a step and its derivative, the end of the step, and rows with
/// their gaps.
void estimate_step(const SemidiscreteProblem& problem, const Scheme& scheme, CostEstimate& cost) {
  constexpr double forces = 3.0, gaps = 5.0;
  estimate_iterations(problem, scheme, cost);
  double solves = 0.0, bytes_per_point = 0.0;
  for (const StageEstimate& stage : cost.stages) {
    solves += stage.step_seconds;
    bytes_per_point += stage.bytes_per_point;
  }
  const double own = cost.product_seconds + forces * cost.force_seconds;
  // Explicit steps evaluate the force of the whole body once and iterate on contact nodes only.
  const bool repeats_all = cost.least_iterations > 1 || problem.internal_force->is_linear();
  const auto seconds = [&](double points) {
    const double columns =
        problem.contact.follows_motion() ? points * bytes_per_point / estimated_bytes_per_second : 0.0;
    const double iteration =
        solves + dense_seconds(rows_of_contact(problem, points)) + columns + gaps * cost.gap_seconds;
    return repeats_all ? cost.most_iterations * (own + iteration) : own + cost.most_iterations * iteration;
  };
  const auto points = double(problem.contact.size());
  cost.step_seconds = {cost.least_iterations * (own + solves), seconds(CostRange::part * points), seconds(points)};
}

/// Sums the program, matrices with the copies made during assembly, vectors, and the dense contact problem with its
/// factor and copies.
void estimate_memory(const SemidiscreteProblem& problem, CostEstimate& cost) {
  constexpr double program = 35e6, bytes_per_entry = 45.0;
  const double entries = double(problem.internal_force->tangent().nonZeros());
  const auto points = double(problem.contact.size());
  const double rows = rows_of_contact(problem, points);
  cost.memory.least = program + bytes_per_entry * entries;
  double columns = 0.0;
  for (const StageEstimate& stage : cost.stages) {
    cost.memory.least += stage.peak_bytes;
    columns += stage.bytes_per_point * points;
  }
  const auto with = [&](double part) { return cost.memory.least + memory_of_contact(part * rows) + part * columns; };
  cost.memory = {cost.memory.least, with(CostRange::part), with(1.0)};
}

}  // namespace

CostEstimate estimate_cost(const Case& input, const Model& model, const Scheme& scheme) {
  const SemidiscreteProblem& problem = model.problem;
  CostEstimate cost;
  cost.stages = estimate_step_solver(problem, scheme.operators(problem), step_solver_options(input));
  for (const StageEstimate& stage : cost.stages) cost.factorization_seconds += stage.factorization_seconds;
  cost.product_seconds = estimate_products(problem);
  const Vector rest = Vector::Zero(problem.dof_count());
  Vector values;
  if (!problem.internal_force->is_linear())
    cost.force_seconds = seconds_of([&] { problem.internal_force->evaluate(rest, values); });
  if (problem.contact.follows_motion()) cost.gap_seconds = seconds_of([&] { problem.gaps(rest, 0.0, values); });
  estimate_step(problem, scheme, cost);
  estimate_memory(problem, cost);
  return cost;
}

}  // namespace ricochet
