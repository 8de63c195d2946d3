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
#include "ricochet/distributed/refusals.hpp"
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
std::vector<CellFacet> cut_facets(const std::vector<CellFacet>& facets, const std::vector<CellBlock>& whole,
                                  const std::vector<CellBlock>& own, const std::vector<Index>& cell_number) {
  std::vector<Index> first_of_whole(1, 0), first_of_own(1, 0);
  for (const CellBlock& block : whole) first_of_whole.push_back(first_of_whole.back() + block.size());
  for (const CellBlock& block : own) first_of_own.push_back(first_of_own.back() + block.size());
  std::vector<CellFacet> result;
  for (const CellFacet& facet : facets) {
    const Index place = index_in(cell_number, first_of_whole[facet.block] + facet.cell);
    if (place >= 0) result.push_back({facet.block, place - first_of_own[facet.block], facet.local});
  }
  return result;
}

void cut_bodies(const BodiesOfMesh& whole, const Model& whole_model, const Piece& piece, BodiesOfMesh& own) {
  own = whole;
  own.connected.of_node = chosen(whole.connected.of_node, piece.node_number);
  own.connected.of_cell = chosen(whole.connected.of_cell, piece.cell_number);
  own.boundary = cut_facets(whole.boundary, whole_model.space.cells, piece.space.cells, piece.cell_number);
}

void cut_probe_targets(const std::vector<ProbeTargets>& whole, const Piece& piece, const ContactBoundary& contact,
                       const ContactBoundary& own, std::vector<ProbeTargets>& result) {
  result = whole;
  for (ProbeTargets& places : result) {
    places.nodes = indices_in(places.nodes, piece.node_number);
    for (Probe& probe : places.probes) {
      const Index node = probe.node, entry = probe.contact_node;
      probe.node = index_in(piece.node_number, node);
      if (probe.node < 0 || entry < 0) continue;
      // Entries keep their order, so that the offset among the entries of the node is unchanged.
      const auto first = std::find(contact.nodes.begin(), contact.nodes.end(), node) - contact.nodes.begin();
      probe.contact_node =
          std::find(own.nodes.begin(), own.nodes.end(), probe.node) - own.nodes.begin() + (entry - first);
    }
  }
}

/// Keeps the data that are needed to write the mesh; the whole body on the first rank only.
std::unique_ptr<const Model::GlobalOutput> make_global_output(Model& whole, const Piece& piece, int rank) {
  auto result = std::make_unique<Model::GlobalOutput>();
  result->node_rows = piece.space.number;
  result->cell_rows = piece.cell_number;
  if (rank != 0) return result;
  result->space = std::move(whole.space);
  result->body = whole.body;
  result->body.mesh = nullptr;
  result->body.space = &result->space;
  result->problem.dimension = whole.problem.dimension;
  result->problem.nodes = result->space.nodes;
  result->problem.obstacles = whole.problem.obstacles;
  result->problem.contact.facets = whole.problem.contact.facets;
  return result;
}

/// Cuts the part of a rank. The first rank is cut last and takes over data of the whole.
ModelPart cut_model(Model& whole, const Division& division, int rank) {
  Piece piece = cut_piece(whole.mesh, whole.space, division.rank_of_cell(), rank, division.more_nodes(rank));
  ModelPart part;
  part.node_number = piece.node_number;
  part.all_nodes = whole.space.node_count();
  for (const auto& obstacle : whole.obstacles) part.obstacles.push_back(obstacle.get());
  part.model = std::make_unique<Model>();
  Model& model = *part.model;
  model.problem = cut_problem(whole.problem, division, piece, rank);
  if (const NodeMatrix* damping = whole.problem.damping.mass_part(); damping != nullptr)
    model.problem.damping.set_mass_part(cut_matrix(*damping, division, piece, rank), model.problem.nodes);
  model.sizes = whole.sizes;
  model.mass_built = whole.mass_built;
  model.contains_rotations = whole.contains_rotations;
  model.initial.static_equilibrium = whole.initial.static_equilibrium;
  model.initial.displacement = cut_values(whole.initial.displacement, piece, whole.problem.dimension);
  model.initial.velocity = cut_values(whole.initial.velocity, piece, whole.problem.dimension);
  if (whole.initial.found) {
    model.initial.found = {cut_values(whole.initial.found->displacement, piece, whole.problem.dimension),
                           chosen(whole.initial.found->normal_reaction, division.points_of(rank))};
  }
  model.history_bodies.labels = whole.history_bodies.labels;
  model.history_bodies.of_node = chosen(whole.history_bodies.of_node, piece.node_number);
  cut_bodies(whole.bodies, whole, piece, model.bodies);
  cut_probe_targets(whole.probe_targets, piece, whole.problem.contact, model.problem.contact, model.probe_targets);
  model.contact_scales = whole.contact_scales;
  model.contacts = whole.contacts;
  for (ModelContact& contact : model.contacts) contact.facets.clear();
  model.contact_pairs = whole.contact_pairs;
  for (ContactPair& pair : model.contact_pairs) pair.facets = indices_in(pair.facets, piece.facet_number);
  model.pair_facings = whole.pair_facings;
  model.body = whole.body;
  model.body.tied = nullptr;
  model.body.cell_material = chosen(whole.body.cell_material, piece.cell_number);
  model.global_output = make_global_output(whole, piece, rank);
  if (rank == 0) model.obstacles = std::move(whole.obstacles);
  // The part numbers its own nodes only.
  std::iota(piece.space.number.begin(), piece.space.number.end(), Index{0});
  model.mesh = std::move(piece.mesh);
  model.space = std::move(piece.space);
  model.body.mesh = &model.mesh;
  model.body.space = &model.space;
  return part;
}

/// Finds the equilibrium on this process alone, before the body is divided, which takes the memory of the whole body.
void find_equilibrium(const Case& input, Model& whole) {
  const std::shared_ptr<const InternalForce> none = whole.problem.internal_force;
  const Damping by_mass = whole.problem.damping;
  assemble_forces(input, whole);
  whole.initial.found = find_static_equilibrium(whole.problem, whole.initial.velocity, step_solver_options(input));
  whole.problem.internal_force = none;
  whole.problem.damping = by_mass;
  release_freed_memory();
}

void report_small_parts(const Model& whole, int processes) {
  constexpr Index few = 5000;  // dofs of a part
  const Index each = whole.space.dof_count() / processes;
  if (each >= few) return;
  log::info(
      fmt::format("each process has about {} dofs: with fewer than 50,000 several processes gain little, and with so "
                  "few one process is usually faster",
                  each));
}

/// Sends each rank its part of the whole, which the first rank has.
ModelPart scatter_parts(const Case& input, std::unique_ptr<Model> whole, std::optional<Division> division,
                        const Communicator& ranks) {
  if (ranks.rank() > 0) return unpack(input, ranks.receive(0));
  for (int rank = 1; rank < ranks.size(); ++rank) {
    ModelPart part = cut_model(*whole, *division, rank);
    pack(input, part, [&](std::span<const char> bytes) {
      if (!bytes.empty()) ranks.send(rank, bytes);
    });
    ranks.send(rank, {});
  }
  return cut_model(*whole, *division, 0);
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
  std::unique_ptr<Model> whole;
  std::optional<Division> division;
  WorldRanks(ranks).run_collectively([&] {
    if (ranks.rank() > 0) return;
    whole = build_model_without_forces(input, times);
    refuse_undividable_model(input, *whole, ranks.size());
    report_small_parts(*whole, ranks.size());
    if (whole->initial.static_equilibrium) find_equilibrium(input, *whole);
    division.emplace(whole->space, whole->problem,
                     partition_cells(whole->mesh, ranks.size(), options.method, options.seed));
  });
  Timer timer;
  ModelPart part = scatter_parts(input, std::move(whole), std::move(division), ranks);
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
