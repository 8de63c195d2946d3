#pragma once

#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Sizes and places of what a mesh consists of, for those who choose steps and groups.
namespace ricochet {

/// Some cells or facets together, by quadrature on their (curved) geometry.
struct MeshMeasure {
  double size = 0.0;  ///< volume, area or length
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  Eigen::Vector3d lowest = Eigen::Vector3d::Zero(),
                  highest = Eigen::Vector3d::Zero();  ///< corners of the box around it
  /// Of facets on the surface: mean of the unit normals out of the body. Of length 1 where they are flat, 0 where they
  /// close around something; zero of cells.
  Eigen::Vector3d mean_normal = Eigen::Vector3d::Zero();
  Index inside = 0;  ///< facets between two cells, which have no normal out of the body
};

/// Of one group; in the plane z = 0. Groups of other dimensions than cells and facets measure zero. Of an axisymmetric
/// body the size is that of the rings, and means over the section are weighted with them.
[[nodiscard]] MeshMeasure measure_group(const Mesh& mesh, const Group& group, bool axisymmetric = false);

/// Per cell, numbered through all blocks: its smallest height, as if it were straight: d V/A of a simplex with the
/// largest facet's area A, V/A of other cells.
[[nodiscard]] std::vector<double> cell_heights(const Mesh& mesh);
/// Of these cells alone, in their order.
[[nodiscard]] std::vector<double> cell_heights(const Mesh& mesh, const std::vector<Index>& cells);

/// The longest distance between vertices of a facet, numbered through all blocks.
[[nodiscard]] double facet_diameter(const Mesh& mesh, Index facet);

}  // namespace ricochet
