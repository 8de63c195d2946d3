#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <utility>

#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

namespace {

using Subdivision = CellShapeDescription::Subdivision;

/// Vertices of a product, lexicographically: those of the first factor alternate fastest.
std::vector<Eigen::Vector3d> vertices_of_product(const std::vector<int>& dimensions) {
  std::vector<Eigen::Vector3d> result{Eigen::Vector3d::Zero()};
  int axis = 0;
  for (const int d : dimensions) {
    const std::vector<Eigen::Vector3d> before = result;
    for (int k = 0; k < d; ++k, ++axis) {
      for (const Eigen::Vector3d& vertex : before) result.emplace_back(vertex + Eigen::Vector3d::Unit(axis));
    }
  }
  return result;
}

/// Lagrange function as the product of those of the factors, each a polynomial of barycentric coordinates λ: at
/// a vertex λ or λ (2λ − 1), in the middle of an edge 4 λᵢ λⱼ.
LagrangeValue lagrange_on_product(const std::vector<int>& dimensions, int degree, const Eigen::Vector3d& node,
                                  const Eigen::Vector3d& at) {
  LagrangeValue result;
  int axis = 0;
  for (const int d : dimensions) {
    const auto barycentric = [axis, d](const Eigen::Vector3d& x, int k) {
      return k == 0 ? 1.0 - x.segment(axis, d).sum() : x[axis + k - 1];
    };
    int first = -1, last = -1;  // vertices of the factor at whose mean the node lies
    for (int k = 0; k <= d; ++k) {
      if (barycentric(node, k) == 0.0) continue;
      if (first < 0) first = k;
      last = k;
    }
    const double a = barycentric(at, first), b = barycentric(at, last);
    double value = a, by_first = 1.0, by_last = 0.0;  // derivatives with respect to a and b
    if (degree == 2 && first == last) {
      value = a * (2.0 * a - 1.0);
      by_first = 4.0 * a - 1.0;
    } else if (degree == 2) {
      value = 4.0 * a * b;
      by_first = 4.0 * b;
      by_last = 4.0 * a;
    }
    const auto slope = [&](int k, int along) { return k == 0 ? -1.0 : k == along + 1 ? 1.0 : 0.0; };
    for (int k = 0; k < 3; ++k) {
      const bool is_here = k >= axis && k < axis + d;
      result.gradient[k] *= is_here ? by_first * slope(first, k - axis) + by_last * slope(last, k - axis) : value;
    }
    result.value *= value;
    axis += d;
  }
  return result;
}

VertexSet middle_of_edge(int one, int other) {
  if (one == other) return {one};
  return {std::min(one, other), std::max(one, other)};
}

/// Cuts the octahedron that remains between the corners of a tetrahedron into four tetrahedra around the diagonal from
/// the midpoint of ab to that of cd.
std::vector<VertexSets> around_diagonal(const std::array<int, 4>& abcd) {
  const auto [a, b, c, d] = abcd;
  const std::array<VertexSet, 4> ring{middle_of_edge(a, c), middle_of_edge(b, c), middle_of_edge(b, d),
                                      middle_of_edge(a, d)};
  const std::vector<Eigen::Vector3d> vertices = vertices_of_product({3});
  const auto twice = [&vertices](const VertexSet& pair) {
    return Eigen::Vector3d(vertices[std::size_t(pair[0])] + vertices[std::size_t(pair[1])]);
  };
  std::vector<VertexSets> result;
  for (std::size_t i = 0; i < 4; ++i) {
    VertexSets child{middle_of_edge(a, b), middle_of_edge(c, d), ring[i], ring[(i + 1) % 4]};
    Eigen::Matrix3d edges;
    for (int k = 0; k < 3; ++k) edges.col(k) = twice(child[std::size_t(k) + 1]) - twice(child[0]);
    if (edges.determinant() < 0.0) std::swap(child[2], child[3]);
    result.push_back(std::move(child));
  }
  return result;
}

/// Subdivisions of a simplex into children at its corners, copies of the parent at half its size, and what remains
/// between them.
std::vector<Subdivision> subdivisions_of_simplex(CellShape shape, int d) {
  Subdivision corners;
  for (int corner = 0; corner <= d; ++corner) {
    VertexSets& vertices = corners.children.emplace_back(CellShapeDescription::Child{shape, {}}).vertices;
    for (int vertex = 0; vertex <= d; ++vertex) vertices.push_back(middle_of_edge(corner, vertex));
  }
  if (d == 2) corners.children.push_back({shape, {{1, 2}, {0, 2}, {0, 1}}});
  if (d < 3) return {corners};
  std::vector<Subdivision> result;
  for (const std::array<int, 4>& abcd : {std::array{0, 1, 2, 3}, std::array{0, 2, 1, 3}, std::array{0, 3, 1, 2}}) {
    Subdivision& one = result.emplace_back(corners);
    one.diagonal = {{abcd[0], abcd[1]}, {abcd[2], abcd[3]}};
    for (VertexSets& child : around_diagonal(abcd)) one.children.push_back({shape, std::move(child)});
  }
  return result;
}

/// Product of sets of vertices: `count` is the number of vertices of the first factor.
VertexSet product(const VertexSet& one, int count, const VertexSet& other) {
  VertexSet result;
  for (const int b : other) {
    for (const int a : one) result.push_back(a + count * b);
  }
  return result;
}

VertexSets product(const VertexSets& one, int count, const VertexSets& other) {
  VertexSets result;
  for (const VertexSet& b : other) {
    for (const VertexSet& a : one) result.push_back(product(a, count, b));
  }
  return result;
}

std::vector<Subdivision> subdivisions_of_product(CellShape shape, const std::vector<int>& dimensions) {
  std::vector<Subdivision> result = subdivisions_of_simplex(shape, dimensions.front());
  int count = dimensions.front() + 1;
  for (std::size_t k = 1; k < dimensions.size(); count *= dimensions[k++] + 1) {
    const Subdivision before = std::move(result.front());  // of an interval or triangle: there is one
    const Subdivision factor = subdivisions_of_simplex(shape, dimensions[k]).front();
    result.assign(1, {});
    for (const auto& b : factor.children) {
      for (const auto& a : before.children)
        result.front().children.push_back({shape, product(a.vertices, count, b.vertices)});
    }
  }
  return result;
}

/// Simplices along the monotone paths through the vertices of the factors, from the first of each to the last (Kuhn).
VertexSets simplices_of_product(const std::vector<int>& dimensions) {
  std::vector<std::size_t> steps;  // the factors, each as often as it has steps
  for (std::size_t k = 0; k < dimensions.size(); ++k) steps.insert(steps.end(), std::size_t(dimensions[k]), k);
  std::vector<int> stride{1};
  for (const int d : dimensions) stride.push_back(stride.back() * (d + 1));
  VertexSets result;
  do {
    VertexSet& path = result.emplace_back(VertexSet{0});
    for (const std::size_t factor : steps) path.push_back(path.back() + stride[factor]);
  } while (std::next_permutation(steps.begin(), steps.end()));
  return result;
}

}  // namespace

CellShapeDescription product_of_simplices(CellShape shape, const std::vector<int>& dimensions) {
  CellShapeDescription result;
  for (const int d : dimensions) result.dimension += d;
  result.vertices = vertices_of_product(dimensions);
  result.has_centre_node = dimensions.size() > 1 && *std::ranges::max_element(dimensions) == 1;
  result.lagrange = [dimensions](int degree, const Eigen::Vector3d& node, const Eigen::Vector3d& at) {
    return lagrange_on_product(dimensions, degree, node, at);
  };
  result.subdivisions = subdivisions_of_product(shape, dimensions);
  result.simplices = simplices_of_product(dimensions);
  return result;
}

}  // namespace ricochet
