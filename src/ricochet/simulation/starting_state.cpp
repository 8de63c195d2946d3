#include "ricochet/simulation/starting_state.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/scheme/gap_condition.hpp"
#include "ricochet/solver/step_solver.hpp"

namespace ricochet {

namespace {

double largest(const Vector& v) {
  return v.size() > 0 ? v.lpNorm<Eigen::Infinity>() : 0.0;
}

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
  require_no_penetration(problem, displacement, stage);
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
  const double change = largest(solution.increment);
  if (change > 0.0) {
    log::info(fmt::format(
        "contact nodes have no inertia: their initial displacement was moved by up to {:.3g} to equilibrium", change));
  }
}

/// Points that rest on their obstacle at t = 0: no gap, no normal velocity. Those that carry a force in a static
/// equilibrium (`pressed`, empty without one) have no gap by construction, though their gap may be rounding of the
/// solve.
std::vector<char> resting_points(const SemidiscreteProblem& problem, const State& state, const Vector& pressed) {
  Vector gap;
  problem.gaps(state.displacement, gap);
  const Vector rate = problem.contact.gap_operator * state.velocity;
  std::vector<char> resting(static_cast<std::size_t>(problem.contact.size()), 0);
  for (Index i = 0; i < problem.contact.size(); ++i) {
    const Index first = problem.contact.nodes[static_cast<std::size_t>(i)] * problem.dimension;
    const double rate_rounding =
        8.0 * std::numeric_limits<double>::epsilon() * state.velocity.segment(first, problem.dimension).lpNorm<1>();
    if (problem.is_massless[static_cast<std::size_t>(first)] != 0) continue;
    const bool closed = gap[i] <= problem.contact.gap_rounding[i] || (pressed.size() > 0 && pressed[i] > 0.0);
    resting[static_cast<std::size_t>(i)] = closed && std::abs(rate[i]) <= rate_rounding ? 1 : 0;
  }
  return resting;
}

void find_acceleration(const SemidiscreteProblem& problem, const Vector& support_acceleration, const Vector& pressed,
                       State& state) {
  const auto solver = make_direct_step_solver(problem, {{1.0, 0.0, 0.0, StageDofs::massive}});
  Stage stage = contact_stage(problem, state.displacement, residual_force(problem, state.displacement, state.velocity));
  stage.prescribed = support_acceleration;
  stage.eligible = resting_points(problem, state, pressed);
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

namespace {

double lowest_local_frequency_squared(const SemidiscreteProblem& problem) {
  const Vector stiffness = problem.internal_force->tangent().diagonal();
  const Vector mass = problem.mass.diagonal();
  double lowest = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < mass.size(); ++i) {
    if (mass[i] > 0.0) lowest = std::min(lowest, stiffness[i] / mass[i]);
  }
  return lowest;
}

/// Tells rounding from a force that still moves the body.
class EquilibriumTest {
 public:
  explicit EquilibriumTest(const SemidiscreteProblem& problem)
      : magnitude_(problem.internal_force->tangent().cwiseAbs()), rigid_(problem.nodes, magnitude_) {
    Vector load;
    problem.loads.total(0.0, load);
    load_ = largest(load);
  }

  /// True when what is left is rounding of the internal forces' terms, and small beside the loads that act.
  [[nodiscard]] bool passed(const Vector& displacement, const Vector& left_over) const {
    Vector deformation;
    rigid_.remove(displacement, deformation);
    const double terms = largest(magnitude_ * deformation.cwiseAbs()) + load_;
    const double left = largest(left_over);
    return left <= 1e-13 * terms && (load_ == 0.0 || left <= 1e-6 * load_);
  }

 private:
  SparseMatrix magnitude_;  ///< |K|
  RigidMotion rigid_;
  double load_ = 0.0;  ///< the largest
};

/// Proximal point iterations: (εM + K) δ = L − K U + Gᵀr, then U += δ.
class ProximalPoint {
 public:
  /// ε as a fraction of the least K_ii/M_ii: of the softest region, where stiffnesses differ.
  ProximalPoint(const SemidiscreteProblem& problem, double fraction)
      : problem_(problem),
        epsilon_(fraction * lowest_local_frequency_squared(problem)),
        solver_(make_direct_step_solver(problem, {{epsilon_, 1.0, 0.0, StageDofs::all}})) {
    problem.supports.values(0.0, supported_);
  }

  void iterate(StaticEquilibrium& at) {
    Stage stage = contact_stage(problem_, at.displacement, residual_force(problem_, at.displacement, Vector()));
    for (Index i = 0; i < problem_.supports.size(); ++i) {
      stage.prescribed[i] = supported_[i] - at.displacement[problem_.supports.dofs()[static_cast<std::size_t>(i)]];
    }
    solver_->solve(0, stage, solution_);
    at.displacement += solution_.increment;
    at.normal_reaction = solution_.normal_reaction;
    left_over_ = epsilon_ * (problem_.mass * solution_.increment);
    for (const Index dof : problem_.supports.dofs()) left_over_[dof] = 0.0;
  }

  /// The force that is not in equilibrium yet.
  [[nodiscard]] const Vector& left_over() const { return left_over_; }

 private:
  const SemidiscreteProblem& problem_;
  double epsilon_;
  std::unique_ptr<StepSolver> solver_;
  StageSolution solution_;
  Vector supported_, left_over_;
};

[[noreturn]] void refuse_static(const SemidiscreteProblem& problem, const Vector& left_over) {
  Vector load;
  problem.loads.total(0.0, load);
  Vector resultant = Vector::Zero(problem.dimension);
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    resultant += left_over.segment(node * problem.dimension, problem.dimension);
  }
  const std::string force = fmt::format("({:.3g}, {:.3g}{})", resultant[0], resultant[1],
                                        resultant.size() == 3 ? fmt::format(", {:.3g}", resultant[2]) : "");
  if (largest(left_over) <= 1e-3 * largest(load)) {
    throw Error(
        ErrorKind::not_converged,
        fmt::format("initial.displacement = \"static\": the equilibrium was not found to rounding; a force of {:.2g} "
                    "of the largest load is left. Stiffnesses that differ by many orders of magnitude or very slender "
                    "bodies are likely causes; give the displacement by expressions instead",
                    largest(left_over) / largest(load)));
  }
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("initial.displacement = \"static\": there is no equilibrium under the loads at t = 0: a resultant "
                  "force of {} still moves the body; add a [[support]] in the direction in which it is free to move "
                  "or turn, or give the displacement by expressions",
                  force));
}

}  // namespace

StaticEquilibrium static_equilibrium(const SemidiscreteProblem& problem, const Vector& guess) {
  StaticEquilibrium result{guess, Vector::Zero(problem.contact.size())};
  // ε well below the lowest elastic frequency squared converges in a few iterations, wherever the body has to go.
  // Slender or very uneven bodies have lower frequencies: ε is taken down while the iteration stalls.
  constexpr int rounds = 60;
  const EquilibriumTest test(problem);
  Vector left_over;
  bool found = false;
  for (const double fraction : {1e-8, 1e-10, 1e-12}) {
    ProximalPoint point(problem, fraction);
    for (int k = 0; k < rounds && !found; ++k) {
      point.iterate(result);
      found = test.passed(result.displacement, point.left_over());
    }
    left_over = point.left_over();
    if (found) break;
  }
  if (!found) refuse_static(problem, left_over);
  // A small ε leaves rounding of the size of weight/ε in the gaps of a body that only contact holds. A large one, from
  // where we are now, takes it away.
  ProximalPoint near(problem, 1e-2);
  for (int polish = 0; polish < 3; ++polish) near.iterate(result);
  return result;
}

namespace {

/// A body that starts inside its obstacle is pushed out at once, which creates energy: rarely what was meant.
void warn_of_overlap(const SemidiscreteProblem& problem, const State& state) {
  Vector gap;
  problem.gaps(state.displacement, gap);
  Index inside = 0;
  double deepest = 0.0;
  for (Index i = 0; i < gap.size(); ++i) {
    if (gap[i] >= -problem.contact.gap_rounding[i]) continue;
    ++inside;
    deepest = std::max(deepest, -gap[i]);
  }
  if (inside == 0) return;
  log::warning(
      fmt::format("at the start {} of {} contact points are inside their obstacle, the deepest by {:.3g}: they are "
                  "pushed out at once, which creates energy; check the obstacle's point and normal (which points "
                  "out of the obstacle), or start from initial.displacement = \"static\"",
                  inside, gap.size(), deepest));
}

}  // namespace

State make_starting_state(const SemidiscreteProblem& problem, const InitialConditions& initial, double step) {
  State state;
  Vector pressed;
  if (initial.static_equilibrium) {
    StaticEquilibrium equilibrium = static_equilibrium(problem, Vector::Zero(problem.dof_count()));
    state.displacement = std::move(equilibrium.displacement);
    pressed = std::move(equilibrium.normal_reaction);
    log::info(fmt::format("static equilibrium displaces nodes by up to {:.3g}", largest(state.displacement)));
  } else {
    state.displacement = initial.displacement;
  }
  state.velocity = initial.velocity;
  state.acceleration.setZero(problem.dof_count());
  state.forces.normal_reaction.setZero(problem.contact.size());
  Vector support_acceleration;
  take_supports(problem, step, state, support_acceleration);
  if (!initial.static_equilibrium) warn_of_overlap(problem, state);
  if (problem.has_singular_mass()) relax_contact_nodes(problem, state);
  find_acceleration(problem, support_acceleration, pressed, state);
  find_support_reaction(problem, state);
  if (problem.loads.varies()) problem.loads.varying(0.0, state.forces.varying_load);
  if (problem.has_damping()) state.forces.damping_force = problem.damping * state.velocity;
  return state;
}

}  // namespace ricochet
