#pragma once

#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Sizes and locations of parts of a mesh, as a basis for choosing time steps and groups.
namespace ricochet {

/// Measures of a set of cells or facets, by quadrature on their (curved) geometry.
struct MeshMeasure {
  double size = 0.0;  ///< volume, area or length
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d lowest = Eigen::Vector3d::Zero(),
                  highest = Eigen::Vector3d::Zero();  ///< corners of the bounding box
  /// For facets on the surface: mean of the outward unit normals. Of length 1 if the facets are flat, 0 if they
  /// enclose a volume; zero for cells.
  Eigen::Vector3d mean_normal = Eigen::Vector3d::Zero();
  Index inside = 0;  ///< number of facets between two cells, which have no outward normal
};

/// Measures one group; z = 0 in 2D. Groups of dimensions other than those of cells and facets have zero measure. In an
/// axisymmetric body the size is that of the rings, which also weight the means over the section.
[[nodiscard]] MeshMeasure measure_group(const Mesh& mesh, const Group& group, bool axisymmetric = false);

/// Smallest height per cell above its facets, numbered through all blocks, as if the cell were straight: V/A times
/// `facet_heights`, with the volume V of the cell and the area A of the facet.
[[nodiscard]] std::vector<double> cell_heights(const Mesh& mesh);
/// Smallest heights of the given cells, in their order.
[[nodiscard]] std::vector<double> cell_heights(const Mesh& mesh, const std::vector<Index>& cells);

/// Longest distance between vertices of a facet, numbered through all blocks.
[[nodiscard]] double facet_diameter(const Mesh& mesh, Index facet);

}  // namespace ricochet
