#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "ricochet/base/parallel.hpp"
#include "ricochet/fem/elastic_cells.hpp"
#include "support/box_mesh.hpp"

/// @file Forces and energies do not depend on the distribution of cells over parts, packs and threads.
namespace ricochet::test_support {
namespace {

/// Some thousand nodes, for several parts, and two materials in adjacent cells, so that packs are not full.
struct LargeBody {
  explicit LargeBody(const ElementKind& kind) {
    const int per_axis = (kind.dimension() == 2 ? 80 : 17) / kind.displacement_degree;
    BoxMesh box = box_of(kind.shape, std::vector<int>(std::size_t(kind.dimension()), per_axis));
    box.geometry_degree = kind.geometry_degree;
    body = make_meshed_body(make_box_mesh(box), kind.displacement_degree);
    Material& first = body->body.materials[0];
    first.law = make_material_law("neo-hookean", {{"lambda", 1.3}, {"mu", 0.8}});
    body->body.materials.push_back(first);
    body->body.materials[1].law =
        make_material_law("mooney-rivlin", {{"c10", 0.3}, {"c01", 0.1}, {"bulk_modulus", 2.0}});
    body->body.materials[1].mean_dilatation = true;
    for (std::size_t cell = 0; cell < body->body.cell_material.size(); ++cell)
      body->body.cell_material[cell] = cell % 7 < 3 ? 1 : 0;
    displacement = interpolate(body->space, [&](const Vector& x) {
      Vector u(x.size());
      for (Index a = 0; a < x.size(); ++a) u[a] = 0.05 * std::sin(5.0 * x[0] + 3.0 * x[1] + double(a));
      return u;
    });
    increment = interpolate(body->space, [&](const Vector& x) {
      return Vector(Vector::Constant(x.size(), 0.03 * std::cos(4.0 * x[1] - 2.0 * x[0])));
    });
  }
  std::unique_ptr<MeshedBody> body;
  Vector displacement, increment;
};

/// Some cells of a pack have other rules than the others.
PathRules some_rules(const LargeBody& of) {
  PathRules rules(of.body->body.cell_material.size());
  for (std::size_t cell = 0; cell < rules.size(); ++cell)
    rules[cell] = PathRule(cell * cell % 7 % path_rule_table.size());
  return rules;
}

struct Forces {
  Forces(const LargeBody& of, const NodeGraph& graph, const std::vector<int>& some = {}) {
    const ElasticCells cells(of.body->body, &graph, some);
    EXPECT_EQ(cells.force(of.displacement, force).cell, -1);
    EXPECT_EQ(cells.path_force(of.displacement, of.increment, some_rules(of), path).cell, -1);
    energy = cells.energy(of.displacement);
  }
  Vector force, path;
  double energy = 0.0;
};

NodeGraph whole(const NodeGraph& graph, Index cells) {
  NodeGraph result = graph;
  result.part_begins = {0, graph.node_count()};
  result.cell_begins = {0, cells};
  result.cells.resize(std::size_t(cells));
  std::iota(result.cells.begin(), result.cells.end(), 0);
  return result;
}

class CellPacksOfKind : public ::testing::TestWithParam<ElementKind> {};

TEST_P(CellPacksOfKind, ForcesAreTheSameInOnePartAndInMany) {
  const LargeBody test(GetParam());
  const NodeGraph graph = node_graph(test.body->space);
  ASSERT_GT(graph.parts(), 1);
  const Forces parts(test, graph), one(test, whole(graph, test.body->mesh.cell_count()));
  // Sums of some ten numbers in another order.
  const double tolerance = 1e-14 * one.force.norm();
  EXPECT_LT((parts.force - one.force).norm(), tolerance);
  EXPECT_LT((parts.path - one.path).norm(), tolerance);
  EXPECT_NEAR(parts.energy, one.energy, 1e-14 * one.energy);
}

TEST_P(CellPacksOfKind, BitsAreTheSameForAnyNumberOfThreads) {
  const LargeBody test(GetParam());
  const NodeGraph graph = node_graph(test.body->space);
  const Forces alone(test, graph);
  set_thread_count(3);
  const Forces together(test, graph);
  set_thread_count(1);
  EXPECT_EQ(alone.force, together.force);
  EXPECT_EQ(alone.path, together.path);
  EXPECT_EQ(alone.energy, together.energy);
}

TEST_P(CellPacksOfKind, TheTangentOfThePathForceHasItsRulesAndTheSameBitsForAnyNumberOfThreads) {
  const LargeBody test(GetParam());
  const NodeGraph graph = node_graph(test.body->space);
  const ElasticCells cells(test.body->body, &graph);
  const PathRules rules = some_rules(test);
  const auto tangent = [&] { return cells.path_tangent(test.displacement, test.increment, rules, of_path_end); };
  const SparseMatrix alone = tangent();
  set_thread_count(3);
  const SparseMatrix together = tangent();
  set_thread_count(1);
  EXPECT_EQ((alone - together).norm(), 0.0);
  constexpr double h = 1e-4;
  Vector before, after;
  const auto force = [&](double size, Vector& result) {
    const Vector middle = test.displacement + 0.5 * size * test.increment, increment = (1.0 + size) * test.increment;
    EXPECT_EQ(cells.path_force(middle, increment, rules, result).cell, -1);
  };
  force(-h, before);
  force(h, after);
  const Vector wanted = (after - before) / (2.0 * h);
  EXPECT_LT((alone * test.increment - wanted).norm(), 1e-7 * wanted.norm());
}

/// The cells at some nodes, and all others.
TEST_P(CellPacksOfKind, ForcesOfSomeCellsAndOfTheOthersAreThoseOfAll) {
  const LargeBody test(GetParam());
  const NodeGraph graph = node_graph(test.body->space);
  const Forces all(test, graph);
  std::vector<std::vector<int>> cells(2);
  for (Index cell = 0; cell < test.body->mesh.cell_count(); ++cell)
    cells[cell % 5 == 0 || cell % 100 < 30 ? 1 : 0].push_back(int(cell));
  Vector sum = Vector::Zero(all.force.size()), paths = sum;
  double energy = 0.0;
  for (const std::vector<int>& some : cells) {
    const Forces own(test, graph, some);
    sum += own.force;
    paths += own.path;
    energy += own.energy;
  }
  EXPECT_LT((sum - all.force).norm(), 1e-14 * all.force.norm());
  EXPECT_LT((paths - all.path).norm(), 1e-14 * all.force.norm());
  EXPECT_NEAR(energy, all.energy, 1e-14 * all.energy);
}

TEST(CellPacks, OfAllCellsThatAreTurnedInsideOutTheWorstIsNamed) {
  const LargeBody test({CellShape::triangle, 1, 1});
  const NodeGraph graph = node_graph(test.body->space);
  const ElasticCells cells(test.body->body, &graph);
  Vector u = Vector::Zero(test.body->space.dof_count()), force;
  const Index node = test.body->space.node_count() / 2;
  u[2 * node] = 0.3;
  const CellVolume found = cells.force(u, force);
  EXPECT_LT(found.volume_ratio, 0.0);
  ASSERT_GE(found.cell, 0);
  const Index* const nodes = test.body->space.cells[0].cell(found.cell);
  EXPECT_TRUE(std::find(nodes, nodes + 3, node) != nodes + 3);
  EXPECT_TRUE(std::isinf(cells.energy(u)));
  u[2 * node] = std::nan("");
  EXPECT_EQ(cells.force(u, force).volume_ratio, -std::numeric_limits<double>::infinity());
}

std::vector<ElementKind> some_kinds() {
  return {{CellShape::triangle, 1, 1},    {CellShape::triangle, 1, 2},    {CellShape::quadrilateral, 1, 1},
          {CellShape::tetrahedron, 1, 1}, {CellShape::tetrahedron, 1, 2}, {CellShape::hexahedron, 1, 1}};
}

INSTANTIATE_TEST_SUITE_P(Elements, CellPacksOfKind, ::testing::ValuesIn(some_kinds()),
                         [](const auto& info) { return info.param.label(); });

}  // namespace
}  // namespace ricochet::test_support
