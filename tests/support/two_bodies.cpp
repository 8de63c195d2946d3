#include "support/two_bodies.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/Geometry>

#include "ricochet/mesh/merge_parts.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"
#include "support/case_run.hpp"

namespace ricochet::test_support {

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
  return merge_parts({{"lower", lower}, {"upper", upper}});
}

/// Groups of facets that contain the whole boundary of a body are left out, as elements belong to one group each.
std::string write_mesh(const std::string& name, const Mesh& mesh) {
  std::string names, elements, nodes;
  int groups = 0, count = 0;
  for (const Group& group : mesh.groups) {
    if (group.dimension < mesh.dimension - 1 || group.name.ends_with("boundary")) continue;
    names += fmt::format("{} {} \"{}\"\n", group.dimension, ++groups, group.name);
    const std::vector<CellBlock>& blocks = group.dimension == mesh.dimension ? mesh.cells : mesh.facets;
    for (const Index member : group.members) {
      const IndexInBlocks place = locate_in_blocks(blocks, member);
      const CellBlock& block = blocks[place.block];
      std::vector<Index> ordered;
      for (const int node : gmsh_nodes(block.shape, mesh.degree)) ordered.push_back(block.cell(place.local)[node] + 1);
      elements += fmt::format("{} {} 2 {} {} {}\n", ++count, file_type(block.shape, mesh.degree).gmsh, groups, groups,
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

PointMap skew_motion(int dimension) {
  const Matrix turn =
      dimension == 2 ? Matrix(Eigen::Rotation2Dd(0.4).toRotationMatrix())
                     : Matrix(Eigen::AngleAxisd(0.5, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix());
  return affine_map(turn, Vector::LinSpaced(dimension, 0.3, -0.7));
}

}  // namespace ricochet::test_support
