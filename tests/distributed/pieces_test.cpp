#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "distributed/cut_body.hpp"
#include "ricochet/distributed/petsc_preconditioner.hpp"
#include "ricochet/linear_algebra/block_jacobi.hpp"
#include "ricochet/linear_algebra/single_precision_cg.hpp"

// Matrices of pieces add up to those of the whole body, and their solutions agree.

namespace ricochet {
namespace {

using distributed_test::CutBody;
using distributed_test::Variant;

class Pieces : public CutBody, public testing::TestWithParam<Variant> {
 protected:
  Pieces() : CutBody(GetParam()) {}
  [[nodiscard]] static SparseMatrix operator_of(const Body& body) {
    const NodeGraph graph = node_graph(*body.space);
    const SparseMatrix mass = expand_to_components(assemble_scalar_mass(body, graph), body.mesh->dimension);
    return assemble_stiffness(body, graph) + 300.0 * mass;
  }
  [[nodiscard]] static Vector some(Index size) {
    return Vector::NullaryExpr(size, [](Index i) { return std::sin(0.9 * double(i * i % 1013)); });
  }
};

TEST_P(Pieces, AreTheWhole) {
  const Mesh& mesh = whole_->mesh;
  EXPECT_EQ(ranks_.sum(double(piece_.mesh.cell_count())), mesh.cell_count());
  EXPECT_EQ(ranks_.sum(double(piece_.mesh.facet_count())), mesh.facet_count());
  for (std::size_t g = 0; g < mesh.groups.size(); ++g) {
    EXPECT_EQ(piece_.mesh.groups[g].name, mesh.groups[g].name);
    EXPECT_EQ(ranks_.sum(double(piece_.mesh.groups[g].members.size())), mesh.groups[g].members.size());
  }
  // Nodes keep their positions and the numbers of the file.
  for (std::size_t i = 0; i < piece_.node_number.size(); ++i) {
    const auto node = Index(i);
    EXPECT_EQ(piece_.space.nodes.col(node), whole_->space.nodes.col(piece_.node_number[i]));
    EXPECT_EQ(piece_.space.number[i], whole_->space.number[std::size_t(piece_.node_number[i])]);
  }
  // Elements keep their tags, their nodes and their positions in mesh and space.
  for (std::size_t i = 0; i < piece_.cell_number.size(); ++i) {
    const IndexInBlocks here = locate_in_blocks(piece_.mesh.cells, Index(i));
    const IndexInBlocks there = locate_in_blocks(mesh.cells, piece_.cell_number[i]);
    const CellBlock &own = piece_.mesh.cells[here.block], &all = mesh.cells[there.block];
    EXPECT_EQ(own.tags[std::size_t(here.local)], all.tags[std::size_t(there.local)]);
    for (int k = 0; k < own.nodes_per_cell; ++k)
      EXPECT_EQ(piece_.mesh.nodes.col(own.cell(here.local)[k]), mesh.nodes.col(all.cell(there.local)[k]));
  }
}

TEST_P(Pieces, GroupsHaveTheirElements) {
  for (const Group& group : piece_.mesh.groups) {
    const Group* const whole = whole_->mesh.find_group(group.name, group.dimension);
    ASSERT_NE(whole, nullptr);
    const bool of_cells = group.dimension == whole_->mesh.dimension;
    for (const Index member : group.members) {
      const Index number = (of_cells ? piece_.cell_number : piece_.facet_number)[std::size_t(member)];
      EXPECT_TRUE(std::ranges::binary_search(whole->members, number));
    }
  }
}

/// Products and forms of the parts add up to those of the whole.
TEST_P(Pieces, HaveMatricesThatAddUp) {
  const SparseMatrix whole = operator_of(whole_->body);
  const NodeMatrix own(operator_of(own_), d_);
  const Vector x = some(whole.cols()), expected = whole * x;
  Vector y;
  own.multiply(part_of(x), y);
  ranks_.accumulate(y);
  EXPECT_LT((y - part_of(expected)).lpNorm<Eigen::Infinity>(), 1e-12 * expected.lpNorm<Eigen::Infinity>());
  EXPECT_NEAR(ranks_.sum(own.quadratic_form(part_of(x))), x.dot(expected), 1e-12 * whole.norm() * x.squaredNorm());
  EXPECT_NEAR(dot_product(part_of(x), part_of(expected), ranks_, d_), x.dot(expected),
              1e-12 * x.norm() * expected.norm());
}

/// A factor by MUMPS is exact; multigrid is symmetric and positive, and needs few iterations.
TEST_P(Pieces, HavePreconditionersOfTheWhole) {
  const SparseMatrix whole = operator_of(whole_->body), part = operator_of(own_);
  std::vector<char> solved;
  for (const std::int64_t node : piece_.node_number) {
    for (int k = 0; k < d_; ++k) solved.push_back((node * d_ + k) % 11 == 3 ? 0 : 1);
  }
  const auto mask = [&](Vector& values) {
    for (Index dof = 0; dof < values.size(); ++dof) values[dof] *= solved[std::size_t(dof)];
  };
  const NodeMatrix matrix(part, d_);
  const auto product = [&](const Vector& x, Vector& y) {
    matrix.multiply(x, y);
    ranks_.accumulate(y);
    mask(y);
  };
  Vector x = part_of(some(whole.cols())), other = part_of(Vector(some(whole.cols()).reverse())), image, z, of_other;
  mask(x);
  mask(other);
  product(x, image);
  const auto maker = make_petsc_preconditioners();
  for (const char* const kind : {"gamg", "boomeramg", "mumps"}) {
    const auto preconditioner = maker->make(kind, part, solved, piece_.space.nodes, ranks_);
    preconditioner->apply(image, z);
    if (kind == std::string("mumps")) {
      EXPECT_LT((z - x).lpNorm<Eigen::Infinity>(), 1e-10 * x.lpNorm<Eigen::Infinity>());
    }
    // Ranks that share a node have the same bits.
    Vector owners = z;
    exchange_.copy_from_owners(owners);
    EXPECT_EQ(owners, z);
    preconditioner->apply(other, of_other);
    const double one = dot_product(other, z, ranks_, d_), two = dot_product(of_other, image, ranks_, d_);
    EXPECT_NEAR(one, two, 1e-10 * std::abs(one)) << kind;
    EXPECT_GT(dot_product(image, z, ranks_, d_), 0.0);
    ConjugateGradients gradients(d_, ranks_);
    Vector residual = image, found = Vector::Zero(x.size());
    const double target = 1e-10 * gradients.norm(*preconditioner, residual);
    const auto result = gradients.solve(product, *preconditioner, target, 1000, residual, found);
    EXPECT_TRUE(result.converged);
    EXPECT_LT(result.iterations, 30) << kind;
    EXPECT_LT((found - x).lpNorm<Eigen::Infinity>(), 1e-8 * x.lpNorm<Eigen::Infinity>()) << kind << result.iterations;
  }
}

/// Supported nodes are also in the matrix of a preconditioner: the result must not depend on the units of its entries.
TEST_P(Pieces, ArePreconditionedInAnyUnits) {
  const SparseMatrix part = operator_of(own_);
  std::vector<char> solved;
  for (const std::int64_t node : piece_.node_number) {
    for (int k = 0; k < d_; ++k) solved.push_back((node * d_ + k) % 11 == 3 ? 0 : 1);
  }
  Vector force = part_of(some(whole_->space.node_count() * d_)), one, other;
  for (Index dof = 0; dof < force.size(); ++dof) force[dof] *= solved[std::size_t(dof)];
  const auto maker = make_petsc_preconditioners();
  for (const char* const kind : {"gamg", "boomeramg", "mumps"}) {
    maker->make(kind, part, solved, piece_.space.nodes, ranks_)->apply(force, one);
    for (const double unit : {std::ldexp(1.0, -30), std::ldexp(1.0, 30)}) {
      maker->make(kind, unit * part, solved, piece_.space.nodes, ranks_)->apply(force, other);
      for (Index dof = 0; dof < force.size(); ++dof) other[dof] *= solved[std::size_t(dof)] != 0 ? unit : 1.0;
      // PETSc estimates eigenvalues for its smoothers, which changes 2e-7. A one on these diagonals changes 0.02 and
      // more.
      EXPECT_LT((other - one).lpNorm<Eigen::Infinity>(), 1e-4 * one.lpNorm<Eigen::Infinity>()) << kind << unit;
    }
  }
}

TEST_P(Pieces, HaveNoPreconditionersOfUnknownNames) {
  const SparseMatrix part = operator_of(own_);
  const std::vector<char> solved(static_cast<std::size_t>(part.cols()), 1);
  EXPECT_THROW((void)make_petsc_preconditioners()->make("ggma", part, solved, piece_.space.nodes, ranks_), Error);
}

/// Conjugate gradients in both precisions need as many iterations as on one rank, with the same result.
TEST_P(Pieces, AreSolvedAsTheWhole) {
  const SparseMatrix whole = operator_of(whole_->body), part = operator_of(own_);
  const NodeMatrix whole_blocks(whole, d_), own(part, d_);
  const Vector force = some(whole.cols());
  std::vector<char> whole_solved(static_cast<std::size_t>(whole.cols()), 1);
  for (std::size_t dof = 3; dof < whole_solved.size(); dof += 11) whole_solved[dof] = 0;
  Vector masked = force;
  for (Index dof = 0; dof < force.size(); ++dof) masked[dof] *= whole_solved[std::size_t(dof)];
  std::vector<char> solved;
  for (const std::int64_t node : piece_.node_number) {
    for (int k = 0; k < d_; ++k) solved.push_back(whole_solved[std::size_t(node * d_ + k)]);
  }
  const auto rounds = [](const NodeMatrix& matrix, const std::vector<char>& taken, const Vector& right, int d,
                         const Ranks& ranks) {
    Vector diagonal = matrix.diagonal_blocks();
    ranks.accumulate(diagonal);
    SinglePrecisionCg single(matrix, diagonal, taken, ranks);
    ConjugateGradients gradients(d, ranks);
    const auto blocks = make_block_jacobi(diagonal, d, taken);
    Vector x = Vector::Zero(right.size()), residual = right, image;
    const auto product = [&](const Vector& a, Vector& b) {
      matrix.multiply(a, b);
      ranks.accumulate(b);
      for (Index dof = 0; dof < b.size(); ++dof) b[dof] *= taken[std::size_t(dof)];
    };
    const double target = 1e-13 * gradients.norm(*blocks, residual);
    std::pair<int, int> iterations;
    for (int round = 0; round < 2; ++round) {
      iterations.first += single.solve(residual, 1e-5, 1000, x).iterations;
      product(x, image);
      residual = right - image;
    }
    iterations.second = gradients.solve(product, *blocks, target, 1000, residual, x).iterations;
    return std::pair(x, iterations);
  };
  const auto [expected, iterations] = rounds(whole_blocks, whole_solved, masked, d_, one_rank());
  const auto [found, iterations_found] = rounds(own, solved, part_of(masked), d_, ranks_);
  EXPECT_LT((found - part_of(expected)).lpNorm<Eigen::Infinity>(), 1e-11 * expected.lpNorm<Eigen::Infinity>());
  EXPECT_NEAR(iterations_found.first, iterations.first, 2);
  EXPECT_NEAR(iterations_found.second, iterations.second, 3);
  // Shared nodes have the same bits on all that share them.
  Vector owners = found;
  exchange_.copy_from_owners(owners);
  EXPECT_EQ(owners, found);
}

INSTANTIATE_TEST_SUITE_P(All, Pieces, testing::ValuesIn(distributed_test::variants()),
                         [](const auto& info) { return info.param.name(); });

}  // namespace
}  // namespace ricochet
