#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/rounded.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/fem/cell_masses.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/mass/mass_conditions.hpp"
#include "ricochet/model/model_parts.hpp"
#include "ricochet/problem/finite_elasticity.hpp"
#include "ricochet/scheme/requirements.hpp"
#include "ricochet/solver/step_solver.hpp"

namespace ricochet {

namespace {

void warn_of_creep(const Case& input, const Scheme& scheme, const SemidiscreteProblem& problem) {
  if (!scheme.traits().stuck_nodes_alternate || problem.has_singular_mass() || !problem.contact.has_friction()) return;
  log::warning(
      fmt::format("{} with friction and mass \"{}\": nodes that stick keep their velocity with alternating sign, their "
                  "forces oscillate and slips are wrong; use mass \"equivalent\"",
                  scheme_text(input.time), input.mass.type));
}

void warn_of_long_steps(const Case& input, const Scheme& scheme, const Model& model) {
  if (model.problem.contact.size() == 0) return;
  const LongSteps limit = scheme.traits_for(model.problem).long_steps;
  if (limit.consequence.empty()) return;
  const std::vector<double> times = cell_crossing_times(model.body);
  const double median = times[times.size() / 2], crossings = input.time.step / median;
  if (!(crossings > limit.courant_limit)) return;
  const std::string remedy =
      limit.shorter_steps_help
          ? fmt::format(
                "use a step of at most {:.2g}, or scheme \"reduced-kane\" with mass \"equivalent\", which "
                "accepts any step",
                rounded_down(limit.courant_limit * median, 2))
          : "use scheme \"reduced-kane\" with mass \"equivalent\", which accepts any step";
  log::warning(
      fmt::format("{}: in time.step = {:.3g} a compression wave crosses a median cell {:.3g} times; with {}, at more "
                  "than {:g} per step, {}; {}",
                  input.where("time.step").text(), input.time.step, crossings, scheme_text(input.time),
                  limit.courant_limit, limit.consequence, remedy));
}

/// Warns of a body of degree 1 most of whose nodes are on its contact boundary: few are left inside to carry the
/// inertia of those. The spin that friction gives a ball was wrong by 19 % with 405 contact nodes of 858, by 2.5 % with
/// 1,250 of 3,525.
void warn_of_few_interior_nodes(const Model& model, std::size_t contact_nodes) {
  constexpr double most = 0.4;
  const Index nodes = model.space.node_count();
  const bool is_thin = model.space.degree == 1 && double(contact_nodes) > most * double(nodes);
  if (!is_thin || !model.problem.has_singular_mass() || !model.problem.contact.has_friction()) return;
  log::warning(fmt::format(
      "{} of {} nodes are contact nodes, whose inertia mass \"{}\" moves to nodes off the contact "
      "boundary: on such a coarse mesh the motion along the obstacle and the spin caused by friction can be "
      "wrong by tens of per cent; name only facets that may touch in the contact group, refine the mesh, or "
      "set mesh.degree = 2",
      contact_nodes, nodes, model.mass_built));
}

/// Warns if few massive nodes carry the inertia of many contact nodes: a thin tube with contact on both of its faces
/// left its obstacle with e = 0.78 instead of 0.98 when 8·10⁴ times the inertia accumulated on some nodes.
void warn_of_concentrated_inertia(const Case& input, const std::string& built, const SparseMatrix& mass,
                                  const Vector& diagonal) {
  constexpr double most = 100.0;
  const double top = top_eigenvalue(mass, diagonal);
  if (top <= most) return;
  log::warning(fmt::format(
      "mass \"{}\" concentrates up to {:.2g} times the original inertia on nodes off the contact boundary, which are "
      "few or far away: vibrations of this body and its restitution can be wrong by tens of per cent; {}refine the "
      "mesh, set mesh.degree = 2, or name only facets that may touch in the contact group",
      built, top,
      built == input.mass.type ? "check whether mass \"equivalent\" selects a construction that does not, " : ""));
}

/// Returns the steps at which the velocity of a prescribed displacement jumps. A jump is a second difference that
/// exceeds those two steps before and after it. (A corner between two steps contributes to both.)
std::vector<long> find_jumps(const std::function<double(long)>& value, long steps) {
  constexpr double sharp = 0.25;      // relative to the largest velocity
  constexpr double prominence = 4.0;  // a sine stays below this from ten steps per period on
  std::array<double, 5> bend{};       // second differences; the middle one belongs to the step in question
  double fastest = 0.0, earlier = value(1) - value(0);
  std::vector<std::pair<long, double>> found;
  for (long step = 1; step < steps + 2; ++step) {
    std::rotate(bend.begin(), bend.begin() + 1, bend.end());
    const double increment = step < steps ? value(step + 1) - value(step) : earlier;
    bend.back() = std::abs(increment - earlier);
    fastest = std::max({fastest, std::abs(increment), std::abs(earlier)});
    earlier = increment;
    const bool is_sharp = bend[2] > sharp * fastest && bend[2] > prominence * std::max(bend[0], bend[4]);
    if (!is_sharp) continue;
    if (found.empty() || found.back().first < step - 3) {
      found.emplace_back(step - 2, bend[2]);
    } else if (bend[2] > found.back().second) {
      found.back() = {step - 2, bend[2]};
    }
  }
  std::vector<long> result;
  for (const auto& [step, jump] : found) {
    if (jump > sharp * fastest) result.push_back(step);
  }
  return result;
}

/// Warns of a prescribed displacement whose velocity jumps: without numerical damping, the velocity of its nodes then
/// alternates by ±(half of the jump) from step to step.
void warn_of_jumping_supports(const Case& input, const Scheme& scheme) {
  const TimeSection& time = input.time;
  const JumpResponse response = scheme.traits().jump_response;
  if (response == JumpResponse::damped) return;
  constexpr long most_instants = 2'000'000;
  for (std::size_t i = 0; i < input.supports.size(); ++i) {
    const SupportSection& section = input.supports[i];
    if (!section.value.depends_on_time()) continue;
    const std::vector<long> jumps =
        find_jumps([&](long step) { return section.value(0.0, 0.0, 0.0, double(step) * time.step); },
                   std::min(step_count(time), most_instants));
    if (jumps.empty()) continue;
    log::warning(fmt::format(
        "{}: the velocity of this support jumps at t = {:.6g}{}. {} keeps such a jump from step to step with "
        "alternating sign in the support's force, which {}; make the motion smooth, for example with "
        "0.5*(1-cos(pi*min(t/T, 1))), and resolve it with at least ten steps, or do not use the forces of this support",
        input.where(fmt::format("support.{}.value", i)).text(), double(jumps.front()) * time.step,
        jumps.size() > 1 ? fmt::format(" (and {} later)", counted(jumps.size() - 1, "time")) : "", scheme_text(time),
        response == JumpResponse::unstable ? "grows with every step" : "is the larger the shorter the step"));
  }
}

bool is_any_positive(const std::vector<double>& values) {
  return std::ranges::any_of(values, [](double value) { return value > 0.0; });
}

/// Refuses stiffness damping at finite strain: the forces Cη U̇ do not vanish for a rotating body.
void refuse_stiffness_damping(const Case& input, const Model& model) {
  for (std::size_t i = 0; i < model.body.materials.size(); ++i) {
    if (model.body.materials[i].stiffness_damping == 0.0) continue;
    refuse(input, fmt::format("material.{}.damping.stiffness", i),
           "stiffness damping resists rotations that are not small, and a material of this case has a law of finite "
           "strain: set it to 0");
  }
}

}  // namespace

void assemble_forces(const Case& input, Model& model) {
  const NodeGraph graph = node_graph(model.space);
  const int d = model.mesh.dimension;
  const auto stiffness = [&](const std::vector<double>& weight) {
    SparseMatrix matrix = assemble_stiffness(model.body, graph, weight);
    return model.tied.empty() ? matrix : model.tied.condense(matrix, d);
  };
  if (has_finite_strain(model.body)) {
    refuse_stiffness_damping(input, model);
    model.problem.internal_force = std::make_shared<FiniteElasticity>(model.body, graph);
  } else {
    model.problem.internal_force = std::make_shared<LinearElasticity>(stiffness({}), model.space.nodes);
  }
  std::vector<double> damping;
  for (const Material& material : model.body.materials) damping.push_back(material.stiffness_damping);
  if (is_any_positive(damping)) model.problem.damping.set_stiffness_part(stiffness(damping), model.space.nodes);
}

void assemble_operators(const Case& input, Model& model, bool with_forces) {
  const NodeGraph graph = node_graph(model.space);
  const int d = model.mesh.dimension;
  const auto condensed = [&](SparseMatrix matrix, int components) {
    return model.tied.empty() ? matrix : model.tied.condense(matrix, components);
  };
  // Rigid bodies have no cells, so that masses are built without their nodes.
  const Index own_nodes = model.problem.cell_node_count();
  const auto scalar_mass = [&](const std::vector<double>& weight) {
    SparseMatrix result = condensed(assemble_scalar_mass(model.body, graph, weight), 1);
    result.conservativeResize(own_nodes, own_nodes);
    return result;
  };
  const SparseMatrix consistent = scalar_mass({});
  const Points own_positions = model.space.nodes.leftCols(own_nodes);
  MassInput mass_input{&consistent, &own_positions, model.problem.contact.unique_nodes(), &consistent};
  MassChoice choice;
  const auto with_cells = [&](const SparseMatrix& from, const std::vector<double>& weight, const auto& make) {
    const CellMasses cells(model.body, weight);
    mass_input.consistent = &from;
    mass_input.cells = &cells;
    try {
      return make();
    } catch (const Error& problem) {
      const bool is_chosen = !choice.name.empty() && choice.name != input.mass.type;
      refuse(input, "mass.type",
             is_chosen ? fmt::format("\"{}\" selects one of several masses: {}", input.mass.type, problem.what())
                       : std::string(problem.what()));
    }
  };
  choice =
      with_cells(consistent, {}, [&] { return mass_to_build(input.mass.type, input.mass.parameters, mass_input); });
  model.mass_built = choice.name;
  const bool has_massless_contact = mass_registry().find(choice.name).type.removes_contact_inertia;
  const auto build = [&](const SparseMatrix& from, const std::vector<double>& weight = {}) {
    return with_cells(from, weight, [&] { return build_mass(choice.name, mass_input, choice.parameters); });
  };
  if (!choice.mass) choice.mass = build(consistent);
  if (!choice.reason.empty()) {
    log::info(fmt::format("the mass \"{}\" of {} contact nodes is built as \"{}\": {}", input.mass.type,
                          mass_input.contact_nodes.size(), choice.name, choice.reason));
  }
  if (has_massless_contact) warn_of_concentrated_inertia(input, choice.name, *choice.mass, consistent.diagonal());
  finish_problem(model.problem, with_free_bodies(model, expand_to_components(*choice.mass, d)), has_massless_contact);
  choice.mass.reset();
  if (with_forces) {
    assemble_forces(input, model);
  } else {
    model.problem.internal_force = std::make_shared<LinearElasticity>(
        SparseMatrix(model.space.dof_count(), model.space.dof_count()), model.space.nodes);
  }
  std::vector<double> mass_damping;
  for (const Material& material : model.body.materials) mass_damping.push_back(material.mass_damping);
  if (is_any_positive(mass_damping))
    model.problem.damping.set_mass_part(
        resized(expand_to_components(build(scalar_mass(mass_damping), mass_damping), d), model.space.dof_count()),
        model.space.nodes);
  add_ground(input, model);
  const std::unique_ptr<Scheme> scheme = make_scheme(input.time);
  if (!model.problem.internal_force->is_linear() && !scheme->traits().supports_nonlinear_force) {
    refuse(input, "time.scheme",
           fmt::format("scheme \"{}\" requires the linear material law; \"reduced-kane\", the default, also supports "
                       "laws of finite strain, and so does \"semi-explicit\"",
                       input.time.scheme));
  }
  if (!model.problem.free_bodies.empty() && !scheme->traits().supports_free_bodies) {
    refuse(
        input, "time.scheme",
        fmt::format("scheme \"{}\" does not support rigid bodies that move freely; \"reduced-kane\", the default, does",
                    input.time.scheme));
  }
  require_relaxation(*scheme, model.problem,
                     fmt::format("{}: scheme \"{}\"", input.where("time.scheme").text(), input.time.scheme));
  if (input.time.adaptive) {
    require_changing_steps(*scheme,
                           fmt::format("{}: scheme \"{}\"", input.where("time.step").text(), input.time.scheme));
    warn_of_brief_changes(input, model.space.nodes.rowwise().mean());
  }
  warn_of_creep(input, *scheme, model.problem);
  if (!input.time.adaptive) warn_of_long_steps(input, *scheme, model);
  warn_of_few_interior_nodes(model, mass_input.contact_nodes.size());
  warn_of_jumping_supports(input, *scheme);
}

namespace {

/// Adds a force per area or volume whose components depend on time alone: one pattern per component, times its
/// amplitude.
void add_uniform(const std::vector<Expression>& value,
                 const std::function<void(const ForceDensity&, Vector&)>& integrate, Loads& loads, Index dofs) {
  for (std::size_t k = 0; k < value.size(); ++k) {
    if (value[k].is_constant() && value[k](0.0, 0.0, 0.0, 0.0) == 0.0) continue;
    Vector pattern = Vector::Zero(dofs);
    integrate([k](const Vector&, Vector& force) { force = Vector::Unit(force.size(), Index(k)); }, pattern);
    if (value[k].is_constant()) {
      loads.add_constant(value[k](0.0, 0.0, 0.0, 0.0) * pattern);
    } else {
      loads.add_separable(std::move(pattern), value[k]);
    }
  }
}

void add_force(const std::vector<Expression>& value, const std::function<void(const ForceDensity&, Vector&)>& integrate,
               Loads& loads, Index dofs) {
  const auto any = [&](auto property) { return std::ranges::any_of(value, property); };
  const bool varies_in_time = any([](const Expression& e) { return e.depends_on_time(); });
  if (!any([](const Expression& e) { return e.depends_on_position(); }))
    return add_uniform(value, integrate, loads, dofs);
  const auto add = [value, integrate](double time, Vector& load) {
    integrate(
        [&](const Vector& x, Vector& force) {
          for (Index k = 0; k < force.size(); ++k)
            force[k] = value[std::size_t(k)](x[0], x[1], x.size() == 3 ? x[2] : 0.0, time);
        },
        load);
  };
  if (varies_in_time) {
    loads.add_general(add);
    return;
  }
  Vector load = Vector::Zero(dofs);
  add(0.0, load);
  loads.add_constant(load);
}

/// Adds a pressure as the dead load of the initial configuration, as the tangent is constant.
void add_dead_pressure(const FollowerPressure& pressure, const Expression& value, Loads& loads, Index dofs) {
  if (value.depends_on_time()) {
    loads.add_general([pressure](double time, Vector& load) { pressure.add_force(Vector(), time, load); });
    return;
  }
  Vector load = Vector::Zero(dofs);
  pressure.add_force(Vector(), 0.0, load);
  loads.add_constant(load);
}

void add_pressures(const Case& input, Model& model) {
  const bool follows = !model.problem.internal_force->is_linear();
  const auto all = std::make_shared<FollowerPressure>(model.body);
  for (std::size_t i = 0; i < input.pressures.size(); ++i) {
    const PressureSection& section = input.pressures[i];
    const std::vector<Index> facets =
        boundary_at(input, fmt::format("pressure.{}.group", i), model.mesh, section.group);
    FollowerPressure own(model.body);
    own.add(facets, section.value);
    located(input, fmt::format("pressure.{}.value", i), [&] {
      // An invalid value is reported with its location.
      Vector load = Vector::Zero(model.space.dof_count());
      own.add_force(Vector(), 0.0, load);
      if (!follows) add_dead_pressure(own, section.value, model.problem.loads, model.space.dof_count());
    });
    if (follows) all->add(facets, section.value);
  }
  if (!all->empty()) model.problem.pressure = all;
}

}  // namespace

void add_loads(const Case& input, Model& model) {
  const int d = model.mesh.dimension;
  const Index dofs = model.space.dof_count();
  Loads& loads = model.problem.loads = Loads(dofs);
  if (!input.load.gravity.empty()) {
    // Gravity acts on the mass as it is distributed: the load is M₀ times the uniform acceleration. A body in free fall
    // therefore stays undeformed with every mass construction, and weight and its moments are those of the body.
    Vector acceleration(dofs);
    for (Index i = 0; i < dofs; ++i) {
      const bool is_rotation = model.problem.is_rotation_node(i / d);
      acceleration[i] = is_rotation ? 0.0 : input.load.gravity[std::size_t(i % d)];
    }
    Vector weight;
    model.problem.mass.multiply(acceleration, weight);
    loads.add_constant(weight);
  }
  add_forces_on_free_bodies(input, model);
  const Body& body = model.body;
  const TiedNodes& tied = model.tied;
  located(input, "load.body_force", [&] {
    if (!input.load.body_force.empty()) {
      add_force(
          input.load.body_force,
          [&body, &tied, d](const ForceDensity& f, Vector& load) {
            add_body_load(body, f, load);
            tied.condense_load(load, d);
          },
          loads, dofs);
    }
  });
  for (std::size_t i = 0; i < input.tractions.size(); ++i) {
    const std::vector<Index> facets =
        boundary_at(input, fmt::format("traction.{}.group", i), model.mesh, input.tractions[i].group);
    located(input, fmt::format("traction.{}.value", i), [&] {
      add_force(
          input.tractions[i].value,
          [&body, &tied, d, facets](const ForceDensity& f, Vector& load) {
            add_facet_load(body, facets, f, load);
            tied.condense_load(load, d);
          },
          loads, dofs);
    });
  }
  add_pressures(input, model);
}

}  // namespace ricochet
