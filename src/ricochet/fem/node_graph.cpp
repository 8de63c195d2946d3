#include "ricochet/fem/node_graph.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "ricochet/base/parallel.hpp"

namespace ricochet {

namespace {

/// Calls work(part) for the bits that are set, ascending.
template <class Work>
void each_part(std::uint64_t set, const Work& work) {
  for (; set != 0; set &= set - 1) work(std::size_t(std::countr_zero(set)));
}

/// Fills graph.cell_begins and graph.cells.
void list_cells_of_parts(const DisplacementSpace& space, NodeGraph& graph) {
  const auto parts = std::size_t(graph.parts());
  std::vector<std::uint8_t> part_of_node(static_cast<std::size_t>(space.node_count()));
  for (std::size_t part = 0; part < parts; ++part) {
    std::fill(part_of_node.begin() + graph.part_begins[part], part_of_node.begin() + graph.part_begins[part + 1],
              std::uint8_t(part));
  }
  static_assert(most_node_parts <= 64, "a set of parts must fit into the bits of one number");
  std::vector<std::uint64_t> parts_of_cell;
  graph.cell_begins.assign(parts + 1, 0);
  for (const CellBlock& block : space.cells) {
    for (Index cell = 0; cell < block.size(); ++cell) {
      std::uint64_t touched = 0;
      for (int k = 0; k < block.nodes_per_cell; ++k) {
        touched |= std::uint64_t{1} << part_of_node[std::size_t(block.cell(cell)[k])];
      }
      parts_of_cell.push_back(touched);
      each_part(touched, [&](std::size_t part) { ++graph.cell_begins[part + 1]; });
    }
  }
  for (std::size_t part = 0; part < parts; ++part) graph.cell_begins[part + 1] += graph.cell_begins[part];
  graph.cells.resize(std::size_t(graph.cell_begins.back()));
  std::vector<Index> next(graph.cell_begins.begin(), graph.cell_begins.end() - 1);
  for (std::size_t cell = 0; cell < parts_of_cell.size(); ++cell) {
    each_part(parts_of_cell[cell], [&](std::size_t part) { graph.cells[std::size_t(next[part]++)] = int(cell); });
  }
}

/// Rows of one part, contiguous.
struct PartRows {
  std::vector<int> lengths;  ///< per node of the part
  std::vector<int> neighbours;
};

/// Computes the rows of a part. `visited_by` is work space, −1 for every node: the row in which a node last occurred.
PartRows rows_of_part(const DisplacementSpace& space, const NodeGraph& graph, Index part,
                      std::vector<int>& visited_by) {
  const Index begin = graph.part_begins[std::size_t(part)];
  const Index end = graph.part_begins[std::size_t(part) + 1];
  const auto first_cell = graph.cells.begin() + graph.cell_begins[std::size_t(part)];
  const auto last_cell = graph.cells.begin() + graph.cell_begins[std::size_t(part) + 1];
  // Visits the cells at each node of the part (numbered from its begin), with repetitions.
  const auto each_incidence = [&](const auto& enter) {
    CellWalk cell(space.cells);
    for (auto number = first_cell; number != last_cell; ++number) {
      cell.go_to(*number);
      for (int k = 0; k < cell.node_count(); ++k) {
        const Index node = cell.nodes()[k];
        if (node >= begin && node < end) enter(std::size_t(node - begin), cell);
      }
    }
  };
  std::vector<Index> offsets(static_cast<std::size_t>(end - begin) + 1, 0);
  each_incidence([&](std::size_t local, const CellWalk& cell) { offsets[local + 1] += cell.node_count(); });
  for (std::size_t local = 1; local < offsets.size(); ++local) offsets[local] += offsets[local - 1];
  std::vector<int> around(static_cast<std::size_t>(offsets.back()));
  std::vector<Index> next(offsets.begin(), offsets.end() - 1);
  each_incidence([&](std::size_t local, const CellWalk& cell) {
    for (int k = 0; k < cell.node_count(); ++k) around[std::size_t(next[local]++)] = int(cell.nodes()[k]);
  });
  PartRows rows;
  rows.lengths.reserve(offsets.size() - 1);
  for (std::size_t local = 0; local + 1 < offsets.size(); ++local) {
    const int node = int(begin) + int(local);
    const auto row_begin = std::ptrdiff_t(rows.neighbours.size());
    for (Index k = offsets[local]; k < offsets[local + 1]; ++k) {
      const int neighbour = around[std::size_t(k)];
      if (visited_by[std::size_t(neighbour)] == node) continue;
      visited_by[std::size_t(neighbour)] = node;
      rows.neighbours.push_back(neighbour);
    }
    std::sort(rows.neighbours.begin() + row_begin, rows.neighbours.end());
    rows.lengths.push_back(int(rows.neighbours.size()) - int(row_begin));
  }
  return rows;
}

}  // namespace

NodeGraph node_graph(const DisplacementSpace& space) {
  NodeGraph graph;
  graph.part_begins = node_parts(space.node_count());
  list_cells_of_parts(space, graph);
  std::vector<PartRows> rows(static_cast<std::size_t>(graph.parts()));
  parallel_ranges(graph.parts(), [&](Index first, Index last) {
    std::vector<int> visited_by(static_cast<std::size_t>(space.node_count()), -1);
    for (Index part = first; part < last; ++part)
      rows[std::size_t(part)] = rows_of_part(space, graph, part, visited_by);
  });
  graph.offsets.reserve(std::size_t(space.node_count()) + 1);
  graph.offsets.push_back(0);
  for (const PartRows& own : rows) {
    for (const int length : own.lengths) graph.offsets.push_back(graph.offsets.back() + length);
  }
  graph.neighbours.reserve(std::size_t(graph.offsets.back()));
  for (const PartRows& own : rows)
    graph.neighbours.insert(graph.neighbours.end(), own.neighbours.begin(), own.neighbours.end());
  return graph;
}

NodeGraph cells_at_nodes(const NodeGraph& graph, const DisplacementSpace& space, const std::vector<char>& is_selected) {
  NodeGraph result = graph;
  result.cells.clear();
  result.cell_begins.assign(1, 0);
  for (std::size_t part = 0; part + 1 < graph.cell_begins.size(); ++part) {
    CellWalk walk(space.cells);
    for (Index k = graph.cell_begins[part]; k < graph.cell_begins[part + 1]; ++k) {
      const int cell = graph.cells[std::size_t(k)];
      walk.go_to(cell);
      const Index* const nodes = walk.nodes();
      if (std::any_of(nodes, nodes + walk.node_count(),
                      [&](Index node) { return is_selected[std::size_t(node)] != 0; }))
        result.cells.push_back(cell);
    }
    result.cell_begins.push_back(Index(result.cells.size()));
  }
  return result;
}

}  // namespace ricochet
