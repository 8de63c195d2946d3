#include "ricochet/mesh/reference_cell.hpp"

#include <basix/cell.h>
#include <basix/finite-element.h>
#include <basix/quadrature.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <span>

#include "ricochet/fem/element_matrices.hpp"
#include "ricochet/fem/polynomial_shape.hpp"
#include "ricochet/mesh/flat_pieces.hpp"
#include "ricochet/mesh/gmsh_elements.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"
#include "support.hpp"

namespace ricochet::test_support {
namespace {

/// Basix's cell with these vertices.
basix::cell::type basix_cell(CellShape shape) {
  for (int number = 1; number <= 7; ++number) {
    const auto type = static_cast<basix::cell::type>(number);
    const auto [points, extents] = basix::cell::geometry(type);
    bool same = extents[0] == describe(shape).vertices.size() && int(extents[1]) == dimension(shape);
    for (std::size_t i = 0; same && i < points.size(); ++i)
      same = points[i] == describe(shape).vertices[i / extents[1]][Index(i % extents[1])];
    if (same) return type;
  }
  ADD_FAILURE() << "Basix has no cell with the vertices of a " << name(shape);
  return basix::cell::type::point;
}

class ReferenceCell : public testing::TestWithParam<CellShape> {
 protected:
  [[nodiscard]] basix::FiniteElement element(int degree) const {
    return basix::create_element(basix::element::family::P, basix_cell(shape_), degree,
                                 basix::element::lagrange_variant::gll_warped);
  }
  [[nodiscard]] Eigen::Vector3d at(int node) const {
    return reference_position(shape_, node_vertices(shape_, 2)[std::size_t(node)]);
  }
  /// Measure of a simplex, negative if it is inverted; `corner(k)` is a point.
  template <class Corner>
  [[nodiscard]] double measure(const Corner& corner) const {
    Eigen::Matrix3d edges = Eigen::Matrix3d::Identity();
    for (int k = 0; k < d_; ++k) edges.col(k) = corner(k + 1) - corner(0);
    return edges.determinant() / (d_ == 1 ? 1.0 : d_ == 2 ? 2.0 : 6.0);
  }
  /// Measure of the cell, from Basix's weights.
  [[nodiscard]] double whole() const {
    const auto [points, weights] = basix::quadrature::make_quadrature(basix_cell(shape_), 2);
    return std::accumulate(weights.begin(), weights.end(), 0.0);
  }

  const CellShape shape_ = GetParam();
  const int d_ = dimension(shape_);
};

TEST_P(ReferenceCell, NodesAreThoseOfBasixInItsOrder) {
  for (const int degree : {1, 2}) {
    const auto [points, extents] = element(degree).points();
    const auto& nodes = node_vertices(shape_, degree);
    ASSERT_EQ(nodes.size(), extents[0]);
    ASSERT_EQ(nodes.size(), std::size_t(node_count(shape_, degree)));
    for (std::size_t node = 0; node < nodes.size(); ++node) {
      for (int axis = 0; axis < d_; ++axis)
        EXPECT_NEAR(reference_position(shape_, nodes[node])[axis], points[node * extents[1] + std::size_t(axis)], 1e-14)
            << "degree " << degree << " node " << node;
    }
  }
}

TEST_P(ReferenceCell, EdgesAndFacetsAreThoseOfBasixInItsOrder) {
  const auto topology = basix::cell::topology(basix_cell(shape_));
  EXPECT_EQ(describe(shape_).edges, topology[1]);
  if (d_ == 1) return;
  const auto& expected = topology[std::size_t(d_ - 1)];
  EXPECT_EQ(facet_nodes(shape_, 1), expected);
  const auto& second = facet_nodes(shape_, 2);
  ASSERT_EQ(second.size(), expected.size());
  for (std::size_t facet = 0; facet < second.size(); ++facet) {
    EXPECT_EQ(vertex_count(facet_shape(shape_, facet)), int(expected[facet].size()));
    const auto& local = node_vertices(facet_shape(shape_, facet), 2);
    ASSERT_EQ(second[facet].size(), local.size());
    for (std::size_t node = 0; node < local.size(); ++node) {
      std::vector<int> vertices;
      for (const int vertex : local[node]) vertices.push_back(expected[facet][std::size_t(vertex)]);
      EXPECT_EQ(node_vertices(shape_, 2)[std::size_t(second[facet][node])], vertices);
    }
  }
}

/// ∮ n = 0, and ∮ x · n is d times the volume.
TEST_P(ReferenceCell, FacetsCloseTheCellAndPointOutwards) {
  if (d_ == 1) return;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double flux = 0.0;
  for (const std::vector<int>& facet : outward_facet_vertices(shape_)) {
    for (std::size_t k = 2; k < std::max<std::size_t>(facet.size(), 3); ++k) {
      const Eigen::Vector3d along = at(facet[k - 1]) - at(facet[0]);
      const Eigen::Vector3d normal = d_ == 2 ? Eigen::Vector3d(along[1], -along[0], 0.0)
                                             : Eigen::Vector3d(0.5 * along.cross(at(facet[k]) - at(facet[0])));
      sum += normal;
      flux += normal.dot(at(facet[0]));  // facets are flat
    }
  }
  EXPECT_LT(sum.norm(), 1e-15);
  EXPECT_NEAR(flux, d_ * whole(), 1e-14);
}

TEST_P(ReferenceCell, MirroredNodesExchangeTheFirstTwoAxes) {
  if (d_ == 1) return;
  for (const int degree : {1, 2}) {
    const std::vector<int>& mirrored = mirrored_nodes(shape_, degree);
    ASSERT_EQ(int(mirrored.size()), node_count(shape_, degree));
    for (int node = 0; node < node_count(shape_, degree); ++node) {
      Eigen::Vector3d image = at(mirrored[std::size_t(node)]);
      std::swap(image[0], image[1]);
      EXPECT_EQ(image, at(node));
    }
  }
}

TEST_P(ReferenceCell, LagrangeFunctionsAreThoseOfBasix) {
  const std::vector<double> points{0.21, 0.13, 0.34, 0.5, 0.25, 0.125};  // of three coordinates each
  for (const int degree : {1, 2}) {
    for (const std::size_t first : {0u, 3u}) {
      const std::span<const double> point(points.data() + first, std::size_t(d_));
      const auto [table, extents] = element(degree).tabulate(1, point, {1, point.size()});
      const auto nodes = std::size_t(node_count(shape_, degree));
      const Eigen::Vector3d here(points[first], points[first + 1], points[first + 2]);
      for (std::size_t node = 0; node < nodes; ++node) {
        const LagrangeValue found = describe(shape_).lagrange(degree, at(int(node)), here);
        EXPECT_NEAR(found.value, table[node], 1e-14) << "degree " << degree << " node " << node;
        for (std::size_t axis = 0; axis < point.size(); ++axis)
          EXPECT_NEAR(found.gradient[Index(axis)], table[(axis + 1) * nodes + node], 1e-13)
              << "degree " << degree << " node " << node;
      }
    }
  }
}

/// The children of each subdivision fill the cell: none is inverted, their sizes add up, and what two of them share is
/// a whole facet of both, so that the facets of only one child have the area of the cell's surface.
TEST_P(ReferenceCell, ChildrenFillTheCell) {
  const auto area = [this](const std::vector<int>& facet, const auto& corner) {
    if (d_ == 2) return (corner(facet[1]) - corner(facet[0])).norm();
    double sum = 0.0;
    for (std::size_t k = 2; k < facet.size(); ++k)
      sum += 0.5 * (corner(facet[k - 1]) - corner(facet[0])).cross(corner(facet[k]) - corner(facet[0])).norm();
    return sum;
  };
  double surface = 0.0;
  for (const std::vector<int>& facet : outward_facet_vertices(shape_))
    surface += area(facet, [this](int k) { return at(k); });
  for (const CellShapeDescription::Subdivision& subdivision : describe(shape_).subdivisions) {
    std::map<std::set<VertexSet>, double> outside;
    double sum = 0.0;
    for (const CellShapeDescription::Child& child : subdivision.children) {
      ASSERT_EQ(int(child.vertices.size()), vertex_count(child.shape));
      const auto corner = [&](int k) { return reference_position(shape_, child.vertices[std::size_t(k)]); };
      for (const FlatPiece& piece : flat_pieces(child.shape, 1)) {
        const double part = measure([&](int k) { return corner(piece[std::size_t(k)]); });
        EXPECT_GT(part, 0.0);
        sum += part;
      }
      for (const std::vector<int>& facet : outward_facet_vertices(child.shape)) {
        std::set<VertexSet> key;
        for (const int k : facet) key.insert(child.vertices[std::size_t(k)]);
        if (!outside.try_emplace(key, area(facet, corner)).second) outside.erase(key);
      }
    }
    EXPECT_NEAR(sum, whole(), 1e-14);
    double of_children = 0.0;
    for (const auto& [key, size] : outside) of_children += size;
    EXPECT_NEAR(of_children, surface, 1e-14);
  }
}

TEST_P(ReferenceCell, FlatPiecesFillItAndUseAllNodes) {
  for (const int degree : {1, 2}) {
    std::set<int> used;
    double sum = 0.0;
    for (const FlatPiece& piece : flat_pieces(shape_, degree)) {
      const double part = measure([&](int k) { return at(piece[std::size_t(k)]); });
      EXPECT_GT(part, 0.0);
      sum += part;
      for (int k = 0; k < 4; ++k) {
        EXPECT_EQ(piece[std::size_t(k)] >= 0, k <= d_);
        if (k <= d_) used.insert(piece[std::size_t(k)]);
      }
    }
    EXPECT_NEAR(sum, whole(), 1e-14) << degree;
    EXPECT_EQ(int(used.size()), node_count(shape_, degree)) << degree;
  }
}

/// The pieces that contact and monitors cut facets into, node by node: their order decides bits of results.
TEST(FlatPiecesOf, FacetsKeepTheirOrder) {
  using Pieces = std::vector<FlatPiece>;
  EXPECT_EQ(flat_pieces(CellShape::interval, 1), (Pieces{{0, 1, -1, -1}}));
  EXPECT_EQ(flat_pieces(CellShape::interval, 2), (Pieces{{0, 2, -1, -1}, {2, 1, -1, -1}}));
  EXPECT_EQ(flat_pieces(CellShape::triangle, 1), (Pieces{{0, 1, 2, -1}}));
  EXPECT_EQ(flat_pieces(CellShape::triangle, 2), (Pieces{{0, 5, 4, -1}, {5, 1, 3, -1}, {4, 3, 2, -1}, {5, 3, 4, -1}}));
  EXPECT_EQ(flat_pieces(CellShape::quadrilateral, 1), (Pieces{{0, 1, 3, -1}, {0, 3, 2, -1}}));
  EXPECT_EQ(flat_pieces(CellShape::quadrilateral, 2), (Pieces{{0, 4, 8, -1},
                                                              {0, 8, 5, -1},
                                                              {4, 1, 6, -1},
                                                              {4, 6, 8, -1},
                                                              {8, 6, 3, -1},
                                                              {8, 3, 7, -1},
                                                              {5, 8, 7, -1},
                                                              {5, 7, 2, -1}}));
}

/// Each order of files has every node once, and those of vertices go around quadrilaterals.
TEST_P(ReferenceCell, FilesHaveEveryNodeOnce) {
  for (const int degree : {1, 2}) {
    for (std::vector<int> order :
         {gmsh_nodes(shape_, degree), vtk_nodes(shape_, degree), meshio_nodes(shape_, degree)}) {
      std::ranges::sort(order);
      std::vector<int> every(static_cast<std::size_t>(node_count(shape_, degree)));
      std::iota(every.begin(), every.end(), 0);
      EXPECT_EQ(order, every) << degree;
    }
    const gmsh::ElementType* const type = gmsh::find_element_type(file_type(shape_, degree).gmsh);
    ASSERT_NE(type, nullptr);
    EXPECT_EQ(type->shape, shape_);
    EXPECT_EQ(type->degree, degree);
  }
  if (d_ == 2) {
    for (std::size_t k = 0; k < describe(shape_).file_vertices.size(); ++k) {
      VertexSet side{gmsh_nodes(shape_, 1)[k], gmsh_nodes(shape_, 1)[(k + 1) % describe(shape_).file_vertices.size()]};
      std::ranges::sort(side);
      EXPECT_EQ(std::count(describe(shape_).edges.begin(), describe(shape_).edges.end(), side), 1);
    }
  }
}

/// The facets of Abaqus are all facets of the cell, outward as its manual has them in space; Exodus' sides are the
/// same.
TEST_P(ReferenceCell, FacetsOfAbaqusAndExodusAreThoseOfTheCell) {
  const CellShapeDescription& cell = describe(shape_);
  const std::set<VertexSet> expected(cell.facets.begin(), cell.facets.end());
  std::set<VertexSet> found;
  for (const VertexSet& facet : cell.abaqus_facets) {
    VertexSet vertices;
    for (const int vertex : facet) vertices.push_back(cell.file_vertices[std::size_t(vertex)]);
    std::ranges::sort(vertices);
    found.insert(vertices);
  }
  EXPECT_EQ(found, expected);
  std::vector<int> sides = cell.exodus_sides;
  std::ranges::sort(sides);
  std::vector<int> every(cell.facets.size());
  std::iota(every.begin(), every.end(), 0);
  EXPECT_EQ(sides, every);
}

/// Arrays of fixed size hold every shape.
TEST_P(ReferenceCell, FitsIntoArraysOfFixedSize) {
  EXPECT_LE(node_count(shape_, 2), most_cell_nodes);
  EXPECT_LE(vertex_count(shape_), 8);  // VertexSetTable
  if (d_ == 3) return;                 // facets
  EXPECT_LE(node_count(shape_, 2), PolynomialShape::most_nodes);
  EXPECT_LE(vertex_count(shape_), 4);  // boundary_facets.cpp
}

/// The height above a facet is the distance of the highest vertex, measured here with unit normals.
TEST_P(ReferenceCell, HasAHeightAboveEachFacet) {
  for (std::size_t f = 0; f < outward_facet_vertices(shape_).size(); ++f) {
    const VertexSet& around = outward_facet_vertices(shape_)[f];
    const Eigen::Vector3d first = reference_position(shape_, {around[0]}),
                          last = reference_position(shape_, {around.back()}) - first;
    Eigen::Vector3d normal = last.cross(Eigen::Vector3d::UnitZ());
    double area = last.norm();
    if (d_ == 3) {
      normal = (reference_position(shape_, {around[1]}) - first).cross(last);
      area = normal.norm() * (around.size() == 3 ? 0.5 : 1.0);  // facets of reference cells are parallelograms
    }
    double highest = 0.0;
    for (const Eigen::Vector3d& vertex : describe(shape_).vertices)
      highest = std::max(highest, std::abs(normal.normalized().dot(vertex - first)));
    EXPECT_NEAR(facet_heights(shape_)[f] * whole() / area, highest, 1e-14) << f;
    EXPECT_TRUE(!is_simplex(shape_) || facet_heights(shape_)[f] == d_) << f;
  }
}

/// An incomplete description is refused by the name of what it lacks.
TEST_P(ReferenceCell, IsCompletelyDescribed) {
  EXPECT_EQ(missing_member(describe(shape_)), "");
  const auto without = [&](auto&& remove) {
    CellShapeDescription cell = describe(shape_);
    remove(cell);
    return missing_member(cell);
  };
  EXPECT_EQ(without([](auto& cell) { cell.edges.clear(); }), "edges");
  EXPECT_EQ(without([](auto& cell) { cell.lagrange = nullptr; }), "lagrange");
  EXPECT_EQ(without([](auto& cell) { cell.file_vertices.pop_back(); }), "file_vertices");
  EXPECT_EQ(without([](auto& cell) { cell.vtk.edges.pop_back(); }), "vtk");
  EXPECT_EQ(without([](auto& cell) { cell.file_types[1] = {}; }), "file_types");
  if (d_ == 1) return;
  EXPECT_EQ(without([](auto& cell) { cell.facets.clear(); }), "facets");
  EXPECT_EQ(without([](auto& cell) { cell.abaqus_facets.pop_back(); }), "abaqus_facets");
  EXPECT_EQ(without([](auto& cell) { cell.exodus_sides.clear(); }), "exodus_sides");
}

INSTANTIATE_TEST_SUITE_P(Shapes, ReferenceCell, testing::ValuesIn(cell_shapes()),
                         [](const auto& instance) { return name(instance.param); });

TEST(CellsOfGmshFiles, MiddleNodesLieAtTheMeanOfTheirVertices) {
  for (const std::string shape : {"triangle", "quadrilateral", "tetrahedron", "hexahedron", "mixed"}) {
    for (const std::string dialect : {"msh22_ascii", "msh22_binary", "msh41_ascii", "msh41_binary"}) {
      const Mesh mesh = read_test_mesh(shape + "_o2_" + dialect + ".msh");
      ASSERT_EQ(mesh.degree, 2);
      for (const auto* blocks : {&mesh.cells, &mesh.facets}) {
        for (const CellBlock& block : *blocks) {
          const auto& nodes = node_vertices(block.shape, 2);
          ASSERT_EQ(block.nodes_per_cell, int(nodes.size()));
          for (Index cell = 0; cell < block.size(); ++cell) {
            for (std::size_t node = 0; node < nodes.size(); ++node) {
              Vector mean = Vector::Zero(mesh.dimension);
              for (const int vertex : nodes[node]) mean += mesh.nodes.col(block.cell(cell)[vertex]);
              mean /= double(nodes[node].size());
              EXPECT_LT((mesh.nodes.col(block.cell(cell)[node]) - mean).norm(), 1e-11)
                  << shape << " " << dialect << " " << name(block.shape) << " node " << node;
            }
          }
        }
      }
    }
  }
}

TEST(CellsOfGmshFiles, VerticesOfTensorCellsAreLexicographic) {
  for (const std::string shape : {"quadrilateral", "hexahedron"}) {
    const Mesh mesh = read_test_mesh(shape + "_o1_msh41_binary.msh");
    for (const CellBlock& block : mesh.cells) {
      for (Index cell = 0; cell < block.size(); ++cell) {
        const auto at = [&](int vertex) { return Vector(mesh.nodes.col(block.cell(cell)[vertex])); };
        // The meshes are of parallelepipeds: each vertex is the first one plus the edges its bits select.
        for (int vertex = 0; vertex < vertex_count(block.shape); ++vertex) {
          Vector expected = at(0);
          for (int axis = 0; axis < mesh.dimension; ++axis) {
            if ((vertex >> axis) & 1) expected += at(1 << axis) - at(0);
          }
          EXPECT_LT((at(vertex) - expected).norm(), 1e-11) << shape << " vertex " << vertex;
        }
      }
    }
  }
}

}  // namespace
}  // namespace ricochet::test_support
