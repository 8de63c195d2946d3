#pragma once

#include <array>
#include <string>
#include <vector>

#include "ricochet/rigid/surface/surface_file.hpp"

/// @file Triangulated bodies whose distances are known.
namespace ricochet {

/// A block from one corner to the other, out of 12 triangles, or out of 12 n² of them.
[[nodiscard]] SurfaceFacets block_surface(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int n = 1);
/// 20·4ⁿ triangles with their corners on a sphere.
[[nodiscard]] SurfaceFacets sphere_surface(const Eigen::Vector3d& centre, double radius, int refinements);
void write_binary_stl(const SurfaceFacets& facets, const std::string& file);
/// With 17 digits.
void write_text_stl(const SurfaceFacets& facets, const std::string& file);

}  // namespace ricochet
