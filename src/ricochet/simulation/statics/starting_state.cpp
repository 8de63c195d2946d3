#include "ricochet/simulation/statics/starting_state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <string_view>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/point_sets.hpp"
#include "ricochet/base/space_vector.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/linear_algebra/graph_components.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/problem/penetrating_points.hpp"
#include "ricochet/problem/viscous_force.hpp"
#include "ricochet/simulation/statics/finite_equilibrium.hpp"
#include "ricochet/simulation/statics/held_bodies.hpp"
#include "ricochet/simulation/statics/starting_stage.hpp"
#include "ricochet/simulation/statics/static_equilibrium.hpp"
#include "ricochet/solver/step_solver.hpp"
#include "ricochet/step/contact_conditions.hpp"

namespace ricochet {

namespace {

void add_reactions(const StageSolution& solution, State& state) {
  state.forces.normal_reaction += solution.normal_reaction;
  if (solution.tangential_reaction.size() > 0) state.forces.tangential_reaction += solution.tangential_reaction;
  for (std::size_t i = 0; i < solution.contact_status.size(); ++i) {
    state.contact_status[i] = std::max(state.contact_status[i], solution.contact_status[i]);
  }
}

void apply_supports(const SemidiscreteProblem& problem, double step, State& state, Vector& support_acceleration) {
  Vector values, velocities;
  problem.supports.values(0.0, values);
  problem.supports.derivatives(0.0, step, velocities, support_acceleration);
  double largest_change = 0.0;
  double largest_velocity_change = 0.0;
  for (Index i = 0; i < problem.supports.size(); ++i) {
    const Index dof = problem.supports.dofs()[std::size_t(i)];
    largest_change = std::max(largest_change, std::abs(values[i] - state.displacement[dof]));
    largest_velocity_change = std::max(largest_velocity_change, std::abs(velocities[i] - state.velocity[dof]));
    state.displacement[dof] = values[i];
    state.velocity[dof] = velocities[i];
  }
  largest_change = problem.ranks->maximum(largest_change);
  largest_velocity_change = problem.ranks->maximum(largest_velocity_change);
  if (largest_change > 0.0 || largest_velocity_change > 0.0) {
    log::info(
        fmt::format("initial conditions on supported boundaries follow the supports: displacement changed by up to "
                    "{:.3g}, velocity by up to {:.3g}",
                    largest_change, largest_velocity_change));
  }
}

/// Massless contact nodes are in equilibrium with their surroundings at every instant, including the first. Friction
/// acts on their velocity plus the relaxation, which is assumed to take one step: at nodes that slide at t = 0 it
/// opposes that sliding, at nodes at rest it opposes the relaxation.
void relax_contact_nodes(const SemidiscreteProblem& problem, double step, const StepSolverOptions& options,
                         State& state) {
  const auto solver = make_step_solver(problem, {{0.0, 1.0, 0.0, StageDofs::contact}}, options);
  Stage stage = contact_stage(problem, state.displacement, residual_force(problem, state.displacement, state.velocity));
  evaluate_obstacle_velocity(problem, state.displacement, {.factor = 1.0}, stage);
  require_friction(problem, state.velocity, 1.0 / step, stage);
  StageSolution solution;
  try {
    solver->solve(0, stage, solution);
  } catch (const Error& problem) {
    throw Error(problem.kind(),
                fmt::format("no equilibrium of the contact nodes, which have no inertia, was found at the start for "
                            "the given positions of the other nodes: {}; use an initial.displacement that strains the "
                            "bodies less there, or \"static\", or move the body by supports",
                            problem.what()));
  }
  state.displacement += solution.increment;
  state.forces.rows = stage.rows;
  add_reactions(solution, state);
  const double change = largest(problem, solution.increment);
  if (change > 0.0) {
    log::info(fmt::format(
        "contact nodes have no inertia: their initial displacement was changed by up to {:.3g} to reach equilibrium",
        change));
  }
}

/// Points that rest on their obstacle at t = 0: no gap, no normal velocity. Those that carry a force in a static
/// equilibrium (`pressed`, empty without one) have no gap by construction, although their computed gap may be rounding
/// of the solution.
std::vector<char> resting_points(const SemidiscreteProblem& problem, const State& state, const Vector& pressed) {
  std::vector<char> resting(static_cast<std::size_t>(problem.contact.size()), 0);
  if (problem.has_singular_mass()) return resting;
  Vector gap, rate_rounding;
  problem.gaps(state.displacement, 0.0, gap);
  Stage here = contact_stage(problem, state.displacement, {});
  Vector rate;
  here.rows->normal_motion(state.velocity, rate);
  evaluate_obstacle_velocity(problem, state.displacement, {}, here);
  project_motion(*here.rows, here.obstacle);
  problem.trace_rounding(state.velocity, rate_rounding);
  if (here.obstacle.normal.size() > 0) {
    rate -= here.obstacle.normal;
    rate_rounding += 8.0 * std::numeric_limits<double>::epsilon() * here.obstacle.normal.cwiseAbs();
  }
  for (Index i = 0; i < problem.contact.size(); ++i) {
    const bool closed = gap[i] <= problem.contact.rows->gap_rounding[i] || (pressed.size() > 0 && pressed[i] > 0.0);
    resting[std::size_t(i)] = closed && std::abs(rate[i]) <= rate_rounding[i] ? 1 : 0;
  }
  return resting;
}

/// Computes the acceleration dof by dof: a diagonal mass needs no factorization if no contact point rests on its
/// obstacle. Returns false otherwise.
bool find_acceleration_pointwise(const SemidiscreteProblem& problem, const Vector& support_acceleration,
                                 const std::vector<char>& resting, State& state) {
  const bool rests = std::ranges::find(resting, 1) != resting.end();
  if (problem.ranks->any(rests) || !problem.has_diagonal_mass()) return false;
  Vector mass = problem.mass.diagonal();
  problem.ranks->accumulate(mass);
  Vector acceleration = residual_force(problem, state.displacement, state.velocity);
  problem.ranks->accumulate(acceleration);
  bool lacks_inertia = false;
  for (Index dof = 0; dof < mass.size(); ++dof) {
    if (problem.is_massless[std::size_t(dof)] != 0 || problem.is_tied_dof(dof)) {
      acceleration[dof] = 0.0;
    } else if (mass[dof] > 0.0) {
      acceleration[dof] /= mass[dof];
    } else if (!problem.supports.contains(dof)) {
      lacks_inertia = true;
    }
  }
  if (problem.ranks->any(lacks_inertia)) return false;
  for (Index i = 0; i < problem.supports.size(); ++i) {
    acceleration[problem.supports.dofs()[std::size_t(i)]] = support_acceleration[i];
  }
  for (const Index dof : problem.massless_dofs) acceleration[dof] = 0.0;
  state.acceleration = std::move(acceleration);
  return true;
}

/// Computes the part of the gaps' second time derivative that is due to the velocity, by differences over a step; it is
/// zero against planes.
void find_curvature_term(const SemidiscreteProblem& problem, const State& state, double step, Vector& term) {
  term.setZero();
  if (!problem.contact.follows_motion()) return;
  Vector before, now, after;
  problem.gaps(state.displacement - step * state.velocity, -step, before);
  problem.gaps(state.displacement, 0.0, now);
  problem.gaps(state.displacement + step * state.velocity, step, after);
  term = (before - 2.0 * now + after) / (step * step);
}

/// Applies friction to the slip rate at the end of a step with this acceleration.
void find_acceleration(const SemidiscreteProblem& problem, const Vector& support_acceleration, const Vector& pressed,
                       double step, const StepSolverOptions& options, State& state) {
  std::vector<char> resting = resting_points(problem, state, pressed);
  if (find_acceleration_pointwise(problem, support_acceleration, resting, state)) return;
  StepSolverOptions once = options;
  once.solves = 1;
  const auto solver = make_step_solver(problem, {{1.0, 0.0, 0.0, StageDofs::massive}}, once);
  Stage stage = contact_stage(problem, state.displacement, residual_force(problem, state.displacement, state.velocity));
  stage.right_hand_side.prescribed = support_acceleration;
  stage.linearization.displacement.resize(0);  // the unknown is an acceleration
  stage.conditions.eligible = std::move(resting);
  stage.motion.reset();
  // The condition is on the sum of G a and this.
  find_curvature_term(problem, state, step, stage.conditions.gap.offset);
  stage.conditions.gap.rounding.setZero();
  evaluate_obstacle_velocity(problem, state.displacement, {}, stage);
  require_friction(problem, state.velocity, step, stage);
  StageSolution solution;
  solver->solve(0, stage, solution);
  state.acceleration = solution.increment;
  state.forces.rows = stage.rows;
  for (const Index dof : problem.massless_dofs) state.acceleration[dof] = 0.0;
  add_reactions(solution, state);
}

/// Computes support reactions from the momentum equation itself: R = M a + C V + K U − L − Gᵀ r_N + B_Tᵀ r_T.
void find_support_reaction(const SemidiscreteProblem& problem, State& state) {
  Vector force;
  problem.mass.multiply(state.acceleration, force);
  force -= residual_force(problem, state.displacement, state.velocity);
  state.forces.rows->add_force(-state.forces.normal_reaction, -state.forces.tangential_reaction, force);
  state.forces.support_reaction.resize(problem.supports.size());
  for (Index i = 0; i < problem.supports.size(); ++i) {
    state.forces.support_reaction[i] = force[problem.supports.dofs()[std::size_t(i)]];
  }
}

/// Warns of small overlaps; deeper ones are refused (model_bodies.cpp).
void warn_of_overlap(const SemidiscreteProblem& problem, const State& state) {
  const PenetratingPoints inside = initially_penetrating_points(problem, state.displacement);
  const Index points = problem.global_contact_point_count();
  if (inside.count == 0) return;
  log::warning(fmt::format(
      "at the start {} of {} {} inside an obstacle, the deepest by {:.3g}, as happens where facets approximate a "
      "curved surface: they are pushed out at once, which creates energy; move the body away by this distance",
      inside.count, counted(points, "contact point"), inside.count == 1 ? "is" : "are", inside.deepest));
}

}  // namespace

/// Warns of closed gaps between bodies: a static start moves a floating body until another one holds it. Gaps at
/// obstacles are ignored, since closing them is the purpose of static starts.
void warn_of_closed_gaps(const SemidiscreteProblem& problem, const Vector& pressed) {
  constexpr double negligible_gap = 1e-3;  // of the size of the bodies
  Vector gap;
  problem.gaps(Vector::Zero(problem.dof_count()), 0.0, gap);
  for (std::size_t contact = 0; contact < problem.obstacles.size(); ++contact) {
    if (problem.obstacles[contact] != nullptr) continue;
    double smallest = std::numeric_limits<double>::infinity();
    bool presses = false;
    for (Index i = 0; i < gap.size(); ++i) {
      if (problem.contact.pair[std::size_t(i)] != int(contact)) continue;
      smallest = std::min(smallest, gap[i]);
      presses = presses || (i < pressed.size() && pressed[i] > 0.0);
    }
    if (!presses || !(smallest > negligible_gap * enclosing_diameter(problem.nodes))) continue;
    log::warning(
        fmt::format("initial.displacement = \"static\" closes the gap of contact.{}, which is {:.3g} wide in the mesh: "
                    "it moves a body until it rests; if that body should start with a gap, omit the static start",
                    contact, smallest));
  }
}

namespace {

/// Warns of a free body that a static start moves, as a whole, by more than half of its size in the direction of the
/// motion: from far away or through an obstacle on whose wrong side it is. Bodies that supports hold deform only.
void warn_of_moved_body(const SemidiscreteProblem& problem, const std::vector<Index>& members, bool is_only_one,
                        const Vector& displacement) {
  const Index d = problem.dimension;
  SpaceVector centre = SpaceVector::Zero(d), motion = SpaceVector::Zero(d);
  for (const Index node : members) {
    centre += problem.nodes.col(node) / double(members.size());
    motion += displacement.segment(node * d, d) / double(members.size());
  }
  const double length = motion.stableNorm();
  if (!(length > 0.0)) return;
  const SpaceVector direction = motion / length;
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest, least = lowest;
  for (const Index node : members) {
    const double position = direction.dot(problem.nodes.col(node));
    lowest = std::min(lowest, position);
    highest = std::max(highest, position);
    least = std::min(least, direction.dot(displacement.segment(node * d, d)));
  }
  if (!(least > 0.5 * (highest - lowest))) return;
  log::warning(fmt::format(
      "initial.displacement = \"static\" moves {} by {:.3g}, more than half of its size in that direction, {:.3g}: it "
      "rests far from its position in the mesh; check on which side of its obstacle it starts (the normal of a plane "
      "points out of it, other shapes have a \"side\"), and place it near the position where it rests (\"move\" or "
      "\"rest_on\" of its mesh)",
      is_only_one ? "the body" : fmt::format("the body with its centre at ({:.6g})", fmt::join(centre, ", ")), length,
      highest - lowest));
}

/// Does so for each body. Single nodes are those of rigid bodies and tied ones.
void warn_of_moved_bodies(const SemidiscreteProblem& problem, const Vector& displacement) {
  std::vector<std::vector<Index>> bodies = graph_components(problem.internal_force->graph(problem.dimension));
  std::erase_if(bodies, [](const std::vector<Index>& members) { return members.size() == 1; });
  for (const std::vector<Index>& members : bodies) {
    if (!are_fixed_by_supports(problem, members))
      warn_of_moved_body(problem, members, bodies.size() == 1, displacement);
  }
}

void require_upright_cells(const SemidiscreteProblem& problem, const Vector& displacement) {
  if (problem.internal_force->is_linear()) return;
  Vector force;
  try {
    problem.internal_force->evaluate(displacement, force);
  } catch (const Error& error) {
    throw Error(ErrorKind::invalid_input, fmt::format("initial.displacement: {}", error.what()));
  }
}

/// A body that starts inside an obstacle or another body is pushed out at once, whatever the loads are: if that fails,
/// the reasons given by the search concern the result rather than the cause.
[[noreturn]] void refuse_static_from_inside(const SemidiscreteProblem& problem, const PenetratingPoints& inside,
                                            const Error& reason) {
  constexpr std::string_view key = "initial.displacement = \"static\": ";
  std::string search = reason.what();
  if (search.starts_with(key)) search.erase(0, key.size());
  const bool at_obstacle = problem.obstacles[std::size_t(inside.pair)] != nullptr;
  const bool may_be_squeezed = at_obstacle && !problem.internal_force->is_linear();
  throw Error(
      reason.kind(),
      fmt::format("initial.displacement = \"static\": without it {} of {} {} inside {}, the deepest by {:.3g} at "
                  "({:.6g}) (contact.{}), and pushing them out did not lead to an equilibrium. {}, so that they "
                  "overlap by no more than in a press fit, a fraction of a cell{}; a body that nothing presses against "
                  "another one needs a [[support]], or no static start. The search reports: {}",
                  inside.count, counted(problem.contact.size(), "contact point"), inside.count == 1 ? "is" : "are",
                  at_obstacle ? "their obstacle" : "the other body", inside.deepest, fmt::join(inside.position, ", "),
                  inside.pair,
                  at_obstacle ? "Move the obstacle or the body (a plane's normal points out of it, a sphere has a side)"
                              : "Move the bodies apart",
                  may_be_squeezed
                      ? " (an obstacle that moves slowly squeezes a body of a law of finite strain farther: "
                        "docs/laboratory.md, a slow ramp)"
                      : "",
                  search));
}

}  // namespace

StaticEquilibrium find_static_equilibrium(const SemidiscreteProblem& problem, const Vector& velocity,
                                          const StepSolverOptions& options) {
  const Vector undeformed = Vector::Zero(problem.dof_count());
  try {
    StaticEquilibrium found = problem.internal_force->is_linear()
                                  ? static_equilibrium(problem, undeformed, velocity, options)
                                  : finite_equilibrium(problem, undeformed, options);
    log::info(fmt::format("static equilibrium displaces nodes by up to {:.3g}", largest(problem, found.displacement)));
    warn_of_closed_gaps(problem, found.normal_reaction);
    warn_of_moved_bodies(problem, found.displacement);
    return found;
  } catch (const Error& reason) {
    const PenetratingPoints inside = initially_penetrating_points(problem, undeformed);
    if (inside.count == 0) throw;
    refuse_static_from_inside(problem, inside, reason);
  }
}

State make_starting_state(const SemidiscreteProblem& problem, const InitialConditions& initial, double step,
                          const StepSolverOptions& options) {
  State state;
  Vector pressed;
  if (initial.static_equilibrium) {
    StaticEquilibrium equilibrium =
        initial.found ? *initial.found : find_static_equilibrium(problem, initial.velocity, options);
    state.displacement = std::move(equilibrium.displacement);
    pressed = std::move(equilibrium.normal_reaction);
  } else {
    state.displacement = initial.displacement;
    require_upright_cells(problem, state.displacement);
  }
  state.velocity = initial.velocity;
  state.acceleration.setZero(problem.dof_count());
  state.forces.rows = problem.contact.rows;
  state.forces.normal_reaction.setZero(problem.contact.size());
  if (problem.contact.has_friction()) {
    state.forces.tangential_reaction.setZero(problem.contact.size() * (problem.dimension - 1));
  }
  state.contact_status.assign(std::size_t(problem.contact.size()), ContactStatus::open);
  Vector support_acceleration;
  apply_supports(problem, step, state, support_acceleration);
  if (!initial.static_equilibrium) warn_of_overlap(problem, state);
  if (problem.has_singular_mass()) relax_contact_nodes(problem, step, options, state);
  find_acceleration(problem, support_acceleration, pressed, step, options, state);
  find_support_reaction(problem, state);
  if (problem.loads.varies() || problem.pressure) problem.loads.varying(0.0, state.forces.varying_load);
  if (problem.pressure) problem.pressure->add_force(state.displacement, 0.0, state.forces.varying_load);
  if (problem.has_damping()) problem.damping.evaluate(state.velocity, state.forces.damping_force);
  // Bodies are assumed to have rested in their starting positions for a long time.
  if (const ViscousForce* const viscous = problem.internal_force->viscous())
    viscous->relax(state.displacement, state.internal_strain);
  return state;
}

}  // namespace ricochet
