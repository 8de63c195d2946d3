#pragma once

#include <string>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Groups that a mesh has without its file saying so. They are made when they are asked for: most runs need none.
namespace ricochet {

/// The names that stand for every cell and for every facet on the boundary. A group of the file with such a name, of
/// the same dimension, is meant instead.
inline constexpr const char* all_cells_name = "all";
inline constexpr const char* whole_boundary_name = "boundary";

/// Whether a name stands for every cell, or every facet on the boundary, of the mesh ("all") or of one of its parts
/// ("ball.all").
[[nodiscard]] bool is_built_in_group(const Mesh& mesh, const std::string& name, int dimension);

/// Adds such a group where the mesh has none of that name yet. Facets of the boundary that are in no group of the file
/// join the mesh's facets, with the tag 0.
void add_built_in_group(Mesh& mesh, const std::string& name, int dimension);

/// Adds the facets of the mesh's boundary that belong to some cells (`cells`: 1 for each of these) under a name that no
/// group of facets has.
void add_boundary_of_cells(Mesh& mesh, const std::string& name, const std::vector<char>& cells);

/// Adds the union of groups, all of that dimension and there, under a name of its own, if it is not there yet.
void add_union_of_groups(Mesh& mesh, const std::string& name, const std::vector<std::string>& parts, int dimension);

}  // namespace ricochet
