#include "surface_files.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <fstream>

namespace ricochet {

namespace {

using Vector3 = Eigen::Vector3d;
using Triangle = std::array<Vector3, 3>;

/// Orients a triangle such that its normal points away from a point.
Triangle facing_away(Triangle triangle, const Vector3& from) {
  const Vector3 normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  if (normal.dot(triangle[0] - from) < 0.0) std::swap(triangle[1], triangle[2]);
  return triangle;
}

}  // namespace

SurfaceFacets block_surface(const Vector3& low, const Vector3& high, int n) {
  SurfaceFacets result;
  const Vector3 middle = 0.5 * (low + high), size = high - low;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const double at : {0.0, 1.0}) {
      const auto corner = [&](int i, int k) -> Vector3 {
        Vector3 part;
        part[axis] = at;
        part[u] = double(i) / n;
        part[v] = double(k) / n;
        return low + part.cwiseProduct(size);
      };
      for (int i = 0; i < n; ++i) {
        for (int k = 0; k < n; ++k) {
          result.corners.push_back(facing_away({corner(i, k), corner(i + 1, k), corner(i + 1, k + 1)}, middle));
          result.corners.push_back(facing_away({corner(i, k), corner(i + 1, k + 1), corner(i, k + 1)}, middle));
        }
      }
    }
  }
  return result;
}

SurfaceFacets sphere_surface(const Vector3& centre, double radius, int refinements) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  const std::vector<Vector3> corners{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                                     {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  std::vector<Triangle> triangles;
  for (std::size_t a = 0; a < 12; ++a) {
    for (std::size_t b = a + 1; b < 12; ++b) {
      for (std::size_t c = b + 1; c < 12; ++c) {
        const auto near = [&](std::size_t i, std::size_t k) { return (corners[i] - corners[k]).norm() < 2.1; };
        if (near(a, b) && near(b, c) && near(a, c))
          triangles.push_back(facing_away({corners[a].normalized(), corners[b].normalized(), corners[c].normalized()},
                                          Vector3::Zero()));
      }
    }
  }
  for (int level = 0; level < refinements; ++level) {
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : triangles) {
      const Vector3 ab = (a + b).normalized(), bc = (b + c).normalized(), ca = (c + a).normalized();
      finer.insert(finer.end(), {Triangle{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  SurfaceFacets result;
  for (const auto& [a, b, c] : triangles)
    result.corners.push_back({centre + radius * a, centre + radius * b, centre + radius * c});
  return result;
}

void write_binary_stl(const SurfaceFacets& facets, const std::string& file) {
  std::ofstream stream(file, std::ios::binary);
  stream << std::string(80, '\0');  // as many programs leave it
  const auto count = std::uint32_t(facets.corners.size());
  stream.write(reinterpret_cast<const char*>(&count), sizeof count);
  for (const Triangle& triangle : facets.corners) {
    std::array<float, 12> numbers{};
    for (std::size_t k = 0; k < 9; ++k) numbers[3 + k] = float(triangle[k / 3][static_cast<Eigen::Index>(k % 3)]);
    stream.write(reinterpret_cast<const char*>(numbers.data()), sizeof numbers);
    stream.write("\0\0", 2);
  }
}

void write_text_stl(const SurfaceFacets& facets, const std::string& file) {
  std::ofstream stream(file);
  stream << "solid body\n";
  for (const Triangle& triangle : facets.corners) {
    stream << "facet normal 0 0 0\n outer loop\n";
    for (const Vector3& corner : triangle)
      stream << fmt::format("  vertex {:.17g} {:.17g} {:.17g}\n", corner[0], corner[1], corner[2]);
    stream << " endloop\nendfacet\n";
  }
  stream << "endsolid body\n";
}

}  // namespace ricochet
