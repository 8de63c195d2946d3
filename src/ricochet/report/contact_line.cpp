#include "ricochet/report/contact_line.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace ricochet {

namespace {

using Neighbours = std::map<Index, std::vector<Index>>;

/// Returns the neighbours of nodes along the facets; the midside node of a facet of degree 2 lies between its ends.
Neighbours neighbours_of(const std::vector<CellBlock>& facets) {
  Neighbours result;
  const auto join = [&result](Index a, Index b) {
    result[a].push_back(b);
    result[b].push_back(a);
  };
  for (const CellBlock& block : facets) {
    for (Index i = 0; i < block.size(); ++i) {
      const Index* facet = block.cell(i);
      if (block.nodes_per_cell == 3) {
        join(facet[0], facet[2]);
        join(facet[2], facet[1]);
      } else {
        join(facet[0], facet[1]);
      }
    }
  }
  return result;
}

/// Returns the first end by (x, y); if only closed pieces are left, the node with the lowest number.
Index next_start(const Neighbours& neighbours, const Points& nodes, const std::set<Index>& left) {
  Index best = -1;
  for (const Index node : left) {
    if (neighbours.at(node).size() == 2) continue;
    if (best < 0 || std::pair(nodes(0, node), nodes(1, node)) < std::pair(nodes(0, best), nodes(1, best))) best = node;
  }
  return best >= 0 ? best : *left.begin();
}

}  // namespace

ContactLine make_contact_line(const Points& nodes, const std::vector<CellBlock>& facets) {
  ContactLine line;
  if (facets.empty()) return line;
  if (dimension(facets.front().shape) > 1) {
    std::set<Index> all;
    for (const CellBlock& block : facets) all.insert(block.nodes.begin(), block.nodes.end());
    line.nodes.assign(all.begin(), all.end());
    return line;
  }
  const Neighbours neighbours = neighbours_of(facets);
  std::set<Index> left;
  for (const auto& [node, around] : neighbours) left.insert(node);
  while (!left.empty()) {
    Index node = next_start(neighbours, nodes, left);
    line.pieces.push_back(int(line.nodes.size()));
    double position = 0.0;
    for (Index before = -1; node >= 0;) {
      if (before >= 0) position += (nodes.col(node) - nodes.col(before)).norm();
      line.nodes.push_back(node);
      line.position.push_back(position);
      left.erase(node);
      before = node;
      const std::vector<Index>& around = neighbours.at(node);
      const auto next = std::ranges::find_if(around, [&left](Index n) { return left.contains(n); });
      node = next == around.end() ? -1 : *next;
    }
  }
  // The pieces follow one another.
  double total_length = 0.0;
  for (std::size_t k = 0; k < line.pieces.size(); ++k) {
    const auto end = k + 1 < line.pieces.size() ? std::size_t(line.pieces[k + 1]) : line.nodes.size();
    total_length += line.position[end - 1];
  }
  double offset = 0.0;
  for (std::size_t k = 0; k < line.pieces.size(); ++k) {
    const auto end = k + 1 < line.pieces.size() ? std::size_t(line.pieces[k + 1]) : line.nodes.size();
    const double length = line.position[end - 1];
    for (auto i = std::size_t(line.pieces[k]); i < end; ++i) line.position[i] += offset;
    offset += length + 0.05 * total_length;
  }
  return line;
}

}  // namespace ricochet
