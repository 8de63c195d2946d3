#pragma once

#include "ricochet/mesh/mesh.hpp"

/// @file Facets on the surface of the body.
namespace ricochet {

/// Returns for each of the given facets its cells, ascending; facets and cells are numbered through all blocks.
[[nodiscard]] std::vector<std::vector<Index>> cells_of_facets(const Mesh& mesh, const std::vector<Index>& facets);

/// Returns those of the given facets (numbered through all blocks) that two cells share: they are not on the surface.
[[nodiscard]] std::vector<Index> interior_facets(const Mesh& mesh, const std::vector<Index>& facets);

/// Text with the file's element numbers of the first few of the given facets.
[[nodiscard]] std::string facet_tags(const Mesh& mesh, const std::vector<Index>& facets);

}  // namespace ricochet
