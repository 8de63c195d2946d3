#pragma once

#include <array>
#include <string>
#include <vector>

#include "ricochet/rigid/surface/surface_file.hpp"

/// @file Triangulated bodies whose distances are known.
namespace ricochet {

/// Returns a block between two corners, made of 12 n² triangles.
[[nodiscard]] SurfaceFacets block_surface(const Eigen::Vector3d& low, const Eigen::Vector3d& high, int n = 1);
/// Returns 20·4ⁿ triangles with their corners on a sphere.
[[nodiscard]] SurfaceFacets sphere_surface(const Eigen::Vector3d& centre, double radius, int refinements);
void write_binary_stl(const SurfaceFacets& facets, const std::string& file);
/// Writes 17 digits.
void write_text_stl(const SurfaceFacets& facets, const std::string& file);

}  // namespace ricochet
