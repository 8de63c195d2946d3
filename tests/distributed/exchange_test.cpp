#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <set>

#include "ricochet/base/error.hpp"
#include "ricochet/distributed/mpi_ranks.hpp"
#include "ricochet/distributed/partition.hpp"
#include "support/box_mesh.hpp"

// Every rank computes the data of all others here, and from these the result it expects.

namespace ricochet::test_support {
namespace {

const Communicator& world() {
  static const Communicator ranks = Communicator::world();
  return ranks;
}

Mesh box() { return make_box_mesh(BoxMesh{CellShape::tetrahedron, {6, 5, 4}, 1, 0.1, {}}); }

/// The nodes of each rank, ascending, by a division of the cells.
std::vector<std::vector<std::int64_t>> nodes_of_ranks(const Mesh& mesh, const std::vector<int>& rank_of_cell) {
  std::vector<std::set<std::int64_t>> nodes(static_cast<std::size_t>(world().size()));
  each_cell(mesh.cells, [&](Index number, std::span<const Index> of_cell) {
    const int rank = rank_of_cell[std::size_t(number)];
    nodes[std::size_t(rank)].insert(of_cell.begin(), of_cell.end());
  });
  std::vector<std::vector<std::int64_t>> result;
  for (const auto& own : nodes) result.emplace_back(own.begin(), own.end());
  return result;
}

/// Contribution of a rank to a component of a node: numbers whose sum depends on the order of the additions.
double part_of(int rank, std::int64_t node, Index component) {
  return std::sin(1.0 + 3.7 * rank + 0.9 * double(node) + double(component)) * std::pow(10.0, rank % 3);
}

class Exchange : public testing::TestWithParam<PartitionMethod> {
 protected:
  Exchange()
      : mesh_(box()),
        division_(partition_cells(mesh_, world().size(), GetParam(), 5)),
        nodes_(nodes_of_ranks(mesh_, division_)) {}
  [[nodiscard]] const std::vector<std::int64_t>& own() const { return nodes_[std::size_t(world().rank())]; }
  [[nodiscard]] bool has(int rank, std::int64_t node) const {
    const auto& nodes = nodes_[std::size_t(rank)];
    return std::ranges::binary_search(nodes, node);
  }

  Mesh mesh_;
  std::vector<int> division_;
  std::vector<std::vector<std::int64_t>> nodes_;
};

TEST_P(Exchange, SumsThePartsOfSharersInTheirOrder) {
  const NodeExchange exchange(world(), own(), mesh_.node_count());
  for (const Index per_node : {1, 3}) {
    Vector values(static_cast<Index>(own().size()) * per_node), expected = values;
    for (std::size_t i = 0; i < own().size(); ++i) {
      for (Index k = 0; k < per_node; ++k) {
        const Index at = Index(i) * per_node + k;
        values[at] = part_of(world().rank(), own()[i], k);
        expected[at] = 0.0;
        for (int rank = 0; rank < world().size(); ++rank) {
          if (has(rank, own()[i])) expected[at] += part_of(rank, own()[i], k);
        }
      }
    }
    exchange.accumulate(values);
    EXPECT_EQ(values, expected) << "to the bit";
  }
}

TEST_P(Exchange, EachNodeHasOneOwnerWhoseValuesSpread) {
  const NodeExchange exchange(world(), own(), mesh_.node_count());
  Vector values = Vector::Constant(Index(own().size()) * 3, world().rank());
  exchange.copy_from_owners(values);
  Index owned = 0;
  for (std::size_t i = 0; i < own().size(); ++i) {
    int owner = 0;
    while (!has(owner, own()[i])) ++owner;
    EXPECT_EQ(exchange.is_owned(Index(i)), owner == world().rank());
    EXPECT_EQ(values[Index(i) * 3 + 1], owner);
    owned += owner == world().rank() ? 1 : 0;
  }
  EXPECT_EQ(exchange.owned_count(), owned);
  const MpiRanks ranks(world(), exchange);
  EXPECT_EQ(ranks.sum(double(owned)), double(mesh_.node_count()));
}

TEST_P(Exchange, CountsWhatItSends) {
  const NodeExchange exchange(world(), own(), mesh_.node_count());
  EXPECT_EQ(exchange.traffic().messages, 0);
  Vector values = Vector::Zero(Index(own().size()) * 3);
  exchange.accumulate(values);
  std::int64_t neighbours = 0, shared = 0;
  for (int rank = 0; rank < world().size(); ++rank) {
    if (rank == world().rank()) continue;
    const auto common = std::count_if(own().begin(), own().end(), [&](std::int64_t node) { return has(rank, node); });
    neighbours += common > 0 ? 1 : 0;
    shared += common;
  }
  EXPECT_EQ(exchange.traffic().messages, neighbours);
  EXPECT_EQ(exchange.traffic().bytes, 24 * shared);
}

INSTANTIATE_TEST_SUITE_P(Divisions, Exchange, testing::Values(PartitionMethod::graph, PartitionMethod::random));

TEST(MpiRanks, ReduceInOneExchange) {
  const std::vector<std::int64_t> none;
  const NodeExchange exchange(world(), none, 10);
  const MpiRanks ranks(world(), exchange);
  const double own = world().rank();
  std::vector<double> values{own + 1.0, own - 5.0, own, 7.0};
  ranks.reduce(values, std::vector<Reduction>{Reduction::sum, Reduction::minimum, Reduction::maximum, Reduction::same});
  const double last = world().size() - 1;
  EXPECT_EQ(values, (std::vector<double>{(last + 1.0) * (last + 2.0) / 2.0, -5.0, last, 7.0}));
  EXPECT_EQ(ranks.any(world().rank() == world().size() - 1), true);
  EXPECT_EQ(ranks.any(false), false);
  // A NaN on one rank is not lost.
  const double odd = world().rank() == 0 ? std::numeric_limits<double>::quiet_NaN() : 1.0;
  EXPECT_TRUE(std::isnan(ranks.maximum(odd)));
  EXPECT_TRUE(std::isnan(ranks.minimum(odd)));
  EXPECT_TRUE(std::isnan(ranks.sum(odd)));
}

TEST(Partition, GivesPartsOfOneSizeWithShortBoundaries) {
  const Mesh mesh = make_box_mesh(BoxMesh{CellShape::tetrahedron, {16, 16, 16}, 1, 0.0, {}});
  for (const int parts : {2, 3, 8}) {
    const std::vector<int> division = partition_cells(mesh, parts, PartitionMethod::graph);
    std::vector<Index> count(static_cast<std::size_t>(parts), 0);
    for (const int part : division) ++count.at(std::size_t(part));
    const double mean = double(mesh.cell_count()) / parts;
    for (const Index cells : count) EXPECT_NEAR(double(cells), mean, 0.15 * mean) << parts;
    EXPECT_EQ(division, partition_cells(mesh, parts, PartitionMethod::graph)) << "the same each time";
  }
}

TEST(Partition, LeavesNobodyWithoutCells) {
  const Mesh mesh = make_box_mesh(BoxMesh{CellShape::tetrahedron, {1, 1, 1}, 1, 0.0, {}});
  for (const PartitionMethod method : {PartitionMethod::graph, PartitionMethod::random}) {
    for (int parts = 1; parts <= mesh.cell_count(); ++parts) {
      const std::vector<int> division = partition_cells(mesh, parts, method, 3);
      EXPECT_EQ(std::set<int>(division.begin(), division.end()).size(), std::size_t(parts));
    }
  }
}

}  // namespace
}  // namespace ricochet::test_support
