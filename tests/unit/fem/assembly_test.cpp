#include "ricochet/fem/assembly.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/parallel.hpp"
#include "ricochet/fem/cell_rotations.hpp"
#include "ricochet/mass/mass.hpp"
#include "support/box_mesh.hpp"

namespace ricochet::test_support {
namespace {

/// Under sanitizers thousands of curved cells take minutes, so fewer are assembled.
#ifdef __SANITIZE_ADDRESS__
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

/// More than 2048 nodes, so that the work has several parts; `just` a little more.
std::unique_ptr<MeshedBody> large_body(const ElementKind& kind, bool just = false) {
  const int per_axis = kind.dimension() == 2 ? (just ? 46 : 48) : (just ? 12 : 14);
  const int count = per_axis / kind.displacement_degree + (just ? 0 : 1);
  const BoxMesh box{kind.shape, std::vector<int>(std::size_t(kind.dimension()), count), kind.geometry_degree, 0.15, {}};
  return make_meshed_body(make_box_mesh(box), kind.displacement_degree);
}

void expect_same_bits(const SparseMatrix& a, const SparseMatrix& b) {
  ASSERT_EQ(a.nonZeros(), b.nonZeros());
  for (Index k = 0; k < a.nonZeros(); ++k) {
    ASSERT_EQ(a.innerIndexPtr()[k], b.innerIndexPtr()[k]);
    ASSERT_EQ(a.valuePtr()[k], b.valuePtr()[k]);
  }
}

class Assembly : public testing::TestWithParam<ElementKind> {};

TEST_P(Assembly, IsExactlySymmetricAndTheSameBitsForAnyNumberOfThreads) {
  const auto test = large_body(GetParam(), sanitized);
  const NodeGraph graph = node_graph(test->space);
  EXPECT_GT(graph.parts(), 1);
  const SparseMatrix mass = assemble_scalar_mass(test->body, graph);
  const SparseMatrix stiffness = assemble_stiffness(test->body, graph);
  expect_same_bits(mass, mass.transpose());
  expect_same_bits(stiffness, stiffness.transpose());
  for (const int threads : sanitized ? std::vector{2} : std::vector{2, 3}) {
    set_thread_count(threads);
    const NodeGraph again = node_graph(test->space);
    EXPECT_EQ(again.offsets, graph.offsets);
    EXPECT_EQ(again.neighbours, graph.neighbours);
    expect_same_bits(assemble_scalar_mass(test->body, again), mass);
    expect_same_bits(assemble_stiffness(test->body, again), stiffness);
    set_thread_count(1);
  }
}

/// All kinds; under the sanitizers without those that have many curved cells for few nodes.
std::vector<ElementKind> assembled_kinds() {
  std::vector<ElementKind> result = all_element_kinds();
  std::erase_if(result, [](const ElementKind& kind) {
    return sanitized && kind.dimension() == 3 && kind.geometry_degree > kind.displacement_degree;
  });
  return result;
}

INSTANTIATE_TEST_SUITE_P(Elements, Assembly, testing::ValuesIn(assembled_kinds()),
                         [](const auto& info) { return info.param.label(); });

/// The graph holds exactly the pairs of nodes of the cells.
TEST(NodeGraph, HoldsTheNodesThatShareACell) {
  const auto test = large_body({CellShape::tetrahedron, 1, 1});
  const NodeGraph graph = node_graph(test->space);
  SparseMatrix expected(test->space.node_count(), test->space.node_count());
  std::vector<Eigen::Triplet<double>> pairs;
  for (const CellBlock& block : test->space.cells) {
    for (Index cell = 0; cell < block.size(); ++cell) {
      for (int i = 0; i < block.nodes_per_cell; ++i) {
        for (int j = 0; j < block.nodes_per_cell; ++j) {
          pairs.emplace_back(int(block.cell(cell)[i]), int(block.cell(cell)[j]), 1.0);
        }
      }
    }
  }
  expected.setFromTriplets(pairs.begin(), pairs.end());
  ASSERT_EQ(Index(graph.neighbours.size()), expected.nonZeros());
  for (Index k = 0; k < expected.nonZeros(); ++k)
    ASSERT_EQ(graph.neighbours[std::size_t(k)], expected.innerIndexPtr()[k]);
}

TEST(EquivalentMass, IsTheSameBitsForAnyNumberOfThreads) {
  const auto test = large_body({CellShape::tetrahedron, 1, 1});
  const SparseMatrix consistent = assemble_scalar_mass(test->body, node_graph(test->space));
  MassInput input{&consistent, &test->space.nodes, facet_nodes(test->space, test->mesh.group("y0", 2).members)};
  const SparseMatrix mass = build_mass("equivalent", input);
  expect_same_bits(mass, mass.transpose());
  set_thread_count(3);
  expect_same_bits(build_mass("equivalent", input), mass);
  set_thread_count(1);
}

/// A cell that rotates more than the others is found in any position, on straight simplices and on other cells.
TEST(CellRotations, FindsTheCellThatTurnsMost) {
  for (const ElementKind& kind :
       {ElementKind{CellShape::triangle, 1, 1}, ElementKind{CellShape::tetrahedron, 1, 1},
        ElementKind{CellShape::tetrahedron, 2, 2}, ElementKind{CellShape::quadrilateral, 1, 1}}) {
    const auto test = large_body(kind);
    const int d = kind.dimension();
    const CellRotations gauge(test->body);
    // A rotation of the whole body by 0.3, exact for any angle below π.
    Matrix turn = Matrix::Identity(d, d);
    turn.topLeftCorner(2, 2) << std::cos(0.3), -std::sin(0.3), std::sin(0.3), std::cos(0.3);
    Vector u(test->space.dof_count());
    for (Index node = 0; node < test->space.node_count(); ++node) {
      const Vector x = test->space.nodes.col(node);
      u.segment(node * d, d) = turn * x - x + Vector::Constant(d, 7.0);
    }
    EXPECT_NEAR(gauge.largest(u), 0.3, 1e-11) << kind.label();
    // One node moved: the cell with the largest rotation is one of its cells.
    const std::vector<Index>& numbers = test->space.number;
    const Index node = std::ranges::max_element(numbers) - numbers.begin();
    u.setZero();
    u[node * d] = 0.01;
    const double alone = gauge.largest(u);
    EXPECT_GT(alone, 0.05);
    set_thread_count(3);
    EXPECT_EQ(gauge.largest(u), alone);
    set_thread_count(1);
    EXPECT_EQ(gauge.largest(Vector(Vector::Zero(u.size()))), 0.0);
  }
}

/// Angle of a cell of degree 1 from the gradient, by dense algebra.
double rotation_of_simplex(const Points& nodes, const Vector& u, const Index* cell) {
  const Index d = nodes.rows();
  Matrix edges(d, d), differences(d, d);
  for (Index e = 0; e < d; ++e) {
    edges.col(e) = nodes.col(cell[e + 1]) - nodes.col(cell[0]);
    differences.col(e) = u.segment(cell[e + 1] * d, d) - u.segment(cell[0] * d, d);
  }
  const Matrix h = differences * edges.inverse();
  const double axial = d == 2 ? std::abs(h(1, 0) - h(0, 1))
                              : Eigen::Vector3d(h(2, 1) - h(1, 2), h(0, 2) - h(2, 0), h(1, 0) - h(0, 1)).norm();
  return std::atan2(axial, 2.0 + h.trace());
}

/// Cells are evaluated in packs: the one with the largest rotation is found, for every angle.
TEST(CellRotations, FindsTheLargestOfAllCells) {
  for (const CellShape shape : {CellShape::triangle, CellShape::tetrahedron}) {
    const auto test = large_body({shape, 1, 1});
    const CellRotations gauge(test->body);
    const CellBlock& cells = test->space.cells.front();
    const auto largest = [&](const Vector& u) {
      double result = 0.0;
      for (Index cell = 0; cell < cells.size(); ++cell)
        result = std::max(result, rotation_of_simplex(test->space.nodes, u, cells.cell(cell)));
      return result;
    };
    const Index d = test->space.nodes.rows(), nodes = test->space.node_count();
    // From negligible angles to beyond a right angle, where 2 + the divergence is negative in some cells.
    for (const double size : {1e-9, 1e-3, 1e-2, 10.0}) {
      const Vector u =
          size * Vector::NullaryExpr(nodes * d, [](Index i) { return std::sin(0.7 * double(i * i % 1009)); });
      const double wanted = largest(u);
      EXPECT_NEAR(gauge.largest(u), wanted, 1e-12 * wanted) << size;
      EXPECT_TRUE(size < 10.0 || wanted > 2.0) << wanted;
      EXPECT_TRUE(size > 1e-9 || wanted < 1e-6) << wanted;
    }
    // One node at a time, including the first and the last ones.
    for (Index node = 0; node < nodes; node += node < 3 || node >= nodes - 4 ? 1 : (nodes - 7) / 5) {
      Vector u = Vector::Zero(nodes * d);
      u[node * d] = 0.01;
      const double wanted = largest(u);
      EXPECT_NEAR(gauge.largest(u), wanted, 1e-12 * wanted) << node;
    }
  }
}

}  // namespace
}  // namespace ricochet::test_support
