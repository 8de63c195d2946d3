#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "ricochet/mesh/build_mesh.hpp"
#include "ricochet/mesh/gmsh_elements.hpp"
#include "ricochet/mesh/offenders.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/vertex_set_table.hpp"

namespace ricochet::gmsh {

namespace {

bool same_nodes(const Index* one, const Index* other, int count) {
  return std::is_permutation(one, one + count, other, other + count);
}

/// Makes the block of one shape and degree.
class BlockCollector {
 public:
  BlockCollector(CellShape shape, int degree, std::size_t capacity, const NodeNumbering& numbering)
      : order_(gmsh_nodes(shape, degree)), numbering_(numbering), table_(vertex_count(shape), capacity) {
    block_.shape = shape;
    block_.nodes_per_cell = node_count(shape, degree);
    block_.nodes.reserve(capacity * order_.size());
    block_.tags.reserve(capacity);
    in_group_.reserve(capacity);
  }

  /// Adds the elements and appends their numbers, counted from `first`, to the members of each group they are in.
  void add(const RawElements& elements, std::span<std::vector<Index>* const> groups, Index first) {
    std::vector<Index> nodes(order_.size());
    for (std::size_t i = 0; i < elements.tags.size(); ++i) {
      if (!convert(elements, i, nodes)) continue;
      const Index number = add_cell(nodes, elements.tags[i], !groups.empty());
      for (std::vector<Index>* members : groups) members->push_back(first + number);
    }
  }

  CellBlock release(const std::string& source) {
    if (elements_at_fault_.any()) {
      fail_mesh(source,
                fmt::format("{} refer{} to nodes that are not in $Nodes: {}", elements_at_fault_.text("element"),
                            elements_at_fault_.count() == 1 ? "s" : "", unknown_nodes_.text("node")));
    }
    if (repeated_.any()) {
      fail_mesh(source,
                fmt::format("{} ha{} the same vertices as another element without being in another group: the same {} "
                            "must not occur twice (in Gmsh: Mesh > Remove duplicate elements)",
                            repeated_.text("element"), repeated_.count() == 1 ? "s" : "ve", name(block_.shape)));
    }
    return std::move(block_);
  }

 private:
  bool convert(const RawElements& elements, std::size_t element, std::vector<Index>& nodes) {
    const std::int64_t* tags = elements.nodes.data() + element * order_.size();
    bool complete = true;
    for (std::size_t i = 0; i < order_.size(); ++i) {
      Index& node = nodes[std::size_t(order_[i])];
      node = numbering_.find(tags[i]);
      if (node >= 0) continue;
      unknown_nodes_.add(tags[i]);
      complete = false;
    }
    if (!complete) elements_at_fault_.add(elements.tags[element]);
    return complete;
  }

  Index add_cell(const std::vector<Index>& nodes, std::int64_t tag, bool in_group) {
    const Index existing = table_.find_or_add(nodes.data());
    if (existing < 0) {
      block_.nodes.insert(block_.nodes.end(), nodes.begin(), nodes.end());
      block_.tags.push_back(tag);
      in_group_.push_back(in_group);
      return block_.size() - 1;
    }
    // Gmsh's format 2.2 repeats an element for each group it is in. Any other repetition means two cells at one
    // position.
    const bool once_per_group = in_group && in_group_[std::size_t(existing)];
    if (!once_per_group || !same_nodes(block_.cell(existing), nodes.data(), block_.nodes_per_cell)) repeated_.add(tag);
    return existing;
  }

  const std::vector<int>& order_;
  const NodeNumbering& numbering_;
  VertexSetTable table_;
  CellBlock block_;
  std::vector<bool> in_group_;
  Offenders elements_at_fault_;
  Offenders unknown_nodes_;  // to which elements_at_fault_ refer
  Offenders repeated_;
};

std::int64_t tag_of(const std::vector<CellBlock>& blocks, Index number) {
  for (const CellBlock& block : blocks) {
    if (number < block.size()) return block.tags[std::size_t(number)];
    number -= block.size();
  }
  return 0;
}

void sort_members(const std::vector<CellBlock>& blocks, const std::string& source, Group& group) {
  std::vector<Index>& members = group.members;
  if (!std::ranges::is_sorted(members)) std::ranges::sort(members);
  Offenders repeated;
  for (std::size_t i = 1; i < members.size(); ++i) {
    if (members[i] == members[i - 1]) repeated.add(tag_of(blocks, members[i]));
  }
  if (repeated.any()) {
    fail_mesh(source,
              fmt::format(
                  "{}: repeated in the group \"{}\" with the same vertices (in Gmsh: Mesh > Remove duplicate elements)",
                  repeated.text("element"), group.name));
  }
}

}  // namespace

std::vector<CellBlock> collect_cells(std::span<const RawElements* const> elements, const NodeNumbering& numbering,
                                     Mesh& mesh) {
  std::map<CellShape, std::vector<const RawElements*>> by_shape;
  for (const RawElements* part : elements) by_shape[*find_element_type(part->type)->shape].push_back(part);
  std::vector<CellBlock> blocks;
  Index first = 0;
  for (const auto& [shape, parts] : by_shape) {
    std::size_t capacity = 0;
    for (const RawElements* part : parts) capacity += part->tags.size();
    BlockCollector collector(shape, mesh.degree, capacity, numbering);
    for (const RawElements* part : parts) {
      std::vector<std::vector<Index>*> members;
      for (Group& group : mesh.groups) {
        const bool in_group = std::ranges::binary_search(part->groups, group.tag);
        if (in_group && group.dimension == dimension(shape)) members.push_back(&group.members);
      }
      collector.add(*part, members, first);
    }
    blocks.push_back(collector.release(mesh.source));
    first += blocks.back().size();
  }
  for (Group& group : mesh.groups) sort_members(blocks, mesh.source, group);
  return blocks;
}

}  // namespace ricochet::gmsh
