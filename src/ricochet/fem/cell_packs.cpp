#include "ricochet/fem/cell_packs.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>

#include "ricochet/base/packs.hpp"
#include "ricochet/base/parallel.hpp"

namespace ricochet {

namespace {

/// Cell with its sort key: nearby nodes have nearby numbers.
struct SharedCell {
  int part, material;
  std::size_t block;
  Index first_node;
  int local;
  [[nodiscard]] auto key() const { return std::tuple(part, block, material, first_node, local); }
};

int part_of_node(const NodeGraph& graph, Index node) {
  const auto& begins = graph.part_begins;
  return int(std::ranges::upper_bound(begins, node) - begins.begin()) - 1;
}

/// Returns the part of most of the cell's nodes, the first in case of a tie.
int part_of_cell(const NodeGraph& graph, const CellWalk& walk) {
  std::array<int, most_node_parts> nodes{};
  for (int i = 0; i < walk.node_count(); ++i) ++nodes[std::size_t(part_of_node(graph, walk.nodes()[i]))];
  return int(std::ranges::max_element(nodes) - nodes.begin());
}

}  // namespace

CellPacks::CellPacks(const Body& body, const NodeGraph* graph, const std::vector<int>& cells)
    : node_count_(body.space->node_count()) {
  share_out(body, graph, cells);
  number_nodes(body, graph);
}

void CellPacks::share_out(const Body& body, const NodeGraph* graph, const std::vector<int>& cells) {
  constexpr Index least_part = 2048;
  const Index count = cells.empty() ? body.mesh->cell_count() : Index(cells.size());
  const Index size = std::max(least_part, (count + most_node_parts - 1) / most_node_parts);
  runs_.resize(std::size_t(graph != nullptr ? graph->parts() : (count + size - 1) / size));
  std::vector<SharedCell> all;
  all.reserve(std::size_t(count));
  CellWalk walk(body.space->cells);
  for (Index i = 0; i < count; ++i) {
    const Index cell = cells.empty() ? i : cells[std::size_t(i)];
    walk.go_to(cell);
    const int part = graph != nullptr ? part_of_cell(*graph, walk) : int(i / size);
    all.push_back({part, body.cell_material[std::size_t(cell)], walk.block(),
                   *std::min_element(walk.nodes(), walk.nodes() + walk.node_count()), int(walk.local())});
  }
  std::ranges::sort(all, [](const SharedCell& a, const SharedCell& b) { return a.key() < b.key(); });
  lanes_.resize(body.space->cells.size());
  const auto width = std::size_t(pack_width());
  const SharedCell* last = nullptr;
  for (const SharedCell& cell : all) {
    auto& lanes = lanes_[cell.block];
    auto& runs = runs_[std::size_t(cell.part)];
    if (last == nullptr || last->part != cell.part || last->block != cell.block || last->material != cell.material) {
      // A pack contains cells of a single run.
      for (auto& each : lanes_) each.resize((each.size() + width - 1) / width * width, -1);
      runs.push_back({cell.block, cell.material, Index(lanes.size() / width), 0});
    }
    lanes.push_back(cell.local);
    runs.back().end = Index((lanes.size() + width - 1) / width);
    last = &cell;
  }
  for (auto& each : lanes_) each.resize((each.size() + width - 1) / width * width, -1);
}

/// Orders the part's own nodes first, then those of others, each ascending, then the dummy node.
void CellPacks::number_nodes(const Body& body, const NodeGraph* graph) {
  const auto width = std::size_t(pack_width());
  const auto parts = runs_.size();
  begins_.assign(1, 0);
  imports_.resize(parts);
  slots_.resize(lanes_.size());
  for (std::size_t block = 0; block < lanes_.size(); ++block)
    slots_[block].resize(lanes_[block].size() * std::size_t(body.space->cells[block].nodes_per_cell));
  const auto each_lane = [&](std::size_t part, const auto& work) {
    for (const PackRun& run : runs_[part]) {
      const CellBlock& cells = body.space->cells[run.block];
      const auto& lanes = lanes_[run.block];
      for (auto at = std::size_t(run.begin) * width; at < std::size_t(run.end) * width; ++at) {
        for (int i = 0; i < cells.nodes_per_cell; ++i) {
          const auto slot = (at / width * std::size_t(cells.nodes_per_cell) + std::size_t(i)) * width + at % width;
          work(lanes[at] < 0 ? Index{-1} : cells.cell(lanes[at])[i], slots_[run.block][slot]);
        }
      }
    }
  };
  std::vector<int> local_number(static_cast<std::size_t>(node_count_), -1), nodes;
  for (std::size_t part = 0; part < parts; ++part) {
    nodes.clear();
    each_lane(part, [&](Index node, int&) {
      if (node < 0 || local_number[std::size_t(node)] >= 0) return;
      local_number[std::size_t(node)] = 0;
      nodes.push_back(int(node));
    });
    const auto is_own = [&](int node) { return graph == nullptr || part_of_node(*graph, node) == int(part); };
    std::ranges::sort(nodes);
    const auto foreign = std::stable_partition(nodes.begin(), nodes.end(), is_own);
    own_.push_back(foreign - nodes.begin());
    for (std::size_t k = 0; k < nodes.size(); ++k) local_number[std::size_t(nodes[k])] = int(k);
    const auto none = int(nodes.size());
    each_lane(part, [&](Index node, int& slot) { slot = node < 0 ? none : local_number[std::size_t(node)]; });
    for (auto node = foreign; node != nodes.end(); ++node)
      imports_[std::size_t(part_of_node(*graph, *node))].push_back(
          {*node, int(nodes_.size()) + local_number[std::size_t(*node)]});
    for (const int node : nodes) local_number[std::size_t(node)] = -1;
    nodes_.insert(nodes_.end(), nodes.begin(), nodes.end());
    nodes_.push_back(-1);
    begins_.push_back(Index(nodes_.size()));
  }
}

template <int d>
void CellPacks::read(Index part, const Vector& from, std::vector<double>& room) const {
  const auto end = begins_[std::size_t(part) + 1] - 1;  // the dummy node remains zero
  for (Index k = begins_[std::size_t(part)]; k < end; ++k) {
    const double* const node = from.data() + Index(nodes_[std::size_t(k)]) * d;
    double* const to = room.data() + k * node_stride<d>;
    for (int a = 0; a < d; ++a) to[a] = node[a];
  }
}

template <int d>
void CellPacks::clear(Index part, std::vector<double>& room) const {
  std::fill(room.begin() + begin<d>(part), room.begin() + begin<d>(part + 1), 0.0);
}

template <int d>
void CellPacks::add_up(const std::vector<double>& room, Vector& result) const {
  const Index own_nodes = std::accumulate(own_.begin(), own_.end(), Index{0});
  if (own_nodes < node_count_) result.setZero(node_count_ * d);
  result.resize(node_count_ * d);
  parallel_ranges(parts(), [&](Index first, Index last) {
    for (auto part = std::size_t(first); part < std::size_t(last); ++part) {
      const Index begin = begins_[part];
      for (Index k = begin; k < begin + own_[part]; ++k) {
        double* const to = result.data() + Index(nodes_[std::size_t(k)]) * d;
        for (int a = 0; a < d; ++a) to[a] = room[std::size_t(k * node_stride<d> + a)];
      }
      for (const Import& import : imports_[part]) {
        double* const to = result.data() + Index(import.node) * d;
        const auto from = std::size_t(import.slot) * node_stride<d>;
        for (int a = 0; a < d; ++a) to[a] += room[from + std::size_t(a)];
      }
    }
  });
}

template void CellPacks::read<2>(Index, const Vector&, std::vector<double>&) const;
template void CellPacks::read<3>(Index, const Vector&, std::vector<double>&) const;
template void CellPacks::clear<2>(Index, std::vector<double>&) const;
template void CellPacks::clear<3>(Index, std::vector<double>&) const;
template void CellPacks::add_up<2>(const std::vector<double>&, Vector&) const;
template void CellPacks::add_up<3>(const std::vector<double>&, Vector&) const;

}  // namespace ricochet
