#include "ricochet/mesh/reference_cell.hpp"

#include <basix/cell.h>
#include <basix/finite-element.h>
#include <gtest/gtest.h>

#include "support.hpp"

namespace ricochet::test_support {
namespace {

basix::cell::type basix_cell(CellShape shape) {
  switch (shape) {
    case CellShape::interval:
      return basix::cell::type::interval;
    case CellShape::triangle:
      return basix::cell::type::triangle;
    case CellShape::quadrilateral:
      return basix::cell::type::quadrilateral;
    case CellShape::tetrahedron:
      return basix::cell::type::tetrahedron;
    case CellShape::hexahedron:
      return basix::cell::type::hexahedron;
  }
  return basix::cell::type::point;
}

constexpr CellShape all_shapes[] = {CellShape::interval, CellShape::triangle, CellShape::quadrilateral,
                                    CellShape::tetrahedron, CellShape::hexahedron};

TEST(ReferenceCell, NodesAreThoseOfBasixInItsOrder) {
  for (const CellShape shape : all_shapes) {
    for (const int degree : {1, 2}) {
      const auto element = basix::create_element(basix::element::family::P, basix_cell(shape), degree,
                                                 basix::element::lagrange_variant::gll_warped);
      const auto& [points, extents] = element.points();
      const auto& nodes = node_vertices(shape, degree);
      ASSERT_EQ(nodes.size(), extents[0]) << name(shape);
      ASSERT_EQ(nodes.size(), static_cast<std::size_t>(node_count(shape, degree)));
      for (std::size_t node = 0; node < nodes.size(); ++node) {
        for (int axis = 0; axis < dimension(shape); ++axis) {
          double mean = 0.0;
          for (const int vertex : nodes[node]) mean += vertex_coordinate(shape, vertex, axis);
          mean /= static_cast<double>(nodes[node].size());
          EXPECT_NEAR(mean, points[node * extents[1] + static_cast<std::size_t>(axis)], 1e-14)
              << name(shape) << " degree " << degree << " node " << node;
        }
      }
    }
  }
}

TEST(ReferenceCell, FacetsAreThoseOfBasixInItsOrder) {
  for (const CellShape shape : all_shapes) {
    if (shape == CellShape::interval) continue;
    const auto topology = basix::cell::topology(basix_cell(shape));
    const auto& expected = topology[static_cast<std::size_t>(dimension(shape) - 1)];
    EXPECT_EQ(facet_nodes(shape, 1), expected) << name(shape);
    const auto& second = facet_nodes(shape, 2);
    ASSERT_EQ(second.size(), expected.size());
    for (std::size_t facet = 0; facet < second.size(); ++facet) {
      const auto& local = node_vertices(facet_shape(shape), 2);
      ASSERT_EQ(second[facet].size(), local.size());
      for (std::size_t node = 0; node < local.size(); ++node) {
        std::vector<int> vertices;
        for (const int vertex : local[node]) vertices.push_back(expected[facet][static_cast<std::size_t>(vertex)]);
        EXPECT_EQ(node_vertices(shape, 2)[static_cast<std::size_t>(second[facet][node])], vertices);
      }
    }
  }
}

TEST(ReferenceCell, MiddleNodesOfGmshFilesLieAtTheMeanOfTheirVertices) {
  for (const std::string shape : {"triangle", "quadrilateral", "tetrahedron", "hexahedron", "mixed"}) {
    for (const std::string dialect : {"msh22_ascii", "msh22_binary", "msh41_ascii", "msh41_binary"}) {
      const Mesh mesh = read_test_mesh(shape + "_o2_" + dialect + ".msh");
      ASSERT_EQ(mesh.degree, 2);
      for (const auto* blocks : {&mesh.cells, &mesh.facets}) {
        for (const CellBlock& block : *blocks) {
          const auto& nodes = node_vertices(block.shape, 2);
          ASSERT_EQ(block.nodes_per_cell, static_cast<int>(nodes.size()));
          for (Index cell = 0; cell < block.size(); ++cell) {
            for (std::size_t node = 0; node < nodes.size(); ++node) {
              Vector mean = Vector::Zero(mesh.dimension);
              for (const int vertex : nodes[node]) mean += mesh.nodes.col(block.cell(cell)[vertex]);
              mean /= static_cast<double>(nodes[node].size());
              EXPECT_LT((mesh.nodes.col(block.cell(cell)[node]) - mean).norm(), 1e-11)
                  << shape << " " << dialect << " " << name(block.shape) << " node " << node;
            }
          }
        }
      }
    }
  }
}

TEST(ReferenceCell, VerticesOfTensorCellsAreLexicographic) {
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
