#include "ricochet/linear_algebra/node_matrix.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "ricochet/base/node_order.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/fem/assembly.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "support/box_mesh.hpp"

namespace ricochet::test_support {
namespace {

/// A body large enough for several parts.
std::unique_ptr<MeshedBody> body_of(int d) {
  return make_meshed_body(make_box_mesh(d == 2 ? BoxMesh{CellShape::triangle, {70, 61}, 1, 0.15, {}}
                                               : BoxMesh{CellShape::tetrahedron, {17, 16, 15}, 1, 0.15, {}}),
                          1);
}

SparseMatrix stiffness_of(const MeshedBody& test) { return assemble_stiffness(test.body, node_graph(test.space)); }
SparseMatrix mass_of(const MeshedBody& test) {
  return expand_to_components(assemble_scalar_mass(test.body, node_graph(test.space)), test.space.dimension);
}

/// Each entry is a sum of at most `terms` products, in another order: rounding of a few times |A| |x|.
void expect_product(const NodeMatrix& matrix, const SparseMatrix& whole, const Vector& x) {
  Vector y;
  matrix.multiply(x, y);
  const Vector expected = whole * x;
  const Vector terms = whole.cwiseAbs() * x.cwiseAbs();
  ASSERT_EQ(y.size(), expected.size());
  constexpr double rounding = 20.0 * std::numeric_limits<double>::epsilon();
  for (Index i = 0; i < y.size(); ++i) EXPECT_LE(std::abs(y[i] - expected[i]), rounding * terms[i]) << i;
  EXPECT_LE(std::abs(matrix.quadratic_form(x) - x.dot(expected)), rounding * x.cwiseAbs().dot(terms));
}

TEST(NodeMatrix, MultipliesAsTheWholeMatrixDoes) {
  for (const int d : {2, 3}) {
    const auto test = body_of(d);
    EXPECT_GE(node_parts(test->space.node_count()).size(), 5U);
    const SparseMatrix stiffness = stiffness_of(*test);
    const SparseMatrix mass = mass_of(*test);
    const NodeMatrix blocks(stiffness, d), scalars(mass, d);
    EXPECT_FALSE(blocks.is_scalar());
    EXPECT_TRUE(scalars.is_scalar());
    const Vector x = Vector::Random(stiffness.cols());
    expect_product(blocks, stiffness, x);
    expect_product(scalars, mass, x);
    EXPECT_LT(double(blocks.bytes()), 0.6 * 12.0 * double(stiffness.nonZeros()));
    // The stored matrix equals the given one, entry by entry.
    for (const auto& [stored, given] : {std::pair{&blocks, &stiffness}, std::pair{&scalars, &mass}}) {
      EXPECT_EQ(stored->diagonal(), Vector(given->diagonal()));
      EXPECT_FALSE(stored->is_diagonal());
      const SparseMatrix whole = stored->to_sparse();
      ASSERT_EQ(whole.nonZeros(), given->nonZeros());
      for (Index k = 0; k < whole.nonZeros(); ++k) {
        ASSERT_EQ(whole.innerIndexPtr()[k], given->innerIndexPtr()[k]);
        ASSERT_EQ(whole.valuePtr()[k], given->valuePtr()[k]);
      }
    }
  }
}

/// Patterns none of which contains another, blocks and scalars: sums equal those of sparse matrices to the bit.
TEST(NodeMatrix, AddsUp) {
  for (const int d : {2, 3}) {
    const auto test = body_of(d);
    SparseMatrix stiffness = stiffness_of(*test), mass = mass_of(*test);
    const auto is_cut = [d](Index dof) { return dof / d % 7 == 3; };
    mass.prune(
        [&](Index row, Index column, double) { return row / d == column / d || !is_cut((row / d + column / d) * d); });
    SparseMatrix wide = SparseMatrix(mass * mass);  // second neighbours
    wide = SparseMatrix(0.5 * (wide + SparseMatrix(wide.transpose())));
    stiffness.prune([&](Index row, Index column, double) {
      return row / d == column / d || !is_cut((row / d) * (column / d) * d);
    });
    const NodeMatrix first(mass, d), second(stiffness, d), third(wide, d);
    const NodeMatrix sum({{0.3, &first}, {-1.7, &second}, {2.5, &third}});
    SparseMatrix expected = 0.3 * mass;
    expected = add_sparse(expected, SparseMatrix(-1.7 * stiffness));
    expected = add_sparse(expected, SparseMatrix(2.5 * wide));
    const Vector x = Vector::Random(expected.cols());
    expect_product(sum, expected, x);
    const SparseMatrix difference = SparseMatrix(sum.to_sparse() - expected);
    EXPECT_EQ(difference.norm(), 0.0);
    EXPECT_EQ(sum.pattern().column, NodeMatrix(expected, d).pattern().column);
    EXPECT_EQ(sum.diagonal(), Vector(expected.diagonal()));
    const Vector blocks = sum.diagonal_blocks();
    for (Index dof = 0; dof < expected.cols(); ++dof) {
      for (int k = 0; k < d; ++k) {
        EXPECT_EQ(blocks[dof * d + k], expected.coeff(dof / d * d + k, dof));
      }
    }
    // A sum of scalar matrices is scalar.
    EXPECT_TRUE(NodeMatrix({{0.3, &first}, {2.0, &first}}).is_scalar());
    EXPECT_EQ(NodeMatrix({{1.0, &first}, {2.0, &first}}).diagonal(), 3.0 * first.diagonal());
  }
}

TEST(NodeMatrix, GivesTheRowsAndColumnsOfNodes) {
  for (const int d : {2, 3}) {
    const auto test = body_of(d);
    std::vector<Index> nodes;
    std::vector<int> number(static_cast<std::size_t>(d * test->space.node_count()), -1);
    for (Index node = 7; node < test->space.node_count(); node += 1 + node % 3) {
      for (int k = 0; k < d; ++k) number[std::size_t(node * d + k)] = int(nodes.size()) * d + k;
      nodes.push_back(node);
    }
    const auto size = Index(nodes.size()) * d;
    for (const SparseMatrix& whole : {stiffness_of(*test), mass_of(*test)}) {
      const SparseMatrix expected = extract(whole, number, size, number, size);
      const SparseMatrix found = NodeMatrix(whole, d).principal(nodes);
      ASSERT_GT(expected.nonZeros(), size);
      EXPECT_EQ(found.nonZeros(), expected.nonZeros());
      EXPECT_EQ(SparseMatrix(found - expected).norm(), 0.0);
      std::vector<int> all(number.size());
      std::iota(all.begin(), all.end(), 0);
      const SparseMatrix columns = extract(whole, all, whole.rows(), number, size);
      const SparseMatrix found_columns = NodeMatrix(whole, d).columns(nodes);
      ASSERT_GT(columns.nonZeros(), expected.nonZeros());
      EXPECT_EQ(found_columns.nonZeros(), columns.nonZeros());
      EXPECT_EQ(SparseMatrix(found_columns - columns).norm(), 0.0);
    }
  }
}

/// xᵀ(A y) = yᵀ(A x), to rounding of the two sums.
TEST(NodeMatrix, IsSymmetric) {
  for (const int d : {2, 3}) {
    const auto test = body_of(d);
    const SparseMatrix stiffness = stiffness_of(*test);
    const NodeMatrix matrix(stiffness, d);
    const Vector x = Vector::Random(stiffness.cols()), y = Vector::Random(stiffness.cols());
    Vector ax, ay;
    matrix.multiply(x, ax);
    matrix.multiply(y, ay);
    const double terms = x.cwiseAbs().dot(stiffness.cwiseAbs() * y.cwiseAbs());
    EXPECT_NEAR(x.dot(ay), y.dot(ax), 1e-15 * terms);
  }
}

TEST(NodeMatrix, GivesTheSameBitsForAnyNumberOfThreads) {
  for (const int d : {2, 3}) {
    const auto test = body_of(d);
    const NodeMatrix stiffness(stiffness_of(*test), d), mass(mass_of(*test), d);
    const Vector x = Vector::Random(stiffness.size());
    for (const NodeMatrix* matrix : {&stiffness, &mass}) {
      Vector alone, several;
      matrix->multiply(x, alone);
      const double form = matrix->quadratic_form(x);
      for (const int threads : {2, 3}) {
        set_thread_count(threads);
        matrix->multiply(x, several);
        EXPECT_EQ(alone, several) << threads;
        EXPECT_EQ(matrix->quadratic_form(x), form) << threads;
        const NodeMatrix again(matrix->to_sparse(), d);
        again.multiply(x, several);
        EXPECT_EQ(alone, several) << "made by " << threads;
        set_thread_count(1);
      }
    }
  }
}

TEST(NodeMatrix, ScalesByPowersOfTwoToTheBit) {
  const auto test = body_of(3);
  const SparseMatrix stiffness = stiffness_of(*test);
  const NodeMatrix matrix(stiffness, 3);
  const NodeMatrix scaled(SparseMatrix(std::ldexp(1.0, 70) * stiffness), 3);
  const Vector x = Vector::Random(matrix.size());
  Vector y, scaled_y;
  matrix.multiply(x, y);
  scaled.multiply(std::ldexp(1.0, -33) * x, scaled_y);
  EXPECT_EQ(Vector(std::ldexp(1.0, 37) * y), scaled_y);
  EXPECT_EQ(std::ldexp(1.0, 4) * matrix.quadratic_form(x), scaled.quadratic_form(std::ldexp(1.0, -33) * x));
}

/// Matrices that are not of the form m ⊗ I although they begin so, or whose blocks are not full.
TEST(NodeMatrix, TakesAnySymmetricPattern) {
  const auto test = body_of(2);
  const Vector x = Vector::Random(test->space.dof_count());
  const SparseMatrix mass = mass_of(*test);
  {
    SparseMatrix other = mass;  // one component of one node is heavier
    other.coeffRef(11, 11) *= 2.0;
    const NodeMatrix matrix(other, 2);
    EXPECT_FALSE(matrix.is_scalar());
    expect_product(matrix, other, x);
  }
  {
    SparseMatrix other = mass;  // two components of one node are coupled
    other.coeffRef(10, 11) = other.coeffRef(11, 10) = 0.5 * mass.coeff(11, 11);
    EXPECT_FALSE(other.isCompressed());
    const NodeMatrix matrix(other, 2);
    EXPECT_FALSE(matrix.is_scalar());
    expect_product(matrix, other, x);
  }
  {
    SparseMatrix diagonal(mass.rows(), mass.cols());
    diagonal.setIdentity();
    const NodeMatrix matrix(diagonal, 2);
    EXPECT_TRUE(matrix.is_scalar());
    EXPECT_TRUE(matrix.is_diagonal());
    const Vector values = Vector::LinSpaced(x.size() / 2, 1.0, 3.0);
    SparseMatrix scaled = diagonal;
    for (Index i = 0; i < x.size(); ++i) scaled.coeffRef(i, i) = values[i / 2];
    EXPECT_NEAR(NodeMatrix(scaled, 2).quadratic_form(x), x.dot(scaled * x), 1e-14 * x.dot(scaled * x));
    EXPECT_EQ(matrix.diagonal(), Vector(Vector::Ones(x.size())));
    Vector y;
    matrix.multiply(x, y);
    EXPECT_EQ(x, y);
  }
  {
    // Diagonal blocks only, full or not.
    SparseMatrix blocks(mass.rows(), mass.cols());
    for (Index i = 0; i < mass.rows(); ++i) blocks.insert(i, i) = 2.0 + double(i % 2);
    EXPECT_TRUE(NodeMatrix(blocks, 2).is_diagonal());
    EXPECT_EQ(NodeMatrix(blocks, 2).diagonal(), Vector(blocks.diagonal()));
    blocks.insert(0, 1) = blocks.insert(1, 0) = 0.5;
    EXPECT_FALSE(NodeMatrix(blocks, 2).is_diagonal());
    EXPECT_EQ(NodeMatrix(blocks, 2).diagonal(), Vector(blocks.diagonal()));
  }
  {
    const SparseMatrix empty(mass.rows(), mass.cols());
    const NodeMatrix matrix(empty, 2);
    Vector y;
    matrix.multiply(x, y);
    EXPECT_EQ(y, Vector(Vector::Zero(x.size())));
    EXPECT_EQ(matrix.quadratic_form(x), 0.0);
    EXPECT_EQ(matrix.to_sparse().nonZeros(), 0);
    EXPECT_EQ(matrix.diagonal(), Vector(Vector::Zero(x.size())));
  }
}

/// Neighbouring nodes get nearby numbers: most neighbours are in the same part.
TEST(NodeOrder, KeepsNeighboursTogether) {
  for (const int d : {2, 3}) {
    const auto test = body_of(d);
    const std::vector<Index> begins = node_parts(test->space.node_count());
    EXPECT_EQ(begins.front(), 0);
    EXPECT_EQ(begins.back(), test->space.node_count());
    std::vector<std::size_t> part(static_cast<std::size_t>(begins.back()));
    for (std::size_t k = 0; k + 1 < begins.size(); ++k)
      std::fill(part.begin() + begins[k], part.begin() + begins[k + 1], k);
    const NodeGraph graph = node_graph(test->space);
    Index across = 0;
    for (std::size_t node = 0; node < part.size(); ++node) {
      for (Index k = graph.offsets[node]; k < graph.offsets[node + 1]; ++k) {
        const auto neighbour = std::size_t(graph.neighbours[std::size_t(k)]);
        across += part[node] != part[neighbour] ? 1 : 0;
      }
    }
    const double share = double(across) / double(graph.neighbours.size());
    EXPECT_LT(share, d == 2 ? 0.06 : 0.15);
  }
}

}  // namespace
}  // namespace ricochet::test_support
