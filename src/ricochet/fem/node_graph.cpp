#include "ricochet/fem/node_graph.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

#include "ricochet/base/parallel.hpp"

namespace ricochet {

namespace {

/// Calls `work` for the bits that are set, ascending.
template <class Work>
void each_part(std::uint64_t set, const Work& work) {
  for (; set != 0; set &= set - 1) work(static_cast<std::size_t>(std::countr_zero(set)));
}

/// Fills graph.cell_begins and graph.cells.
void list_cells_of_parts(const DisplacementSpace& space, NodeGraph& graph) {
  const auto parts = static_cast<std::size_t>(graph.order->parts());
  std::vector<std::uint8_t> part_of_node(static_cast<std::size_t>(space.node_count()));
  for (std::size_t part = 0; part < parts; ++part) {
    for (Index place = graph.order->begins[part]; place < graph.order->begins[part + 1]; ++place) {
      part_of_node[static_cast<std::size_t>(graph.order->node[static_cast<std::size_t>(place)])] =
          static_cast<std::uint8_t>(part);
    }
  }
  static_assert(NodeOrder::most_parts <= 64, "a set of parts is the bits of one number");
  std::vector<std::uint64_t> parts_of_cell;
  graph.cell_begins.assign(parts + 1, 0);
  for (const CellBlock& block : space.cells) {
    for (Index cell = 0; cell < block.size(); ++cell) {
      std::uint64_t touched = 0;
      for (int k = 0; k < block.nodes_per_cell; ++k) {
        touched |= std::uint64_t{1} << part_of_node[static_cast<std::size_t>(block.cell(cell)[k])];
      }
      parts_of_cell.push_back(touched);
      each_part(touched, [&](std::size_t part) { ++graph.cell_begins[part + 1]; });
    }
  }
  for (std::size_t part = 0; part < parts; ++part) graph.cell_begins[part + 1] += graph.cell_begins[part];
  graph.cells.resize(static_cast<std::size_t>(graph.cell_begins.back()));
  std::vector<Index> next(graph.cell_begins.begin(), graph.cell_begins.end() - 1);
  for (std::size_t cell = 0; cell < parts_of_cell.size(); ++cell) {
    each_part(parts_of_cell[cell],
              [&](std::size_t part) { graph.cells[static_cast<std::size_t>(next[part]++)] = static_cast<int>(cell); });
  }
}

/// The rows of one part, one after another.
struct PartRows {
  std::vector<int> lengths;  ///< per place of the part
  std::vector<int> neighbours;
};

/// `seen` is work space, −1 for every node: the node from whose row a node was last seen.
PartRows rows_of_part(const DisplacementSpace& space, const NodeGraph& graph, Index part, std::vector<int>& seen) {
  const Index begin = graph.order->begins[static_cast<std::size_t>(part)];
  const Index end = graph.order->begins[static_cast<std::size_t>(part) + 1];
  const auto first_cell = graph.cells.begin() + graph.cell_begins[static_cast<std::size_t>(part)];
  const auto last_cell = graph.cells.begin() + graph.cell_begins[static_cast<std::size_t>(part) + 1];
  // The nodes of the cells around each place, with repetitions.
  const auto each_incidence = [&](const auto& enter) {
    CellWalk cell(space.cells);
    for (auto number = first_cell; number != last_cell; ++number) {
      cell.go_to(*number);
      for (int k = 0; k < cell.node_count(); ++k) {
        const Index place = graph.order->place[static_cast<std::size_t>(cell.nodes()[k])];
        if (place >= begin && place < end) enter(static_cast<std::size_t>(place - begin), cell);
      }
    }
  };
  std::vector<Index> offsets(static_cast<std::size_t>(end - begin) + 1, 0);
  each_incidence([&](std::size_t place, const CellWalk& cell) { offsets[place + 1] += cell.node_count(); });
  for (std::size_t place = 1; place < offsets.size(); ++place) offsets[place] += offsets[place - 1];
  std::vector<int> around(static_cast<std::size_t>(offsets.back()));
  std::vector<Index> next(offsets.begin(), offsets.end() - 1);
  each_incidence([&](std::size_t place, const CellWalk& cell) {
    for (int k = 0; k < cell.node_count(); ++k)
      around[static_cast<std::size_t>(next[place]++)] = static_cast<int>(cell.nodes()[k]);
  });
  PartRows rows;
  rows.lengths.reserve(offsets.size() - 1);
  for (std::size_t place = 0; place + 1 < offsets.size(); ++place) {
    const int node = graph.order->node[static_cast<std::size_t>(begin) + place];
    const auto row_begin = static_cast<std::ptrdiff_t>(rows.neighbours.size());
    for (Index k = offsets[place]; k < offsets[place + 1]; ++k) {
      const int neighbour = around[static_cast<std::size_t>(k)];
      if (seen[static_cast<std::size_t>(neighbour)] == node) continue;
      seen[static_cast<std::size_t>(neighbour)] = node;
      rows.neighbours.push_back(neighbour);
    }
    std::sort(rows.neighbours.begin() + row_begin, rows.neighbours.end());
    rows.lengths.push_back(static_cast<int>(rows.neighbours.size()) - static_cast<int>(row_begin));
  }
  return rows;
}

}  // namespace

NodeGraph node_graph(const DisplacementSpace& space) {
  NodeGraph graph;
  graph.order = std::make_shared<const NodeOrder>(order_nodes(space.nodes));
  list_cells_of_parts(space, graph);
  const Index parts = graph.order->parts();
  std::vector<PartRows> rows(static_cast<std::size_t>(parts));
  graph.offsets.assign(static_cast<std::size_t>(space.node_count()) + 1, 0);
  parallel_ranges(parts, [&](Index first, Index last) {
    std::vector<int> seen(static_cast<std::size_t>(space.node_count()), -1);
    for (Index part = first; part < last; ++part) {
      PartRows& own = rows[static_cast<std::size_t>(part)] = rows_of_part(space, graph, part, seen);
      for (std::size_t k = 0; k < own.lengths.size(); ++k) {
        const int node =
            graph.order->node[static_cast<std::size_t>(graph.order->begins[static_cast<std::size_t>(part)]) + k];
        graph.offsets[static_cast<std::size_t>(node) + 1] = own.lengths[k];
      }
    }
  });
  for (std::size_t i = 1; i < graph.offsets.size(); ++i) graph.offsets[i] += graph.offsets[i - 1];
  graph.neighbours.resize(static_cast<std::size_t>(graph.offsets.back()));
  parallel_ranges(parts, [&](Index first, Index last) {
    for (Index part = first; part < last; ++part) {
      const PartRows& own = rows[static_cast<std::size_t>(part)];
      auto from = own.neighbours.begin();
      for (std::size_t k = 0; k < own.lengths.size(); ++k, from += own.lengths[k - 1]) {
        const int node =
            graph.order->node[static_cast<std::size_t>(graph.order->begins[static_cast<std::size_t>(part)]) + k];
        std::copy(from, from + own.lengths[k],
                  graph.neighbours.begin() + graph.offsets[static_cast<std::size_t>(node)]);
      }
    }
  });
  return graph;
}

}  // namespace ricochet
