#pragma once

#include <string>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Groups that a mesh has without its file defining them. They are made on request: most runs need none.
namespace ricochet {

/// Names of the group of all cells and of the group of all boundary facets. A group of the file with such a name and
/// the same dimension takes precedence.
inline constexpr const char* all_cells_name = "all";
inline constexpr const char* whole_boundary_name = "boundary";

/// Returns whether a name denotes all cells, or all boundary facets, of the mesh ("all") or of one of its parts
/// ("ball.all").
[[nodiscard]] bool is_built_in_group(const Mesh& mesh, const std::string& name, int dimension);

/// Adds such a group if the mesh has none of that name yet. Boundary facets that are in no group of the file join the
/// mesh's facets, with the tag 0.
void add_built_in_group(Mesh& mesh, const std::string& name, int dimension);

/// Adds the boundary facets of the mesh that belong to some cells (`cells`: 1 for each of these) under a name that no
/// group of facets has.
void add_boundary_of_cells(Mesh& mesh, const std::string& name, const std::vector<char>& cells);

/// Adds the union of existing groups of that dimension under a new name, unless there is a group of that name.
void add_union_of_groups(Mesh& mesh, const std::string& name, const std::vector<std::string>& parts, int dimension);

}  // namespace ricochet
