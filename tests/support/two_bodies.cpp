#include "support/two_bodies.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

#include "ricochet/mesh/gmsh_elements.hpp"
#include "support/case_run.hpp"

namespace ricochet::test_support {

namespace {

/// Adds the blocks of the other mesh; returns for each of its cells the number here, through all blocks.
std::vector<Index> add_blocks(std::vector<CellBlock>& blocks, const std::vector<CellBlock>& others, Index node_shift,
                              std::vector<Index>& own_numbers) {
  std::vector<CellBlock> result = blocks;
  std::vector<std::pair<std::size_t, Index>> places;
  for (const CellBlock& other : others) {
    auto block =
        std::find_if(result.begin(), result.end(), [&](const CellBlock& one) { return one.shape == other.shape; });
    if (block == result.end()) block = result.insert(result.end(), {other.shape, other.nodes_per_cell, {}, {}});
    for (Index cell = 0; cell < other.size(); ++cell)
      places.emplace_back(static_cast<std::size_t>(block - result.begin()), block->size() + cell);
    for (const Index node : other.nodes) block->nodes.push_back(node + node_shift);
    for (const std::int64_t tag : other.tags) block->tags.push_back(tag + 1'000'000);
  }
  const auto number = [&](std::size_t block, Index local) {
    for (std::size_t b = 0; b < block; ++b) local += result[b].size();
    return local;
  };
  own_numbers.clear();
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (Index cell = 0; cell < blocks[b].size(); ++cell) own_numbers.push_back(number(b, cell));
  }
  std::vector<Index> numbers;
  for (const auto& [block, local] : places) numbers.push_back(number(block, local));
  blocks = std::move(result);
  return numbers;
}

}  // namespace

Mesh join_meshes(const Mesh& lower, const Mesh& upper) {
  Mesh mesh = lower;
  mesh.nodes.conservativeResize(Eigen::NoChange, lower.node_count() + upper.node_count());
  mesh.nodes.rightCols(upper.node_count()) = upper.nodes;
  for (const std::int64_t tag : upper.node_tags) mesh.node_tags.push_back(tag + 1'000'000);
  std::vector<Index> own_cells, own_facets;
  const std::vector<Index> cells = add_blocks(mesh.cells, upper.cells, lower.node_count(), own_cells);
  const std::vector<Index> facets = add_blocks(mesh.facets, upper.facets, lower.node_count(), own_facets);
  mesh.groups.clear();
  int tag = 0;
  const auto add = [&](const std::string& prefix, const Group& group, const std::vector<Index>& of_cells,
                       const std::vector<Index>& of_facets) {
    Group copy{prefix + group.name, ++tag, group.dimension, {}};
    for (const Index member : group.members)
      copy.members.push_back(
          (group.dimension == mesh.dimension ? of_cells : of_facets)[static_cast<std::size_t>(member)]);
    std::sort(copy.members.begin(), copy.members.end());
    mesh.groups.push_back(std::move(copy));
  };
  for (const Group& group : lower.groups) add("lower.", group, own_cells, own_facets);
  for (const Group& group : upper.groups) add("upper.", group, cells, facets);
  return mesh;
}

Mesh make_stack(const StackedBoxes& stack) {
  const auto then = [](const PointMap& first, const PointMap& second) -> PointMap {
    return [=](const Vector& x) {
      const Vector y = first ? first(x) : x;
      return second ? second(y) : y;
    };
  };
  const int d = dimension(stack.lower_shape);
  const PointMap above = affine_map(Matrix::Identity(d, d), Vector::Unit(d, d - 1));
  const Mesh lower = make_box_mesh({stack.lower_shape, stack.lower_counts, stack.geometry_degree, stack.distortion,
                                    then(stack.lower_map, stack.both)});
  const Mesh upper = make_box_mesh({stack.upper_shape, stack.upper_counts, stack.geometry_degree, stack.distortion,
                                    then(stack.upper_map ? stack.upper_map : above, stack.both)});
  return join_meshes(lower, upper);
}

namespace {

int gmsh_type(CellShape shape, int degree) {
  for (int number = 1; number <= 20; ++number) {
    const gmsh::ElementType* const type = gmsh::find_element_type(number);
    if (type != nullptr && type->shape == shape && type->degree == degree) return number;
  }
  return 0;
}

}  // namespace

/// Groups of facets that hold all of a body's boundary are left out: elements belong to one group each.
std::string write_mesh(const std::string& name, const Mesh& mesh) {
  std::string names, elements, nodes;
  int groups = 0, count = 0;
  for (const Group& group : mesh.groups) {
    if (group.dimension < mesh.dimension - 1 || group.name.ends_with("boundary")) continue;
    names += fmt::format("{} {} \"{}\"\n", group.dimension, ++groups, group.name);
    const std::vector<CellBlock>& blocks = group.dimension == mesh.dimension ? mesh.cells : mesh.facets;
    for (const Index member : group.members) {
      const PlaceInBlocks place = place_in_blocks(blocks, member);
      const CellBlock& block = blocks[place.block];
      const std::vector<int>& order = gmsh::node_order(block.shape, mesh.degree);
      std::vector<Index> ordered(order.size());
      for (std::size_t i = 0; i < order.size(); ++i)
        ordered[static_cast<std::size_t>(order[i])] = block.cell(place.local)[i] + 1;
      elements += fmt::format("{} {} 2 {} {} {}\n", ++count, gmsh_type(block.shape, mesh.degree), groups, groups,
                              fmt::join(ordered, " "));
    }
  }
  for (Index node = 0; node < mesh.node_count(); ++node) {
    nodes += fmt::format("{} {:.17g} {:.17g} {:.17g}\n", node + 1, mesh.nodes(0, node), mesh.nodes(1, node),
                         mesh.dimension == 3 ? mesh.nodes(2, node) : 0.0);
  }
  return write_temporary(
      name, fmt::format("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{}\n{}$EndPhysicalNames\n$Nodes\n{}\n"
                        "{}$EndNodes\n$Elements\n{}\n{}$EndElements\n",
                        groups, names, mesh.node_count(), nodes, count, elements));
}

}  // namespace ricochet::test_support
