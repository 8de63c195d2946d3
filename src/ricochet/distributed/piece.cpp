#include "ricochet/distributed/piece.hpp"

#include <algorithm>
#include <numeric>

#include "ricochet/base/selection.hpp"
#include "ricochet/fem/exterior_facets.hpp"

namespace ricochet {

namespace {

/// Selected elements: their numbers through all blocks, and their blocks with the original node numbers.
struct Cut {
  std::vector<CellBlock> blocks;
  std::vector<Index> numbers;
};

Cut cut_blocks(const std::vector<CellBlock>& blocks, const std::vector<char>& is_selected) {
  Cut result;
  Index number = 0;
  for (const CellBlock& block : blocks) {
    // Empty blocks are kept: blocks of mesh and space correspond to each other, and elements are numbered through them.
    CellBlock& cut_block = result.blocks.emplace_back();
    cut_block.shape = block.shape;
    cut_block.nodes_per_cell = block.nodes_per_cell;
    for (Index i = 0; i < block.size(); ++i, ++number) {
      if (is_selected[std::size_t(number)] == 0) continue;
      result.numbers.push_back(number);
      cut_block.nodes.insert(cut_block.nodes.end(), block.cell(i), block.cell(i) + block.nodes_per_cell);
      cut_block.tags.push_back(block.tags[std::size_t(i)]);
    }
  }
  return result;
}

/// Indices of nodes in an ascending list.
class Renumbering {
 public:
  explicit Renumbering(Index count) : index_(std::size_t(count), -1) {}

  void mark(const std::vector<CellBlock>& blocks) {
    for (const CellBlock& block : blocks) {
      for (const Index node : block.nodes) index_[std::size_t(node)] = 0;
    }
  }
  void mark(Index node) { index_[std::size_t(node)] = 0; }
  /// Returns the selected nodes, ascending.
  std::vector<Index> finish() {
    std::vector<Index> nodes;
    for (std::size_t node = 0; node < index_.size(); ++node) {
      if (index_[node] < 0) continue;
      index_[node] = Index(nodes.size());
      nodes.push_back(Index(node));
    }
    return nodes;
  }
  void apply(std::vector<CellBlock>& blocks) const {
    for (CellBlock& block : blocks) {
      for (Index& node : block.nodes) node = index_[std::size_t(node)];
    }
  }

 private:
  std::vector<Index> index_;
};

std::vector<char> facets_of_rank(const Mesh& mesh, const std::vector<int>& rank_of_cell, int rank) {
  std::vector<Index> all(static_cast<std::size_t>(mesh.facet_count()));
  std::iota(all.begin(), all.end(), Index{0});
  std::vector<char> result;
  for (const std::vector<Index>& cells : cells_of_facets(mesh, all))
    result.push_back(rank_of_cell[std::size_t(cells.front())] == rank ? 1 : 0);
  return result;
}

void cut_mesh_nodes(const Mesh& global, Mesh& mesh) {
  Renumbering renumbering(global.node_count());
  renumbering.mark(mesh.cells);
  const std::vector<Index> nodes = renumbering.finish();
  renumbering.apply(mesh.cells);
  renumbering.apply(mesh.facets);
  mesh.nodes = chosen_columns(global.nodes, nodes);
  for (const Index node : nodes) mesh.node_tags.push_back(global.node_tags[std::size_t(node)]);
  for (const MeshPart& part : global.parts) {
    MeshPart& own = mesh.parts.emplace_back();
    own.name = part.name;
    const auto begin = std::ranges::lower_bound(nodes, part.first_node);
    const auto end = std::lower_bound(begin, nodes.end(), part.first_node + part.node_count);
    own.first_node = begin - nodes.begin();
    own.node_count = end - begin;
  }
}

}  // namespace

Piece cut_piece(const Mesh& mesh, const DisplacementSpace& space, const std::vector<int>& rank_of_cell, int rank,
                const std::vector<Index>& more_nodes) {
  Piece piece;
  std::vector<char> cells(rank_of_cell.size());
  std::transform(rank_of_cell.begin(), rank_of_cell.end(), cells.begin(), [rank](int r) { return r == rank ? 1 : 0; });
  const std::vector<char> facets = facets_of_rank(mesh, rank_of_cell, rank);
  Cut of_cells = cut_blocks(mesh.cells, cells), of_facets = cut_blocks(mesh.facets, facets);
  piece.cell_number = std::move(of_cells.numbers);
  piece.facet_number = std::move(of_facets.numbers);

  piece.mesh.is_piece = true;
  piece.mesh.source = mesh.source;
  piece.mesh.dimension = mesh.dimension;
  piece.mesh.degree = mesh.degree;
  piece.mesh.cells = std::move(of_cells.blocks);
  piece.mesh.facets = std::move(of_facets.blocks);
  cut_mesh_nodes(mesh, piece.mesh);
  for (std::size_t i = 0; i < mesh.parts.size(); ++i)
    piece.mesh.parts[i].cells = indices_in(mesh.parts[i].cells, piece.cell_number);
  for (const Group& group : mesh.groups) {
    const bool is_of_cells = group.dimension == mesh.dimension;
    piece.mesh.groups.push_back({group.name, group.tag, group.dimension,
                                 indices_in(group.members, is_of_cells ? piece.cell_number : piece.facet_number)});
  }

  piece.space.dimension = space.dimension;
  piece.space.degree = space.degree;
  piece.space.cells = cut_blocks(space.cells, cells).blocks;
  piece.space.facets = cut_blocks(space.facets, facets).blocks;
  Renumbering renumbering(space.node_count());
  renumbering.mark(piece.space.cells);
  for (const Index node : more_nodes) renumbering.mark(node);
  const std::vector<Index> nodes = renumbering.finish();
  renumbering.apply(piece.space.cells);
  renumbering.apply(piece.space.facets);
  piece.space.nodes = chosen_columns(space.nodes, nodes);
  for (const Index node : nodes) piece.space.number.push_back(space.number[std::size_t(node)]);
  piece.node_number.assign(nodes.begin(), nodes.end());
  return piece;
}

}  // namespace ricochet
