#include "ricochet/simulation/statics/static_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/fem/displacement_space.hpp"
#include "ricochet/simulation/statics/held_bodies.hpp"
#include "ricochet/simulation/statics/rigid_equilibrium.hpp"
#include "ricochet/simulation/statics/starting_stage.hpp"
#include "ricochet/solver/step_solver.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

/// Fraction of the loads that the equilibrium test may leave unbalanced (at single dofs: see below), with a margin. A
/// body with a larger unbalanced fraction is refused at once.
constexpr double clearly_unbalanced = 1e-4;

double lowest_local_frequency_squared(const SemidiscreteProblem& problem) {
  const Vector stiffness = problem.internal_force->stiffness_diagonal();
  const Vector mass = problem.mass.diagonal();
  double lowest = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < mass.size(); ++i) {
    if (mass[i] > 0.0) lowest = std::min(lowest, stiffness[i] / mass[i]);
  }
  return lowest;
}

/// Distinguishes rounding from a force that still moves the body.
class EquilibriumTest {
 public:
  explicit EquilibriumTest(const SemidiscreteProblem& problem)
      : EquilibriumTest(problem, problem.internal_force->tangent()) {}

  /// Returns true if the residual is rounding of the internal forces' terms, and small compared with the loads.
  [[nodiscard]] bool passed(const Vector& displacement, const Vector& left_over) const {
    Vector deformation;
    rigid_.remove(displacement, deformation);
    const double terms = largest(problem_, magnitude_ * deformation.cwiseAbs()) + load_;
    const double left = largest(problem_, left_over);
    return left <= 1e-13 * terms && (load_ == 0.0 || left <= 1e-6 * load_);
  }

 private:
  EquilibriumTest(const SemidiscreteProblem& problem, const SparseMatrix& stiffness)
      : problem_(problem), magnitude_(stiffness.cwiseAbs()), rigid_(problem.nodes, stiffness) {
    Vector load;
    problem.loads.total(0.0, load);
    load_ = largest(problem, load);
  }

  const SemidiscreteProblem& problem_;
  SparseMatrix magnitude_;  ///< |K|
  RigidMotion rigid_;
  double load_ = 0.0;  ///< largest entry
};

/// Friction in a static equilibrium. At a point at rest relative to its obstacle the slip is its displacement from the
/// undeformed body, as if the loads had been applied in one increment. At a sliding point friction has the direction of
/// that sliding; a body that friction would then accelerate has an equilibrium only without it.
class StaticFriction {
 public:
  StaticFriction(const SemidiscreteProblem& problem, const Vector& velocity) : problem_(problem) {
    if (!problem.contact.has_friction()) return;
    Stage stage = contact_stage(problem, Vector::Zero(problem.dof_count()), {});
    evaluate_obstacle_velocity(problem, Vector::Zero(problem.dof_count()), {}, stage);
    require_friction(problem, velocity, 1.0, stage);
    slide_.setZero(stage.conditions.slip.offset.size());
    sliding_.assign(std::size_t(problem.contact.size()), 0);
    const double size = extent(problem.nodes);
    for (Index i = 0; i < problem.contact.size(); ++i) {
      const Vector rate = stage.conditions.slip.offset.segment(i * tangents(), tangents());
      const bool is_rough = problem.contact.has_friction(i);
      if (!is_rough || rate.lpNorm<1>() <= stage.conditions.slip.rounding[i]) continue;
      slide_.segment(i * tangents(), tangents()) = (size / rate.norm()) * rate;
      sliding_[std::size_t(i)] = 1;
    }
    if (problem.contact.follows_motion() && sliding_points() > 0) {
      throw Error(
          ErrorKind::invalid_input,
          "initial.displacement = \"static\": friction on a curved obstacle that moves at t = 0 is not supported in a "
          "static start: keep the obstacle at rest, remove the friction, or set the displacement by expressions");
    }
  }

  [[nodiscard]] const std::vector<char>& sliding() const { return sliding_; }
  [[nodiscard]] Index sliding_points() const { return std::ranges::count(sliding_, 1); }
  void leave_out_sliding() { left_out_ = true; }

  void require(const Vector& displacement, Stage& stage) const {
    if (!problem_.contact.has_friction()) return;
    require_friction(problem_, displacement, 1.0, stage);
    if (left_out_) stage.conditions.frictionless = sliding_;
    // Increments vanish at the equilibrium, so that only the slide remains: its direction is that of friction.
    for (std::size_t i = 0; i < sliding_.size(); ++i) {
      const Index first = Index(i) * tangents();
      if (sliding_[i] != 0) stage.conditions.slip.offset.segment(first, tangents()) = slide_.segment(first, tangents());
    }
  }

 private:
  [[nodiscard]] Index tangents() const { return problem_.dimension - 1; }

  const SemidiscreteProblem& problem_;
  std::vector<char> sliding_;  ///< per contact point
  Vector slide_;               ///< of the size of the body, at points that slide
  bool left_out_ = false;
};

/// Proximal point iterations: (εM + K) δ = L − K U + Gᵀr, then U += δ.
class ProximalPoint {
 public:
  /// `fraction`: ε relative to the smallest K_ii/M_ii, that of the softest region if stiffnesses differ.
  ProximalPoint(const SemidiscreteProblem& problem, const StaticFriction& friction, double fraction,
                const StepSolverOptions& options)
      : problem_(problem),
        friction_(friction),
        epsilon_(fraction * lowest_local_frequency_squared(problem)),
        solver_(make_step_solver(problem, {{epsilon_, 1.0, 0.0, StageDofs::all}}, options)) {
    problem.supports.values(0.0, supported_);
  }

  void iterate(StaticEquilibrium& at) {
    Stage stage = contact_stage(problem_, at.displacement, residual_force(problem_, at.displacement, Vector()));
    for (Index i = 0; i < problem_.supports.size(); ++i) {
      stage.right_hand_side.prescribed[i] = supported_[i] - at.displacement[problem_.supports.dofs()[std::size_t(i)]];
    }
    friction_.require(at.displacement, stage);
    solver_->solve(0, stage, solution_);
    at.displacement += solution_.increment;
    at.normal_reaction = solution_.normal_reaction;
    problem_.mass.multiply(solution_.increment, residual_);
    residual_ *= epsilon_;
    for (const Index dof : problem_.supports.dofs()) residual_[dof] = 0.0;
  }

  /// Unbalanced force.
  [[nodiscard]] const Vector& residual() const { return residual_; }
  [[nodiscard]] double largest_residual() const { return largest(problem_, residual_); }

 private:
  const SemidiscreteProblem& problem_;
  const StaticFriction& friction_;
  double epsilon_;
  std::unique_ptr<StepSolver> solver_;
  StageSolution solution_;
  Vector supported_, residual_;
};

/// Returns a hint on friction, which is the first suspect if it is involved.
std::string role_of_friction(const SemidiscreteProblem& problem, const StaticFriction& friction) {
  if (friction.sliding_points() > 0) return ", and friction does not hold points that slide at t = 0";
  return problem.contact.has_friction() ? ", and contact with friction does not hold it (it slides or tips)" : "";
}

std::string as_text(const Vector& vector) {
  std::string text;
  for (const double component : vector) text += fmt::format("{}{:.3g}", text.empty() ? "" : ", ", component);
  return "(" + text + ")";
}

/// A body that no reactions can hold has no equilibrium, whatever an iteration converges to.
[[noreturn]] void refuse_unheld(const SemidiscreteProblem& problem, const StaticFriction& friction,
                                const UnheldMotion& motion) {
  std::string how = "turns or tips over, since a moment has";
  if (!motion.force.isZero(0.0)) {
    how = fmt::format("{} in the direction {}, since a force of {} has", motion.slides ? "slides" : "moves",
                      as_text(motion.force.normalized()), as_text(motion.force));
  }
  throw Error(ErrorKind::invalid_input,
              fmt::format("initial.displacement = \"static\": there is no equilibrium under the loads at t = 0: the "
                          "body centred at {} {} nothing to balance it{}; add a [[support]] that holds it in the "
                          "direction in which it moves or turns{}, or set the displacement by expressions",
                          as_text(motion.centre), how, role_of_friction(problem, friction),
                          motion.slides ? ", increase the friction" : ""));
}

[[noreturn]] void refuse_static(const SemidiscreteProblem& problem, const StaticFriction& friction,
                                const Vector& left_over) {
  Vector load;
  problem.loads.total(0.0, load);
  Vector resultant = Vector::Zero(problem.dimension);
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    resultant += left_over.segment(node * problem.dimension, problem.dimension);
  }
  const std::string force = fmt::format("({:.3g}, {:.3g}{})", resultant[0], resultant[1],
                                        resultant.size() == 3 ? fmt::format(", {:.3g}", resultant[2]) : "");
  if (largest(problem, left_over) <= 1e-3 * largest(problem, load) || all_are_fixed_by_supports(problem)) {
    throw Error(
        ErrorKind::not_converged,
        fmt::format("initial.displacement = \"static\": the equilibrium was not found to rounding; a force of {:.2g} "
                    "times the largest load remains. {}tiffnesses that differ by many orders of magnitude or very "
                    "slender bodies are likely causes; set the displacement by expressions instead",
                    largest(problem, left_over) / largest(problem, load),
                    problem.contact.has_friction() ? "Friction slightly too weak to hold the body, s" : "S"));
  }
  throw Error(ErrorKind::invalid_input,
              fmt::format("initial.displacement = \"static\": there is no equilibrium under the loads at t = 0: a "
                          "resultant force of {} still moves the body{}; add a [[support]] in the direction in which "
                          "it is free to move or turn, or set the displacement by expressions",
                          force, role_of_friction(problem, friction)));
}

/// Iterates until the test is passed. Returns false after many iterations or, with `give_up_early`, as soon as the
/// unbalanced force no longer decreases.
bool converges(ProximalPoint& point, const EquilibriumTest& test, bool give_up_early, StaticEquilibrium& at) {
  constexpr int max_iterations = 60;
  double before = std::numeric_limits<double>::infinity();
  for (int k = 0; k < max_iterations; ++k) {
    point.iterate(at);
    if (test.passed(at.displacement, point.residual())) return true;
    const double now = point.largest_residual();
    if (give_up_early && k >= 5 && now > 0.95 * before) return false;
    before = now;
  }
  return false;
}

/// Finds the equilibrium by proximal point iterations. With ε well below the lowest elastic frequency squared a few of
/// them suffice, however far the body has to move. Slender or very uneven bodies have lower frequencies: ε is reduced
/// while the iteration stalls. With friction, ε starts at a larger value: if friction alone holds the body, a small ε
/// yields a condensed operator in which stick and slip of single points hardly show beside the rigid motion.
bool find_equilibrium(const SemidiscreteProblem& problem, const StaticFriction& friction, const EquilibriumTest& test,
                      const StepSolverOptions& options, StaticEquilibrium& at, Vector& left_over) {
  for (const double fraction : {1e-4, 1e-6, 1e-8, 1e-10, 1e-12}) {
    if (fraction > 1e-8 && !problem.contact.has_friction()) continue;
    ProximalPoint point(problem, friction, fraction, options);
    if (converges(point, test, false, at)) return true;
    left_over = point.residual();
  }
  return false;
}

/// As find_equilibrium, for a sliding body: most of these have no equilibrium.
bool find_sliding_equilibrium(const SemidiscreteProblem& problem, const StaticFriction& friction,
                              const EquilibriumTest& test, const StepSolverOptions& options, StaticEquilibrium& at) {
  ProximalPoint point(problem, friction, 1e-4, options);
  try {
    return converges(point, test, true, at);
  } catch (const Error& problem_of_contact) {
    if (problem_of_contact.kind() != ErrorKind::not_converged) throw;
    return false;
  }
}

}  // namespace

StaticEquilibrium static_equilibrium(const SemidiscreteProblem& problem, const Vector& guess, const Vector& velocity,
                                     const StepSolverOptions& step_options) {
  require_linear(*problem.internal_force, "initial.displacement = \"static\"");
  // Without inertia iterative solvers converge badly, and not at all if contact alone holds a body: a factorization is
  // used if it fits into memory.
  StepSolverOptions options = step_options;
  if (options.method == SolverMethod::iterative) options.method = SolverMethod::automatic;
  options.solves = 0;
  const StaticEquilibrium start{guess, Vector::Zero(problem.contact.size())};
  StaticEquilibrium result = start;
  StaticFriction friction(problem, velocity);
  const EquilibriumTest test(problem);
  const auto require_balance = [&](const std::vector<char>& frictionless) -> std::optional<UnheldMotion> {
    // If normals follow the motion, those at the start do not show what holds the body in its final position.
    if (problem.contact.follows_motion()) return {};
    const std::optional<UnheldMotion> unheld = find_unheld_motion(problem, frictionless);
    if (unheld && unheld->unbalanced > clearly_unbalanced) refuse_unheld(problem, friction, *unheld);
    return unheld;
  };
  std::optional<UnheldMotion> unheld = require_balance({});
  bool found = friction.sliding_points() > 0 && find_sliding_equilibrium(problem, friction, test, options, result);
  if (!found) {
    if (friction.sliding_points() > 0) unheld = require_balance(friction.sliding());
    result = start;
    friction.leave_out_sliding();
    Vector left_over;
    try {
      found = find_equilibrium(problem, friction, test, options, result, left_over);
    } catch (const Error& problem_of_contact) {
      if (problem_of_contact.kind() != ErrorKind::not_converged) throw;
      if (unheld) refuse_unheld(problem, friction, *unheld);
      throw Error(ErrorKind::not_converged,
                  fmt::format("initial.displacement = \"static\": {}; there may be no equilibrium{}",
                              problem_of_contact.what(), role_of_friction(problem, friction)));
    }
    if (!found && unheld) refuse_unheld(problem, friction, *unheld);
    if (!found) refuse_static(problem, friction, left_over);
    if (friction.sliding_points() > 0) {
      log::info(
          fmt::format("initial.displacement = \"static\": {} at t = 0, and there is no equilibrium with friction "
                      "there: the static start omits this friction, which acts from t = 0 on",
                      counted(friction.sliding_points(), "contact point slides", "contact points slide")));
    }
  }
  // With a small ε the gaps of a body that only contact holds have rounding errors of the size of weight/ε. Iterations
  // with a large ε, from the current position, remove them.
  ProximalPoint near(problem, friction, 1e-2, options);
  for (int polish = 0; polish < 3; ++polish) near.iterate(result);
  return result;
}

}  // namespace ricochet
