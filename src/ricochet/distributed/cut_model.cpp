#include "ricochet/distributed/cut_model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/memory.hpp"
#include "ricochet/base/selection.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/contact/contact_surface.hpp"
#include "ricochet/distributed/cut_problem.hpp"
#include "ricochet/distributed/model_message.hpp"
#include "ricochet/distributed/mpi_ranks.hpp"
#include "ricochet/distributed/petsc_preconditioner.hpp"
#include "ricochet/fem/assembly.hpp"
#include "ricochet/model/model_parts.hpp"

namespace ricochet {

namespace {

/// Data that must live as long as a rank's model.
struct RankData {
  RankData(const Communicator& ranks, const std::vector<std::int64_t>& numbers, Index count)
      : nodes(ranks, numbers, count), as_ranks(ranks, nodes) {}
  NodeExchange nodes;
  MpiRanks as_ranks;
};

/// Returns facets of cells with their numbers in the blocks of the piece.
std::vector<CellFacet> cut_facets(const std::vector<CellFacet>& facets, const std::vector<CellBlock>& global,
                                  const std::vector<CellBlock>& own, const std::vector<Index>& cell_number) {
  std::vector<Index> first_of_global(1, 0), first_of_own(1, 0);
  for (const CellBlock& block : global) first_of_global.push_back(first_of_global.back() + block.size());
  for (const CellBlock& block : own) first_of_own.push_back(first_of_own.back() + block.size());
  std::vector<CellFacet> result;
  for (const CellFacet& facet : facets) {
    const Index index = index_in(cell_number, first_of_global[facet.block] + facet.cell);
    if (index >= 0) result.push_back({facet.block, index - first_of_own[facet.block], facet.local});
  }
  return result;
}

void cut_bodies(const BodiesOfMesh& global, const Model& global_model, const Piece& piece, BodiesOfMesh& own) {
  own = global;
  own.connected.of_node = chosen(global.connected.of_node, piece.node_number);
  own.connected.of_cell = chosen(global.connected.of_cell, piece.cell_number);
  own.boundary = cut_facets(global.boundary, global_model.space.cells, piece.space.cells, piece.cell_number);
}

void cut_probe_targets(const std::vector<ProbeTargets>& global, const Piece& piece, const ContactBoundary& contact,
                       const ContactBoundary& own, std::vector<ProbeTargets>& result) {
  result = global;
  for (ProbeTargets& targets : result) {
    targets.nodes = indices_in(targets.nodes, piece.node_number);
    for (Probe& probe : targets.probes) {
      const Index node = probe.node, entry = probe.contact_node;
      probe.node = index_in(piece.node_number, node);
      if (probe.node < 0 || entry < 0) continue;
      // Entries keep their order, so that the offset among the entries of the node is unchanged.
      const auto first = std::ranges::find(contact.nodes, node) - contact.nodes.begin();
      probe.contact_node = std::ranges::find(own.nodes, probe.node) - own.nodes.begin() + (entry - first);
    }
  }
}

/// Keeps the data that are needed to write the mesh; the whole body on the first rank only.
std::unique_ptr<const Model::GlobalOutput> make_global_output(Model& global, const Piece& piece, int rank) {
  auto result = std::make_unique<Model::GlobalOutput>();
  result->node_rows = piece.space.number;
  result->cell_rows = piece.cell_number;
  if (rank != 0) return result;
  result->space = std::move(global.space);
  result->body = global.body;
  result->body.mesh = nullptr;
  result->body.space = &result->space;
  result->problem.dimension = global.problem.dimension;
  result->problem.nodes = result->space.nodes;
  result->problem.obstacles = global.problem.obstacles;
  result->problem.contact.facets = global.problem.contact.facets;
  return result;
}

/// Cuts the part of a rank. The first rank is cut last and takes over data of the whole.
ModelPart cut_model(Model& global, const Division& division, int rank) {
  Piece piece = cut_piece(global.mesh, global.space, division.rank_of_cell(), rank, division.more_nodes(rank));
  ModelPart part;
  part.node_number = piece.node_number;
  part.all_nodes = global.space.node_count();
  for (const auto& obstacle : global.obstacles) part.obstacles.push_back(obstacle.get());
  part.model = std::make_unique<Model>();
  Model& model = *part.model;
  model.problem = cut_problem(global.problem, division, piece, rank);
  if (const NodeMatrix* damping = global.problem.damping.mass_part(); damping != nullptr)
    model.problem.damping.set_mass_part(cut_matrix(*damping, division, piece, rank), model.problem.nodes);
  model.sizes = global.sizes;
  model.mass_built = global.mass_built;
  model.contains_rotations = global.contains_rotations;
  model.initial.static_equilibrium = global.initial.static_equilibrium;
  model.initial.displacement = cut_values(global.initial.displacement, piece, global.problem.dimension);
  model.initial.velocity = cut_values(global.initial.velocity, piece, global.problem.dimension);
  if (global.initial.found) {
    model.initial.found = {cut_values(global.initial.found->displacement, piece, global.problem.dimension),
                           chosen(global.initial.found->normal_reaction, division.points_of(rank))};
  }
  model.history_bodies.labels = global.history_bodies.labels;
  model.history_bodies.of_node = chosen(global.history_bodies.of_node, piece.node_number);
  cut_bodies(global.bodies, global, piece, model.bodies);
  cut_probe_targets(global.probe_targets, piece, global.problem.contact, model.problem.contact, model.probe_targets);
  model.contact_scales = global.contact_scales;
  model.contacts = global.contacts;
  for (ModelContact& contact : model.contacts) contact.facets.clear();
  model.contact_pairs = global.contact_pairs;
  for (ContactPair& pair : model.contact_pairs) pair.facets = indices_in(pair.facets, piece.facet_number);
  model.pair_facings = global.pair_facings;
  model.body = global.body;
  model.body.tied = nullptr;
  model.body.cell_material = chosen(global.body.cell_material, piece.cell_number);
  model.global_output = make_global_output(global, piece, rank);
  if (rank == 0) model.obstacles = std::move(global.obstacles);
  // The part numbers its own nodes only.
  std::iota(piece.space.number.begin(), piece.space.number.end(), Index{0});
  model.mesh = std::move(piece.mesh);
  model.space = std::move(piece.space);
  model.body.mesh = &model.mesh;
  model.body.space = &model.space;
  return part;
}

/// Finds the equilibrium on this process alone, before the body is divided, which takes the memory of the whole body.
void find_equilibrium(const Case& input, Model& global) {
  const std::shared_ptr<const InternalForce> none = global.problem.internal_force;
  const Damping by_mass = global.problem.damping;
  assemble_forces(input, global);
  global.initial.found = find_static_equilibrium(global.problem, global.initial.velocity, step_solver_options(input));
  global.problem.internal_force = none;
  global.problem.damping = by_mass;
  release_freed_memory();
}

void report_small_parts(const Model& global, int processes) {
  constexpr Index few = 5000;  // dofs of a part
  const Index each = global.space.dof_count() / processes;
  if (each >= few) return;
  log::info(
      fmt::format("each process has about {} dofs: with fewer than 50,000 several processes gain little, and with so "
                  "few one process is usually faster",
                  each));
}

/// Sends each rank its part of the whole, which the first rank has.
ModelPart scatter_parts(const Case& input, std::unique_ptr<Model> global, std::optional<Division> division,
                        const Communicator& ranks) {
  if (ranks.rank() > 0) return unpack(input, ranks.receive(0));
  for (int rank = 1; rank < ranks.size(); ++rank) {
    ModelPart part = cut_model(*global, *division, rank);
    pack(input, part, [&](std::span<const char> bytes) {
      if (!bytes.empty()) ranks.send(rank, bytes);
    });
    ranks.send(rank, {});
  }
  return cut_model(*global, *division, 0);
}

// Features that cases on several processes do not support yet are refused at their location in the case, with a remedy.

[[noreturn]] void refuse_several(const Case& input, const std::string& key, const std::string& what) {
  refuse(input, key, what + " cannot be run by several processes yet: use `ricochet run`, on one machine");
}

void refuse_undividable_case(const Case& input) {
  if (input.solver.method == "direct") {
    refuse(input, "solver.method",
           "several processes solve steps by iterations, without a factor of the whole body: set solver.method = "
           "\"iterative\" or remove it, or use `ricochet run`");
  }
  for (std::size_t i = 0; i < input.contacts.size(); ++i) {
    const ContactSection& contact = input.contacts[i];
    if (contact.between_bodies())
      refuse_several(input, fmt::format("contact.{}.{}", i, contact.is_of_all_pairs() ? "group" : "against"),
                     "contact between bodies");
  }
  for (const ObstacleSection& obstacle : input.obstacles) {
    if (obstacle.is_free())
      refuse_several(input, "obstacle." + obstacle.name, "an obstacle that moves under the forces on it");
  }
  // These fields need cells of other processes.
  for (const std::string& name : input.output.fields) {
    if (name.starts_with("nodal_") || name == "all")
      refuse_several(input, "output.fields",
                     fmt::format("the field \"{}\"{}", name, name == "all" ? ", with stresses at nodes," : ""));
  }
  if (!make_scheme(input.time)->traits().supports_ranks)
    refuse_several(input, "time.scheme", fmt::format("scheme \"{}\"", input.time.scheme));
}

void refuse_undividable_model(const Case& input, const Model& global, int processes) {
  if (has_finite_strain(global.body)) refuse_several(input, "material", "a body at finite strain");
  if (global.bodies.connected.count > 1) {
    refuse_several(input, input.parts.empty() ? "mesh.file" : "part",
                   fmt::format("{} bodies, which nothing would keep from passing through each other,",
                               global.bodies.connected.count));
  }
  if (const Index cells = global.mesh.cell_count(); cells < processes)
    refuse(input, "mesh.file",
           fmt::format("the mesh has {}, too few for {}: use fewer", counted(cells, "cell"),
                       counted(processes, "process", "processes")));
}

}  // namespace

std::unique_ptr<Model> build_divided_model(const Case& input, const Communicator& ranks, const DivisionOptions& options,
                                           BuildTimes* times) {
  // All ranks initialize PETSc together; the first then divides the mesh with it.
  const std::shared_ptr<const PreconditionerFactory> preconditioners = make_petsc_preconditioners();
  if (ranks.size() == 1) {
    std::unique_ptr<Model> model = build_model(input, times);
    model->preconditioners = preconditioners;
    return model;
  }
  refuse_undividable_case(input);
  std::unique_ptr<Model> global;
  std::optional<Division> division;
  WorldRanks(ranks).run_collectively([&] {
    if (ranks.rank() > 0) return;
    global = build_model_without_forces(input, times);
    refuse_undividable_model(input, *global, ranks.size());
    report_small_parts(*global, ranks.size());
    if (global->initial.static_equilibrium) find_equilibrium(input, *global);
    division.emplace(global->space, global->problem,
                     partition_cells(global->mesh, ranks.size(), options.method, options.seed));
  });
  Timer timer;
  ModelPart part = scatter_parts(input, std::move(global), std::move(division), ranks);
  std::unique_ptr<Model> model = std::move(part.model);
  auto rank_data = std::make_shared<RankData>(ranks, part.node_number, part.all_nodes);
  model->problem.ranks = &rank_data->as_ranks;
  model->rank_data = rank_data;
  release_freed_memory();
  if (times != nullptr) times->model += timer.restart();
  assemble_forces(input, *model);
  release_freed_memory();
  if (times != nullptr) times->assembly += timer.restart();
  add_loads(input, *model);
  // For its own facets, as the surface of the whole was not sent.
  ContactBoundary& contact = model->problem.contact;
  contact.surface = std::make_shared<const ContactSurface>(model->body, model->contact_pairs, contact);
  add_sensors(input, *model);
  model->rotation = std::make_unique<CellRotations>(model->body);
  model->preconditioners = preconditioners;
  if (times != nullptr) times->model += timer.seconds();
  return model;
}

}  // namespace ricochet
