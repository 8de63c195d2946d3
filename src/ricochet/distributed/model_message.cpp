#include "ricochet/distributed/model_message.hpp"

#include <algorithm>

#include "ricochet/base/archive.hpp"
#include "ricochet/contact/contact_members.hpp"
#include "ricochet/model/model_parts.hpp"

namespace ricochet {

void persist(Archive& archive, CellBlock& block) {
  archive.all(block.shape, block.nodes_per_cell, block.nodes, block.tags);
}
void persist(Archive& archive, Group& group) { archive.all(group.name, group.tag, group.dimension, group.members); }
void persist(Archive& archive, MeshPart& part) { archive.all(part.name, part.first_node, part.node_count, part.cells); }
void persist(Archive& archive, Mesh& mesh) {
  archive.all(mesh.source, mesh.dimension, mesh.degree, mesh.nodes, mesh.node_tags, mesh.cells, mesh.facets,
              mesh.groups, mesh.parts, mesh.is_piece);
}
void persist(Archive& archive, DisplacementSpace& space) {
  archive.all(space.dimension, space.degree, space.nodes, space.cells, space.facets, space.number, space.glued,
              space.nodes_without_cells);
}
void persist(Archive& archive, CellFacet& facet) { archive.all(facet.block, facet.cell, facet.local); }
void persist(Archive& archive, ConnectedBodies& bodies) { archive.all(bodies.count, bodies.of_node, bodies.of_cell); }
void persist(Archive& archive, BodiesOfMesh& bodies) {
  archive.all(bodies.connected, bodies.names, bodies.crossing_times, bodies.sizes, bodies.boundary);
}
void persist(Archive& archive, HistoryBodies& bodies) { archive.all(bodies.labels, bodies.of_node); }
void persist(Archive& archive, Probe& probe) {
  archive.all(probe.name, probe.node, probe.distance, probe.contact_node, probe.number);
}
void persist(Archive& archive, Column& column) { archive.all(column.name, column.reduction); }
void persist(Archive& archive, ProbeTargets& targets) {
  archive.all(targets.probes, targets.positions, targets.columns, targets.nodes, targets.summed_forces);
}
void persist(Archive& archive, ModelSizes& sizes) {
  archive.all(sizes.nodes, sizes.cells, sizes.dofs, sizes.contact_points, sizes.supported_dofs, sizes.diameter);
}
void persist(Archive& archive, ContactScale& scale) { archive.all(scale.body_size, scale.spacing); }
void persist(Archive& archive, StaticEquilibrium& equilibrium) {
  archive.all(equilibrium.displacement, equilibrium.normal_reaction);
}
void persist(Archive& archive, InitialConditions& initial) {
  archive.all(initial.static_equilibrium, initial.displacement, initial.velocity, initial.found);
}
void persist(Archive& archive, NodeMatrix& matrix) {
  int d = matrix.dimension();
  SparseMatrix sparse = archive.reads() ? SparseMatrix() : matrix.to_sparse();
  archive.all(d, sparse);
  if (archive.reads()) matrix = NodeMatrix(sparse, d);
}

namespace {

/// Transfers the geometry; obstacles are represented by their indices in the case.
void transfer_geometry(Archive& archive, const std::vector<const Obstacle*>& of_case, Model& model) {
  ContactBoundary& contact = model.problem.contact;
  bool is_curved = contact.follows_motion();
  archive(is_curved);
  if (!is_curved) return;
  CurvedContactData data;
  std::vector<Index> obstacles;
  if (!archive.reads()) {
    data = *contact.geometry->curved();
    for (const Obstacle* const obstacle : data.obstacles) {
      const auto found = std::ranges::find(of_case, obstacle);
      obstacles.push_back(found - of_case.begin());
    }
  }
  archive.all(obstacles, data);
  if (!archive.reads()) return;
  for (const Index number : obstacles) data.obstacles.push_back(model.obstacles.at(std::size_t(number)).get());
  contact.geometry = make_curved_contact(std::move(data));
}

/// Transfers supports; values are represented by the sections that prescribe them, and dofs without a section are those
/// of nodes on the axis.
void transfer_supports(Archive& archive, const Case& input, Supports& supports) {
  std::vector<Index> dofs, sections;
  if (!archive.reads()) {
    dofs = supports.dofs();
    for (const Index dof : dofs) {
      const auto same = [&](const SupportSection& section) { return section.value == supports.expression(dof); };
      sections.push_back(std::ranges::find_if(input.supports, same) - input.supports.begin());
    }
  }
  archive.all(dofs, sections);
  if (!archive.reads()) return;
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const auto section = std::size_t(sections[i]);
    supports.add(dofs[i], section < input.supports.size() ? input.supports[section].value : Expression());
  }
  supports.finish();
}

void transfer_damping(Archive& archive, SemidiscreteProblem& problem) {
  bool is_damped = problem.damping.mass_part() != nullptr;
  archive(is_damped);
  if (!is_damped) return;
  SparseMatrix matrix = archive.reads() ? SparseMatrix() : problem.damping.mass_part()->to_sparse();
  archive(matrix);
  if (archive.reads()) problem.damping.set_mass_part(matrix, problem.nodes);
}

void transfer_problem(Archive& archive, const Case& input, Model& model) {
  SemidiscreteProblem& problem = model.problem;
  archive.all(problem.dimension, problem.axisymmetric, problem.nodes, problem.mass, problem.massless_dofs,
              problem.is_massless, problem.has_massless_elsewhere, problem.has_contact_elsewhere, problem.contact_dofs,
              problem.contact);
  transfer_supports(archive, input, problem.supports);
  transfer_damping(archive, problem);
}

/// Rebuilds the data that follow from the case alone, given the mesh.
void rebuild_from_case(const Case& input, Model& model, std::vector<int> cell_material) {
  assign_materials(input, model);
  model.body.cell_material = std::move(cell_material);
  make_obstacles(input, model, model.mesh.dimension);
  collect_contacts(input, model);
}

void transfer_model(Archive& archive, const Case& input, ModelPart& part) {
  Model& model = *part.model;
  std::vector<int> cell_material = model.body.cell_material;
  std::vector<Index> node_rows, cell_rows;
  if (!archive.reads()) {
    node_rows = model.global_output->node_rows;
    cell_rows = model.global_output->cell_rows;
  }
  archive.all(part.node_number, part.all_nodes, model.mesh, model.space, model.contact_scales, cell_material, node_rows,
              cell_rows);
  if (archive.reads()) {
    rebuild_from_case(input, model, std::move(cell_material));
    auto global_output = std::make_unique<Model::GlobalOutput>();
    global_output->node_rows = std::move(node_rows);
    global_output->cell_rows = std::move(cell_rows);
    model.global_output = std::move(global_output);
  }
  transfer_problem(archive, input, model);
  transfer_geometry(archive, part.obstacles, model);
  archive.all(model.sizes, model.mass_built, model.contains_rotations, model.initial, model.bodies,
              model.history_bodies, model.probe_targets);
  if (archive.reads()) model.pair_facings.resize(model.contact_pairs.size());
}

}  // namespace

void pack(const Case& input, ModelPart& part, const std::function<void(std::span<const char>)>& send) {
  Archive archive(send);
  transfer_model(archive, input, part);
  archive.finish();
}

ModelPart unpack(const Case& input, std::vector<char> bytes) {
  Archive archive(std::move(bytes));
  ModelPart part;
  part.model = std::make_unique<Model>();
  transfer_model(archive, input, part);
  return part;
}

}  // namespace ricochet
