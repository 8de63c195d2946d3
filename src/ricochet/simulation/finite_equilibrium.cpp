#include "ricochet/simulation/finite_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/problem/contact_conditions.hpp"
#include "ricochet/simulation/starting_stage.hpp"

namespace ricochet {

namespace {

constexpr double shortest_increment = 1e-5;
constexpr int most_rounds = 100;
/// ε relative to the least K_ii/M_ii: bodies that are held by supports hardly feel it, others move by what it allows.
constexpr double proximal_fraction = 1e-10;
/// What the proximal force may be of the largest of the internal ones.
constexpr double proximal_rounding = 1e-10;

double proximal_coefficient(const SemidiscreteProblem& problem) {
  const Vector stiffness = problem.internal_force->tangent().diagonal(), mass = problem.mass.diagonal();
  double lowest = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < mass.size(); ++i) {
    if (mass[i] > 0.0 && stiffness[i] > 0.0) lowest = std::min(lowest, stiffness[i] / mass[i]);
  }
  return proximal_fraction * lowest;
}

class LoadPath {
 public:
  LoadPath(const SemidiscreteProblem& problem, const StepSolverOptions& options)
      : problem_(problem),
        epsilon_(proximal_coefficient(problem)),
        solver_(make_step_solver(problem, {{epsilon_, 1.0, 0.0, StageDofs::all}}, options)) {
    problem.loads.total(0.0, load_);
    problem.supports.values(0.0, supported_);
  }

  /// From a displacement to that with a part of loads and supports. Throws Error(not_converged).
  void advance(double part, StaticEquilibrium& at) {
    problem_.internal_force->evaluate(at.displacement, force_);
    right_ = part * load_ - force_;
    if (problem_.pressure) problem_.pressure->add_force(at.displacement, 0.0, right_, part);
    Stage stage = contact_stage(problem_, at.displacement, right_);
    stage.pressure_part = part;
    stage.force_place = at.displacement;
    for (Index i = 0; i < problem_.supports.size(); ++i)
      stage.prescribed[i] =
          part * supported_[i] - at.displacement[problem_.supports.dofs()[static_cast<std::size_t>(i)]];
    require_friction(problem_, Vector::Zero(problem_.dof_count()), {}, 1.0, stage);
    solver_->renew(at.displacement, at.displacement);
    solver_->solve(0, stage, solution_);
    at.displacement += solution_.increment;
    at.normal_reaction = solution_.normal_reaction;
  }

  /// Whether what the proximal term holds is rounding.
  [[nodiscard]] bool holds_by_itself() {
    problem_.mass.multiply(solution_.increment, left_);
    return epsilon_ * largest(problem_, left_) <=
           proximal_rounding * (largest(problem_, force_) + largest(problem_, load_));
  }

 private:
  const SemidiscreteProblem& problem_;
  double epsilon_;
  std::unique_ptr<StepSolver> solver_;
  StageSolution solution_;
  Vector load_, supported_, force_, right_, left_;
};

}  // namespace

StaticEquilibrium finite_equilibrium(const SemidiscreteProblem& problem, const Vector& guess,
                                     const StepSolverOptions& step_options) {
  StepSolverOptions options = step_options;
  options.solves = 0;
  LoadPath path(problem, options);
  StaticEquilibrium at{guess, Vector::Zero(problem.contact.size())};
  double reached = 0.0, increment = 1.0;
  while (reached < 1.0) {
    StaticEquilibrium next = at;
    const double part = std::min(1.0, reached + increment);
    try {
      path.advance(part, next);
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged) throw;
      increment *= 0.25;
      if (increment >= shortest_increment) continue;
      throw Error(ErrorKind::not_converged,
                  fmt::format("initial.displacement = \"static\": no equilibrium was found beyond {:.4g} of the loads "
                              "and prescribed displacements at t = 0 ({}); there the body may buckle, snap through, or "
                              "be held by nothing: apply less, add a [[support]], or let the loads act from a "
                              "start at rest",
                              reached, error.what()));
    }
    at = std::move(next);
    reached = part;
    increment *= 2.0;
  }
  for (int round = 0; round < most_rounds; ++round) {
    path.advance(1.0, at);
    if (path.holds_by_itself()) return at;
  }
  throw Error(ErrorKind::not_converged,
              "initial.displacement = \"static\": the body still moves after many rounds: nothing holds it under the "
              "loads at t = 0; add a [[support]] in the direction in which it is free to move or turn");
}

}  // namespace ricochet
