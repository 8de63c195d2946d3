#pragma once

#include "ricochet/mesh/mesh.hpp"

/// @file Which facets lie on the surface of the body.
namespace ricochet {

/// For each of the given facets (numbered through all blocks) the cells that have it, ascending, numbered likewise.
[[nodiscard]] std::vector<std::vector<Index>> cells_of_facets(const Mesh& mesh, const std::vector<Index>& facets);

/// Those of the given facets (numbered through all blocks) that two cells share: not on the surface.
[[nodiscard]] std::vector<Index> interior_facets(const Mesh& mesh, const std::vector<Index>& facets);

/// The file's element numbers of the given facets, the first few of them, as text.
[[nodiscard]] std::string facet_tags(const Mesh& mesh, const std::vector<Index>& facets);

}  // namespace ricochet
