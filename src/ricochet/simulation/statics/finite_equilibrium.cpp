#include "ricochet/simulation/statics/finite_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/simulation/statics/held_bodies.hpp"
#include "ricochet/simulation/statics/starting_stage.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

constexpr double shortest_increment = 1e-5;
constexpr int max_iterations = 100, most_renewals = 12;
/// ε relative to the smallest K_ii/M_ii. Bodies that supports hold do not need it. For bodies that contact helps to
/// hold, ε is the only resistance of the operator to the motion that supports leave free, whose rounding is that of
/// forces over ε: with too small a value Newton's method does not settle; a larger one requires more iterations at the
/// end.
constexpr double proximal_fraction = 1e-10, proximal_fraction_of_unheld = 1e-6;
/// Tolerated residual, relative to the largest force.
constexpr double left_of_forces = 1e-10;

double proximal_coefficient(const SemidiscreteProblem& problem) {
  const Vector stiffness = problem.internal_force->stiffness_diagonal(), mass = problem.mass.diagonal();
  double lowest = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < mass.size(); ++i) {
    if (mass[i] > 0.0 && stiffness[i] > 0.0) lowest = std::min(lowest, stiffness[i] / mass[i]);
  }
  return (all_are_fixed_by_supports(problem) ? proximal_fraction : proximal_fraction_of_unheld) * lowest;
}

class LoadPath {
 public:
  LoadPath(const SemidiscreteProblem& problem, const StepSolverOptions& options)
      : problem_(problem),
        epsilon_(proximal_coefficient(problem)),
        size_(extent(problem.nodes)),
        solver_(make_step_solver(problem, {{epsilon_, 1.0, 0.0, StageDofs::all}}, options)) {
    problem.loads.total(0.0, load_);
    problem.supports.values(0.0, supported_);
  }

  /// Advances a displacement to the equilibrium under a fraction of loads and prescribed displacements, near enough to
  /// continue from. Throws Error(not_converged).
  void advance(double part, StaticEquilibrium& at) {
    constexpr int most_corrections = 40;
    constexpr double near = 1e-6;  // of the size of the bodies
    constexpr double most_growth = 10.0;
    start(at.displacement);
    for (int k = 0; k < most_corrections; ++k) {
      const double before = last_, correction = correct(part, at);
      if (correction <= near) return;
      // Beyond the loads that a body can carry corrections are erratic, also with a new factor.
      if (correction > (may_renew() ? most_growth : 1.0) * before)
        throw Error(ErrorKind::not_converged, "the corrections of Newton's method grow");
    }
    throw Error(
        ErrorKind::not_converged,
        fmt::format("Newton's method did not converge in {} corrections, the last of which moved a node by {:.3g}",
                    most_corrections, last_ * size_));
  }

  /// Performs another correction under the full loads, which is an iteration of the proximal point method. Returns true
  /// if the residual of all forces is rounding and corrections no longer shrink: rounding of a motion that only contact
  /// restrains is amplified by 1/ε, so that the size of the smallest correction is unknown.
  [[nodiscard]] bool settle(StaticEquilibrium& at) {
    constexpr double rounding = 1e-13;  // of the size of the bodies
    constexpr double stalled = 0.9;
    const double before = last_, correction = correct(1.0, at);
    const bool shrinks = correction > rounding && (correction <= stalled * before || may_renew());
    return !shrinks && is_balanced(at);
  }

 private:
  /// Resets the iteration; slips of friction are measured from this displacement.
  void start(const Vector& displacement) {
    origin_ = displacement;
    renewals_ = 0;
    is_new_ = false;
    last_ = std::numeric_limits<double>::infinity();
    rate_ = 1.0;
  }

  /// Performs a correction of Newton's method and returns its largest entry relative to the size of the bodies. Renews
  /// the factor if the previous correction converged slowly.
  double correct(double part, StaticEquilibrium& at) {
    constexpr double slow = 0.3;
    Stage stage = stage_at(part, at.displacement);
    is_new_ = rate_ > slow && may_renew();
    if (is_new_) {
      solver_->renew_operators(at.displacement, at.displacement);
      ++renewals_;
    }
    solver_->solve(0, stage, solution_);
    const double correction = largest(problem_, solution_.increment) / size_;
    if (!std::isfinite(correction)) throw Error(ErrorKind::not_converged, "Newton's method diverges");
    at.displacement += solution_.increment;
    at.normal_reaction = solution_.normal_reaction;
    rows_ = stage.rows;
    rate_ = correction / last_;
    last_ = correction;
    return correction;
  }

  /// Returns whether a new factor may improve slow convergence.
  [[nodiscard]] bool may_renew() const { return !is_new_ && renewals_ < most_renewals; }

  Stage stage_at(double part, const Vector& displacement) {
    find_forces(part, displacement);
    Stage stage = contact_stage(problem_, displacement, right_hand_side_);
    stage.linearization.displacement.resize(0);  // one linear stage
    for (Index i = 0; i < problem_.supports.size(); ++i)
      stage.right_hand_side.prescribed[i] =
          part * supported_[i] - displacement[problem_.supports.dofs()[std::size_t(i)]];
    require_friction(problem_, displacement - origin_, 1.0, stage);
    return stage;
  }

  /// Checks the balance of the loads, with the reactions of the last correction, at unsupported dofs.
  [[nodiscard]] bool is_balanced(const StaticEquilibrium& at) {
    find_forces(1.0, at.displacement);
    const double size = largest(problem_, force_) + largest(problem_, load_);
    rows_->add_force(solution_.normal_reaction, solution_.tangential_reaction, right_hand_side_);
    for (const Index dof : problem_.supports.dofs()) right_hand_side_[dof] = 0.0;
    return largest(problem_, right_hand_side_) <= left_of_forces * size;
  }

  /// Computes f, and L − f with the pressure that follows the surface.
  void find_forces(double part, const Vector& displacement) {
    problem_.internal_force->evaluate(displacement, force_);
    right_hand_side_ = part * load_ - force_;
    if (problem_.pressure) problem_.pressure->add_force(displacement, 0.0, right_hand_side_, part);
  }

  const SemidiscreteProblem& problem_;
  double epsilon_, size_;
  double last_ = std::numeric_limits<double>::infinity(), rate_ = 1.0;  ///< last correction, ratio to the previous
  int renewals_ = 0;
  bool is_new_ = false;  ///< the last correction used a new factor
  std::unique_ptr<StepSolver> solver_;
  StageSolution solution_;
  std::shared_ptr<const ContactRows> rows_;  ///< for the reactions in solution_
  Vector origin_, load_, supported_, force_, right_hand_side_;
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
      throw Error(
          ErrorKind::not_converged,
          fmt::format("initial.displacement = \"static\": no equilibrium was found beyond {:.4g} times the loads and "
                      "prescribed displacements at t = 0 ({}); there the body may buckle, snap through, or be held by "
                      "nothing: apply smaller ones, add a [[support]], or start at rest without a static equilibrium",
                      reached, error.what()));
    }
    at = std::move(next);
    reached = part;
    increment *= 2.0;
  }
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    if (path.settle(at)) return at;
  }
  throw Error(ErrorKind::not_converged,
              "initial.displacement = \"static\": the body still moves after many iterations: nothing holds it under "
              "the loads at t = 0; add a [[support]] in the direction in which it is free to move or turn");
}

}  // namespace ricochet
