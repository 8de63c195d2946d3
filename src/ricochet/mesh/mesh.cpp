#include "ricochet/mesh/mesh.hpp"

#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/mesh/derived_groups.hpp"

namespace ricochet {

namespace {

Index total_size(const std::vector<CellBlock>& blocks) {
  Index total = 0;
  for (const CellBlock& block : blocks) total += block.size();
  return total;
}

std::string entity_name(int dimension, int mesh_dimension) {
  if (dimension == mesh_dimension) return "cells";
  if (dimension == mesh_dimension - 1) return "boundary facets";
  return dimension == 0 ? "points" : "curves";
}

/// For a mesh of several files: returns "ball.skin" if "skin" was requested.
std::vector<std::string> names_in_parts(const Mesh& mesh, const std::string& name, int dimension) {
  std::vector<std::string> names;
  for (const MeshPart& part : mesh.parts) {
    const std::string full = part.group_name(name);
    if (mesh.find_group(full, dimension) != nullptr) names.push_back(full);
  }
  return names;
}

[[noreturn]] void fail_missing(const Mesh& mesh, const std::string& name, int dimension) {
  std::vector<std::string> names;
  for (const Group& group : mesh.groups) {
    if (group.dimension == dimension) names.push_back(group.name);
  }
  const std::string entities = entity_name(dimension, mesh.dimension);
  std::string message = fmt::format("{}: there is no group \"{}\" of {}; ", mesh.source, name, entities);
  message += names.empty() ? fmt::format("the mesh has no groups of {}", entities)
                           : fmt::format("the groups of {} are {}", entities, join_names(names));
  const auto is_free = [&](const char* built_in) { return mesh.find_group(built_in, dimension) == nullptr; };
  if (dimension == mesh.dimension && is_free(all_cells_name))
    message += fmt::format("; in a case, \"{}\" means all cells", all_cells_name);
  if (dimension == mesh.dimension - 1 && is_free(whole_boundary_name))
    message += fmt::format("; in a case, \"{}\" means all boundary facets", whole_boundary_name);
  if (!mesh.parts.empty() && (dimension == mesh.dimension || dimension == mesh.dimension - 1)) {
    message +=
        fmt::format(", and \"{}\" those of part \"{}\"",
                    mesh.parts.front().group_name(dimension == mesh.dimension ? all_cells_name : whole_boundary_name),
                    mesh.parts.front().name);
  }
  const std::vector<std::string> in_parts = names_in_parts(mesh, name, dimension);
  if (const std::string nearest = nearest_name(name, names); !in_parts.empty()) {
    message += fmt::format("; did you mean {}?", join_names(in_parts, " or "));
  } else if (!nearest.empty()) {
    message += fmt::format("; did you mean \"{}\"?", nearest);
  }
  for (const Group& group : mesh.groups) {
    if (group.name != name) continue;
    message += fmt::format("; \"{}\" is a group of {}", name, entity_name(group.dimension, mesh.dimension));
  }
  throw Error(ErrorKind::invalid_input, message);
}

}  // namespace

Index Mesh::cell_count() const { return total_size(cells); }
Index Mesh::facet_count() const { return total_size(facets); }

const Group* Mesh::find_group(const std::string& name, int dimension) const {
  for (const Group& group : groups) {
    if (group.dimension == dimension && group.name == name) return &group;
  }
  return nullptr;
}

const Group& Mesh::group(const std::string& name, int dimension) const {
  const Group* found = find_group(name, dimension);
  if (found == nullptr) fail_missing(*this, name, dimension);
  const bool has_members = dimension == this->dimension || dimension == this->dimension - 1;
  if (has_members && found->members.empty() && !is_piece) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: the group \"{}\" of {} is empty: the file names it, but no element is in it", source,
                            name, entity_name(dimension, this->dimension)));
  }
  return *found;
}

CellLocation location_of_cell(const Mesh& mesh, Index cell) {
  for (const CellBlock& block : mesh.cells) {
    if (cell >= block.size()) {
      cell -= block.size();
      continue;
    }
    CellLocation result{Vector::Zero(mesh.dimension), block.tags[std::size_t(cell)]};
    const int vertices = vertex_count(block.shape);
    for (int k = 0; k < vertices; ++k) result.centre += mesh.nodes.col(block.cell(cell)[k]);
    result.centre /= double(vertices);
    return result;
  }
  return {};
}

}  // namespace ricochet
