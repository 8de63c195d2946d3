#include "ricochet/fem/exterior_facets.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

namespace ricochet {

namespace {

/// Vertices of a facet numbered through all blocks.
std::span<const Index> vertices_of(const Mesh& mesh, Index facet) {
  const IndexInBlocks at = locate_in_blocks(mesh.facets, facet);
  const CellBlock& block = mesh.facets[at.block];
  return {block.cell(at.local), std::size_t(vertex_count(block.shape))};
}

}  // namespace

std::vector<std::vector<Index>> cells_of_facets(const Mesh& mesh, const std::vector<Index>& facets) {
  // Cells that contain all vertices of a facet.
  std::vector<std::vector<Index>> cells_of_vertex(static_cast<std::size_t>(mesh.node_count()));
  std::vector<char> is_selected(static_cast<std::size_t>(mesh.node_count()), 0);
  for (const Index facet : facets) {
    for (const Index node : vertices_of(mesh, facet)) is_selected[std::size_t(node)] = 1;
  }
  Index number = 0;
  for (const CellBlock& block : mesh.cells) {
    for (Index cell = 0; cell < block.size(); ++cell, ++number) {
      for (int v = 0; v < vertex_count(block.shape); ++v) {
        const auto node = std::size_t(block.cell(cell)[v]);
        if (is_selected[node] != 0) cells_of_vertex[node].push_back(number);
      }
    }
  }
  std::vector<std::vector<Index>> result;
  for (const Index facet : facets) {
    const std::span<const Index> vertices = vertices_of(mesh, facet);
    std::vector<Index> common = cells_of_vertex[std::size_t(vertices[0])];
    for (const Index node : vertices.subspan(1)) {
      const std::vector<Index>& others = cells_of_vertex[std::size_t(node)];
      std::erase_if(common, [&](Index cell) { return !std::ranges::binary_search(others, cell); });
    }
    result.push_back(std::move(common));
  }
  return result;
}

std::vector<Index> interior_facets(const Mesh& mesh, const std::vector<Index>& facets) {
  const std::vector<std::vector<Index>> cells = cells_of_facets(mesh, facets);
  std::vector<Index> interior;
  for (std::size_t k = 0; k < facets.size(); ++k) {
    if (cells[k].size() > 1) interior.push_back(facets[k]);
  }
  return interior;
}

std::string facet_tags(const Mesh& mesh, const std::vector<Index>& facets) {
  std::string text;
  constexpr std::size_t shown = 5;
  for (std::size_t i = 0; i < std::min(facets.size(), shown); ++i) {
    const IndexInBlocks at = locate_in_blocks(mesh.facets, facets[i]);
    text += fmt::format("{}{}", i == 0 ? "" : ", ", mesh.facets[at.block].tags[std::size_t(at.local)]);
  }
  if (facets.size() > shown) text += fmt::format(", … ({} in all)", facets.size());
  return text;
}

}  // namespace ricochet
