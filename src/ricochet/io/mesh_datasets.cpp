#include "ricochet/io/mesh_datasets.hpp"

#include <algorithm>
#include <numeric>

#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

namespace {

FixedDataset node_positions(const DisplacementSpace& space) {
  FixedDataset set{"/mesh/nodes", space.node_count(), 3, {}, {}};
  set.reals.assign(std::size_t(3 * space.node_count()), 0.0);
  for (Index i = 0; i < space.node_count(); ++i) {
    const Index row = space.number[std::size_t(i)];
    for (int k = 0; k < space.dimension; ++k) set.reals[std::size_t(3 * row + k)] = space.nodes(k, i);
  }
  return set;
}

/// Cells (or facets) of a block by their numbers in it.
struct Part {
  const CellBlock* block;
  std::vector<Index> members;
};

/// One row per cell; cells of several shapes form one list, in which each begins with XDMF's number of its shape.
FixedDataset connectivity(const DisplacementSpace& space, const std::string& name, const std::vector<Part>& parts) {
  FixedDataset set{name, 0, 0, {}, {}};
  const bool mixed = parts.size() > 1;
  for (const Part& part : parts) {
    const CellShape shape = part.block->shape;
    for (const Index i : part.members) {
      if (mixed) set.integers.push_back(file_type(shape, space.degree).xdmf_number);
      for (const int k : vtk_nodes(shape, space.degree))
        set.integers.push_back(space.number[std::size_t(part.block->cell(i)[k])]);
    }
  }
  set.columns = mixed ? 0 : parts.front().block->nodes_per_cell;
  set.rows = Index(set.integers.size()) / std::max<Index>(set.columns, 1);
  return set;
}

FixedDataset cells_of(const DisplacementSpace& space) {
  std::vector<Part> parts;
  for (const CellBlock& block : space.cells) {
    parts.push_back({&block, std::vector<Index>(std::size_t(block.size()))});
    std::iota(parts.back().members.begin(), parts.back().members.end(), Index{0});
  }
  return connectivity(space, "/mesh/cells", parts);
}

/// Number of each cell in the mesh file.
FixedDataset element_numbers(const DisplacementSpace& space) {
  FixedDataset set{"/mesh/element", 0, 0, {}, {}};
  for (const CellBlock& block : space.cells)
    set.integers.insert(set.integers.end(), block.tags.begin(), block.tags.end());
  set.rows = Index(set.integers.size());
  return set;
}

FixedDataset contact_facets_of(const DisplacementSpace& space, const ContactBoundary& contact) {
  std::vector<Part> parts;
  for (const Index facet : contact.facets) {
    const IndexInBlocks location = locate_facet(space, facet);
    const CellBlock* block = &space.facets[location.block];
    if (parts.empty() || parts.back().block != block) parts.push_back({block, {}});
    parts.back().members.push_back(location.local);
  }
  return connectivity(space, "/mesh/contact_facets", parts);
}

/// Consecutive cells in the form of VTKHDF.
struct VtkHdfCells {
  FixedDataset connectivity{"/VTKHDF/Connectivity", 0, 0, {}, {}}, offsets{"/VTKHDF/Offsets", 0, 0, {}, {0}},
      types{.name = "/VTKHDF/Types", .bytes = true};

  /// Ends a cell whose nodes have been added to `connectivity`.
  void end_cell(int type) {
    offsets.integers.push_back(std::int64_t(connectivity.integers.size()));
    types.integers.push_back(type);
  }
  [[nodiscard]] std::vector<FixedDataset> datasets(Index points) {
    const auto count = [](const char* name, Index value) { return FixedDataset{name, 1, 0, {}, {value}}; };
    std::vector<FixedDataset> result{count("/VTKHDF/NumberOfPoints", points),
                                     count("/VTKHDF/NumberOfCells", Index(types.integers.size())),
                                     count("/VTKHDF/NumberOfConnectivityIds", Index(connectivity.integers.size()))};
    for (FixedDataset* set : {&connectivity, &offsets, &types}) {
      set->rows = Index(set->integers.size());
      result.push_back(std::move(*set));
    }
    return result;
  }
};

}  // namespace

std::vector<FixedDataset> mesh_datasets(const DisplacementSpace& space, const ContactBoundary& contact) {
  std::vector<FixedDataset> result{node_positions(space), cells_of(space), element_numbers(space)};
  if (!contact.facets.empty()) result.push_back(contact_facets_of(space, contact));
  return result;
}

std::vector<FixedDataset> vtkhdf_mesh_datasets(const DisplacementSpace& space) {
  VtkHdfCells cells;
  for (const CellBlock& block : space.cells) {
    for (Index i = 0; i < block.size(); ++i) {
      for (const int k : vtk_nodes(block.shape, space.degree))
        cells.connectivity.integers.push_back(space.number[std::size_t(block.cell(i)[k])]);
      cells.end_cell(file_type(block.shape, space.degree).vtk);
    }
  }
  std::vector<FixedDataset> result = cells.datasets(space.node_count());
  result.push_back({.name = "/VTKHDF/Points", .same_as = "/mesh/nodes"});
  result.push_back({.name = "/VTKHDF/CellData/element", .same_as = "/mesh/element"});
  return result;
}

std::vector<FixedDataset> vtkhdf_cell_datasets(Index points, const std::vector<int>& cells, int type,
                                               int nodes_per_cell) {
  VtkHdfCells result;
  for (const int node : cells) {
    result.connectivity.integers.push_back(node);
    if (result.connectivity.integers.size() % std::size_t(nodes_per_cell) == 0) result.end_cell(type);
  }
  return result.datasets(points);
}

}  // namespace ricochet
