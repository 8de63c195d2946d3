#include "ricochet/model/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/memory.hpp"
#include "ricochet/base/point_sets.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/fem/exterior_facets.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/model/model_parts.hpp"
#include "ricochet/solver/stage/memory_estimate.hpp"

namespace ricochet {

void refuse(const Case& input, const std::string& key_path, const std::string& message) {
  throw Error(ErrorKind::invalid_input, fmt::format("{}: {}", input.where(key_path).text(), message));
}

void check_length(const Case& input, const std::string& key_path, std::size_t length, int dimension) {
  if (length != 0 && int(length) != dimension) {
    refuse(input, key_path,
           fmt::format("{} has {}, but the mesh has dimension {}: write {}", key_path,
                       counted(length, "entry", "entries"), dimension, dimension));
  }
}

namespace {

/// Refuses an expression of z in two dimensions, where z would silently be 0.
void check_expression(const Case& input, const std::string& key_path, const Expression& value, int dimension) {
  if (dimension != 2 || !value.depends_on_z()) return;
  refuse(input, key_path,
         fmt::format("the expression \"{}\" depends on z, but the mesh has dimension 2", value.text()));
}

/// Also checks the number of components.
void check_expressions(const Case& input, const std::string& key_path, const std::vector<Expression>& value,
                       int dimension) {
  check_length(input, key_path, value.size(), dimension);
  for (const Expression& component : value) check_expression(input, key_path, component, dimension);
}

void check_obstacle_motion(const Case& input, const ObstacleSection& obstacle, int dimension) {
  const std::string key = "obstacle." + obstacle.name;
  check_length(input, key + ".velocity", obstacle.velocity.size(), dimension);
  check_length(input, key + ".motion", obstacle.motion.size(), dimension);
  check_length(input, key + ".about", obstacle.about.size(), dimension);
  check_length(input, key + ".centre_of_mass", obstacle.centre_of_mass.size(), dimension);
  check_length(input, key + ".force", obstacle.force.size(), dimension);
  check_length(input, key + ".spring", obstacle.spring.size(), dimension);
  check_length(input, key + ".damper", obstacle.damper.size(), dimension);
  const std::size_t spin_size = dimension == 2 ? 1 : 3;
  for (const auto& [name, size] :
       {std::pair{"inertia", obstacle.inertia.size()}, std::pair{"spin", obstacle.spin.size()},
        std::pair{"torque", obstacle.torque.size()}}) {
    if (size != 0 && size != spin_size)
      refuse(input, key + "." + name,
             fmt::format("\"{}\" has {}, but the mesh has dimension {}, where it must have {}", name,
                         counted(size, "entry", "entries"), dimension, spin_size));
  }
  const std::size_t entries = obstacle.rotation.size();
  if (entries == 0 || entries == (dimension == 2 ? 1U : 3U)) return;
  refuse(input, key + ".rotation",
         dimension == 2 ? "\"rotation\" has 3 entries, but the mesh has dimension 2, where it must be one angle: write "
                          "rotation = \"0.5*t\""
                        : "\"rotation\" is one angle, but the mesh has dimension 3, where it must be a vector: write "
                          "rotation = [\"0\", \"0\", \"0.5*t\"]");
}

}  // namespace

void check_dimensions(const Case& input, int dimension) {
  for (const CaseMeshFile& file : mesh_files(input)) check_placement(input, file, dimension);
  for (const ObstacleSection& obstacle : input.obstacles) {
    check_obstacle_motion(input, obstacle, dimension);
    for (const Key& key : obstacle_registry().find(obstacle.type).keys) {
      if (key.type != KeyType::vector || !obstacle.parameters.has(key.name)) continue;
      check_length(input, fmt::format("obstacle.{}.{}", obstacle.name, key.name),
                   obstacle.parameters.vector(key.name).size(), dimension);
    }
  }
  for (std::size_t i = 0; i < input.contacts.size(); ++i)
    check_length(input, fmt::format("contact.{}.pair_at", i), input.contacts[i].pair_at.size(), dimension);
  for (std::size_t i = 0; i < input.supports.size(); ++i) {
    for (const int component : input.supports[i].components) {
      if (component >= dimension)
        refuse(input, fmt::format("support.{}.components", i),
               "component \"z\" does not exist: the mesh has dimension 2");
    }
  }
  for (std::size_t i = 0; i < input.tractions.size(); ++i) {
    check_expressions(input, fmt::format("traction.{}.value", i), input.tractions[i].value, dimension);
  }
  for (std::size_t i = 0; i < input.pressures.size(); ++i) {
    check_expression(input, fmt::format("pressure.{}.value", i), input.pressures[i].value, dimension);
  }
  check_length(input, "load.gravity", input.load.gravity.size(), dimension);
  check_expressions(input, "load.body_force", input.load.body_force, dimension);
  check_expressions(input, "initial.displacement", input.initial.displacement, dimension);
  check_expressions(input, "initial.velocity", input.initial.velocity, dimension);
  check_motions(input, dimension);
  for (std::size_t i = 0; i < input.probes.size(); ++i) {
    const ProbeSection& probe = input.probes[i];
    for (const Key& key : probe_registry().find(probe.kind).keys) {
      if (key.type != KeyType::vector || !probe.values.has(key.name)) continue;
      check_length(input, fmt::format("probe.{}.{}", i, key.name), probe.values.vector(key.name).size(), dimension);
    }
  }
}

const Group& group_at(const Case& input, const std::string& key_path, const Mesh& mesh, const std::string& name,
                      int dimension) {
  return located(input, key_path, [&]() -> decltype(auto) { return mesh.group(name, dimension); });
}

std::vector<Index> boundary_at(const Case& input, const std::string& key_path, const Mesh& mesh,
                               const std::string& name) {
  const Group& group = group_at(input, key_path, mesh, name, mesh.dimension - 1);
  const std::vector<Index> interior = interior_facets(mesh, group.members);
  if (!interior.empty()) {
    refuse(input, key_path,
           fmt::format("group \"{}\" is not on the surface of the body: its elements {} lie between two cells", name,
                       facet_tags(mesh, interior)));
  }
  return facets_off_axis(input, key_path, mesh, group);
}

/// Reports supports at tied nodes. These supports are left out, because a tied node follows the other surface, which
/// may or may not be supported there as well.
void report_supports_at_ties(const Model& model, const std::map<Index, Expression>& dofs) {
  const int d = model.mesh.dimension;
  std::set<Index> follow, lost;
  for (const TiedNodes::Tie& tie : model.tied.ties()) {
    for (int k = 0; k < d; ++k) {
      const auto own = dofs.find(tie.node * d + k);
      if (own == dofs.end()) continue;
      const bool is_supported = std::ranges::all_of(tie.weights, [&](const auto& entry) {
        const Index dof = entry.first * d + k;
        return std::abs(entry.second) < 1e-12 ||
               (model.problem.supports.contains(dof) && model.problem.supports.expression(dof) == own->second);
      });
      (is_supported ? follow : lost).insert(tie.node);
    }
  }
  if (!follow.empty()) {
    log::info(fmt::format("{} tied to another surface, which is supported there, and {} it",
                          counted(follow.size(), "supported node is", "supported nodes are"),
                          follow.size() == 1 ? "follows" : "follow"));
  }
  if (lost.empty()) return;
  const Vector at = model.space.nodes.col(*lost.begin());
  log::warning(
      fmt::format("{} tied to another surface that does not have the same support there, and {} it: the support has no "
                  "effect there, first at ({:.6g}); support the nodes of the other surface, or make that surface "
                  "follow this one (multipliers_on)",
                  counted(lost.size(), "supported node is", "supported nodes are"),
                  lost.size() == 1 ? "follows" : "follow", fmt::join(at, ", ")));
}

void add_supports(const Case& input, Model& model) {
  constexpr std::array<const char*, 3> axes{"x", "y", "z"};
  Supports& supports = model.problem.supports;
  std::map<Index, Expression> tied;  // dofs of tied nodes, with the values that their supports prescribe
  const int d = model.mesh.dimension;
  for (std::size_t i = 0; i < input.supports.size(); ++i) {
    const SupportSection& section = input.supports[i];
    const std::string key = fmt::format("support.{}.group", i);
    const Group& group = group_at(input, key, model.mesh, section.group, d - 1);
    for (const int component : section.components) {
      for (const Index node : facet_nodes(model.space, group.members)) {
        if (model.tied.is_tied(node)) {
          tied.emplace(node * d + component, section.value);
          continue;
        }
        const Index dof = node * d + component;
        if (supports.add(dof, section.value) || supports.expression(dof) == section.value) continue;
        refuse(input, key,
               fmt::format("support of group \"{}\" prescribes {} of a node that another support prescribes as \"{}\"; "
                           "a node can follow only one of them",
                           section.group, axes[std::size_t(component)], supports.expression(dof).text()));
      }
    }
  }
  add_axis_supports(input, model);
  support_free_bodies(input, model);
  supports.finish();
  report_supports_at_ties(model, tied);
}

void add_initial_conditions(const Case& input, Model& model) {
  const int d = model.mesh.dimension;
  const auto evaluate = [&](const std::vector<Expression>& value, const std::string& key) {
    Vector result = Vector::Zero(model.space.dof_count());
    if (value.empty()) return result;
    located(input, key, [&] {
      for (Index node = 0; node < model.space.node_count(); ++node) {
        const auto at = model.space.nodes.col(node);
        for (int k = 0; k < d; ++k) {
          result[node * d + k] = value[std::size_t(k)](at[0], at[1], d == 3 ? at[2] : 0.0, 0.0);
        }
      }
    });
    return result;
  };
  model.initial.static_equilibrium = input.initial.static_equilibrium;
  model.initial.displacement = evaluate(input.initial.displacement, "initial.displacement");
  model.initial.velocity = evaluate(input.initial.velocity, "initial.velocity");
}

namespace {

/// Returns true if a second-order node deviates from the mean of its vertices by more than rounding.
bool is_curved(const Mesh& mesh) {
  if (mesh.degree == 1) return false;
  for (const CellBlock& block : mesh.cells) {
    const std::vector<std::vector<int>>& vertices = node_vertices(block.shape, 2);
    for (Index cell = 0; cell < block.size(); ++cell) {
      const Index* nodes = block.cell(cell);
      const double size = (mesh.nodes.col(nodes[1]) - mesh.nodes.col(nodes[0])).norm();
      for (std::size_t k = 0; k < vertices.size(); ++k) {
        Vector mean = Vector::Zero(mesh.dimension);
        for (const int vertex : vertices[k]) mean += mesh.nodes.col(nodes[vertex]);
        mean /= double(vertices[k].size());
        if ((mesh.nodes.col(nodes[k]) - mean).norm() > 1e-9 * size) return true;
      }
    }
  }
  return false;
}

}  // namespace

std::unique_ptr<Scheme> make_scheme(const TimeSection& time) {
  return make_scheme(time.scheme, time.step, time.parameters);
}

std::optional<StepControlOptions> step_control_options(const TimeSection& time) {
  if (!time.adaptive) return std::nullopt;
  return StepControlOptions{time.end, time.step, time.smallest, time.tolerance};
}

std::string steps_text(const TimeSection& time) {
  if (time.adaptive) return fmt::format("adaptive steps of at most {:g}", time.step);
  return fmt::format("{} of {:g}", counted(step_count(time), "step"), time.step);
}

StepSolverOptions step_solver_options(const Case& input) {
  StepSolverOptions options;
  if (input.solver.method == "direct") options.method = SolverMethod::direct;
  if (input.solver.method == "iterative") options.method = SolverMethod::iterative;
  options.tolerance = input.solver.tolerance;
  options.newton_tolerance = input.solver.newton_tolerance;
  options.memory = 1e9 * input.solver.memory.value_or(0.0);
  options.preconditioner = input.solver.preconditioner;
  options.all_points = input.solver.contact_points == "all";
  options.solves = step_count(input.time);
  return options;
}

std::string scheme_text(const TimeSection& time) {
  std::string numbers;
  for (const auto& [name, value] : time.parameters.values()) {
    const auto* const number = std::get_if<double>(&value);
    if (number != nullptr) numbers += fmt::format("{}{} {:g}", numbers.empty() ? "" : ", ", name, *number);
  }
  return numbers.empty() ? time.scheme : fmt::format("{} ({})", time.scheme, numbers);
}

namespace {

void warn_of_memory(const Model& model) {
  const double needed = memory_of_iterations(model.space.dof_count()), there = physical_memory();
  if (needed <= there) return;
  log::warning(
      fmt::format("{} need about {:.3g} GB, but this machine has {:.3g} GB: use `ricochet-mpi` to divide the body "
                  "among several machines (docs/distributed.md)",
                  counted(model.space.dof_count(), "dof"), 1e-9 * needed, 1e-9 * there));
}

std::unique_ptr<Model> build(const Case& input, bool with_forces, BuildTimes* times) {
  auto model = std::make_unique<Model>();
  Timer timer;
  require_mesh_files(input);
  std::vector<NamedMesh> files = read_mesh_files(input);
  const double read_seconds = timer.restart();
  check_dimensions(input, files.front().mesh.dimension);
  check_axisymmetry(input, files.front().mesh.dimension);
  make_obstacles(input, *model, files.front().mesh.dimension);
  model->mesh = merge_meshes(input, *model, std::move(files));
  place_on_axis(input, model->mesh);
  complete_groups(input, model->mesh);
  model->space = make_displacement_space(model->mesh, input.mesh.degree);
  if (with_forces) warn_of_memory(*model);
  model->contains_rotations = input.mesh.degree > 1 || !is_curved(model->mesh);
  if (is_axisymmetric(input)) {
    model->contains_rotations = false;
  } else if (!model->contains_rotations) {
    log::warning(
        "the mesh has curved cells but the displacement is of degree 1: on curved cells its functions do not contain "
        "rigid rotations, so angular momentum is conserved only to the order h²; use mesh.degree = 2 or a straight "
        "mesh");
  }
  model->problem.dimension = model->mesh.dimension;
  assign_materials(input, *model);
  collect_contacts(input, *model);
  add_free_bodies(input, *model);
  add_ties(input, *model);
  model->problem.nodes = model->space.nodes;
  add_supports(input, *model);
  add_contacts(input, *model);
  double model_seconds = timer.restart();
  assemble_operators(input, *model, with_forces);
  const double assembly_seconds = timer.restart();
  add_loads(input, *model);
  add_initial_conditions(input, *model);
  add_motions(input, *model);
  start_free_bodies(input, *model);
  warn_of_torn_ties(*model);
  check_body_overlaps(input, *model);
  check_obstacles(input, *model);
  model->bodies = describe_bodies(model->body);
  add_standing_columns(input, *model);
  find_probes(input, *model);
  add_sensors(input, *model);
  model->sizes = {model->space.cell_node_count(), model->mesh.cell_count(),
                  model->space.dof_count(),       model->problem.contact.size(),
                  model->problem.supports.size(), enclosing_diameter(model->mesh.nodes)};
  model->rotation = std::make_unique<CellRotations>(model->body);
  model_seconds += timer.restart();
  if (times != nullptr) *times = {read_seconds, model_seconds, assembly_seconds};
  return model;
}

}  // namespace

std::unique_ptr<Model> build_model(const Case& input, BuildTimes* times) { return build(input, true, times); }

std::unique_ptr<Model> build_model_without_forces(const Case& input, BuildTimes* times) {
  return build(input, false, times);
}

}  // namespace ricochet
