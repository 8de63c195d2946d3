#include "ricochet/linear_algebra/graph_components.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace ricochet {
namespace {

/// Rings of 1 to 7 nodes, numbered at random: the components are the rings, ordered by their smallest nodes.
TEST(GraphComponents, AreTheRingsThatWerePutIn) {
  constexpr Index rings = 7, nodes = rings * (rings + 1) / 2;
  std::mt19937 random(3);
  std::vector<Index> number(static_cast<std::size_t>(nodes));
  std::iota(number.begin(), number.end(), Index{0});
  std::shuffle(number.begin(), number.end(), random);
  for (const int node_size : {1, 2, 3}) {
    std::vector<std::vector<Index>> wanted;
    std::vector<Eigen::Triplet<double>> entries;
    Index begin = 0;
    for (Index length = 1; length <= rings; begin += length++) {
      std::vector<Index> ring;
      for (Index k = 0; k < length; ++k) {
        const Index node = number[std::size_t(begin + k)];
        const Index next = number[std::size_t(begin + (k + 1) % length)];
        ring.push_back(node);
        for (Index row = 0; row < node_size; ++row) {
          for (Index column = 0; column < node_size; ++column) {
            entries.emplace_back(node * node_size + row, next * node_size + column, 1.0);
            entries.emplace_back(next * node_size + row, node * node_size + column, 1.0);
          }
        }
      }
      std::ranges::sort(ring);
      wanted.push_back(ring);
    }
    std::ranges::sort(wanted);
    SparseMatrix matrix(nodes * node_size, nodes * node_size);
    matrix.setFromTriplets(entries.begin(), entries.end());
    std::vector<std::vector<Index>> found = graph_components(MatrixGraph(matrix, node_size));
    for (std::vector<Index>& component : found) {
      EXPECT_EQ(component.front(), *std::ranges::min_element(component));
      std::ranges::sort(component);
    }
    EXPECT_EQ(found, wanted) << node_size << " rows per node";
  }
}

TEST(GraphComponents, NodesWithoutEntriesAreAlone) {
  EXPECT_EQ(graph_components(MatrixGraph(SparseMatrix(4, 4), 2)), (std::vector<std::vector<Index>>{{0}, {1}}));
}

}  // namespace
}  // namespace ricochet
