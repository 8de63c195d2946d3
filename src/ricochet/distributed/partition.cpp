#include "ricochet/distributed/partition.hpp"

#include <fmt/format.h>
#include <petscmat.h>
#include <ptscotch.h>
#include <stdio.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <span>

#include "ricochet/base/error.hpp"
#include "ricochet/distributed/petsc_session.hpp"

namespace ricochet {

namespace {

/// Nodes that share a cell with each node, row after row, without the node itself.
struct Adjacency {
  std::vector<PetscInt> begin{0}, neighbour;
};

Adjacency adjacency_of(const Mesh& mesh) {
  const auto count = std::size_t(mesh.node_count());
  std::vector<Index> begin(count + 1, 0);
  each_cell(mesh.cells, [&](Index, std::span<const Index> nodes) {
    for (const Index node : nodes) ++begin[std::size_t(node) + 1];
  });
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<const Index*> cell(static_cast<std::size_t>(begin.back()));
  std::vector<int> length(cell.size());
  std::vector<Index> next(begin.begin(), begin.end() - 1);
  each_cell(mesh.cells, [&](Index, std::span<const Index> nodes) {
    for (const Index node : nodes) {
      const auto at = std::size_t(next[std::size_t(node)]++);
      cell[at] = nodes.data();
      length[at] = int(nodes.size());
    }
  });
  Adjacency result;
  std::vector<Index> found;
  for (std::size_t node = 0; node < count; ++node) {
    found.clear();
    for (auto at = std::size_t(begin[node]); at < std::size_t(begin[node + 1]); ++at)
      found.insert(found.end(), cell[at], cell[at] + length[at]);
    std::ranges::sort(found);
    found.erase(std::unique(found.begin(), found.end()), found.end());
    for (const Index other : found) {
      if (other != Index(node)) result.neighbour.push_back(static_cast<PetscInt>(other));
    }
    result.begin.push_back(static_cast<PetscInt>(result.neighbour.size()));
  }
  return result;
}

std::vector<int> divide_nodes(const Mesh& mesh, int parts) {
  const PetscSession petsc;
  Adjacency adjacency = adjacency_of(mesh);
  const auto nodes = static_cast<PetscInt>(mesh.node_count());
  Mat graph = nullptr;
  MatPartitioning partitioning = nullptr;
  IS division = nullptr;
  const PetscInt* number = nullptr;
  std::vector<int> result(static_cast<std::size_t>(nodes), 0);
  const auto divide = [&]() -> PetscErrorCode {
    PetscFunctionBeginUser;
    // PETSc frees the arrays passed to it.
    PetscInt *begin = nullptr, *neighbour = nullptr;
    PetscCall(PetscMalloc1(adjacency.begin.size(), &begin));
    PetscCall(PetscMalloc1(adjacency.neighbour.size(), &neighbour));
    std::ranges::copy(adjacency.begin, begin);
    std::ranges::copy(adjacency.neighbour, neighbour);
    adjacency = {};
    PetscCall(MatCreateMPIAdj(PETSC_COMM_SELF, nodes, nodes, begin, neighbour, nullptr, &graph));
    PetscCall(MatPartitioningCreate(PETSC_COMM_SELF, &partitioning));
    PetscCall(MatPartitioningSetAdjacency(partitioning, graph));
    PetscCall(MatPartitioningSetType(partitioning, MATPARTITIONINGPTSCOTCH));
    PetscCall(MatPartitioningSetNParts(partitioning, parts));
    PetscCall(MatPartitioningApply(partitioning, &division));
    PetscCall(ISGetIndices(division, &number));
    std::copy_n(number, nodes, result.begin());
    PetscCall(ISRestoreIndices(division, &number));
    PetscCall(ISDestroy(&division));
    PetscCall(MatPartitioningDestroy(&partitioning));
    PetscCall(MatDestroy(&graph));
    PetscFunctionReturn(0);
  };
  // One thread, for the same division in every run: several threads of Scotch find a different one each time.
  setenv("SCOTCH_PTHREAD_NUMBER", "1", 1);
  SCOTCH_randomReset();
  if (divide() != 0) throw Error(ErrorKind::invalid_input, "PT-Scotch could not divide the mesh among ranks");
  return result;
}

}  // namespace

std::vector<int> partition_cells(const Mesh& mesh, int ranks, PartitionMethod method, std::uint64_t seed) {
  const Index cells = mesh.cell_count();
  std::vector<int> result(static_cast<std::size_t>(cells), 0);
  if (ranks == 1) return result;
  if (method == PartitionMethod::random) {
    std::mt19937_64 generator(seed);
    for (std::size_t i = 0; i < result.size(); ++i) {
      // The first cells are dealt out one by one, so that every rank has a cell.
      const auto any = int(generator() % std::uint64_t(ranks));
      result[i] = i < std::size_t(ranks) ? int(i) : any;
    }
    return result;
  }
  const std::vector<int> part = divide_nodes(mesh, ranks);
  std::vector<Index> count(static_cast<std::size_t>(ranks), 0);
  each_cell(mesh.cells, [&](Index cell, std::span<const Index> nodes) {
    int best = -1;
    std::ptrdiff_t most = 0;
    for (const Index node : nodes) {
      const int own = part[std::size_t(node)];
      const std::ptrdiff_t votes =
          std::ranges::count_if(nodes, [&](Index other) { return part[std::size_t(other)] == own; });
      if (votes > most || (votes == most && own < best)) {
        most = votes;
        best = own;
      }
    }
    result[std::size_t(cell)] = best;
    ++count[std::size_t(best)];
  });
  // A part of few nodes may win no cell and then gets one of the largest part.
  for (std::size_t empty = 0; empty < count.size(); ++empty) {
    if (count[empty] > 0) continue;
    const auto largest = int(std::ranges::max_element(count) - count.begin());
    const auto cell = std::ranges::find(result, largest);
    *cell = int(empty);
    --count[std::size_t(largest)];
    ++count[empty];
  }
  return result;
}

}  // namespace ricochet
