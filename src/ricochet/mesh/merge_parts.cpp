#include "ricochet/mesh/merge_parts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <set>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

/// Returns "parts "ball" and "ring"", so that messages about a mesh of many files stay short.
std::string source_of(const std::vector<NamedMesh>& parts) {
  constexpr std::size_t shown = 6;
  if (parts.size() > shown) return fmt::format("the {} parts", parts.size());
  std::vector<std::string> names;
  for (const NamedMesh& part : parts) names.push_back(part.name);
  return fmt::format("{} {}", parts.size() == 1 ? "part" : "parts", join_names(names));
}

std::int64_t largest_tag(const Mesh& mesh) {
  std::int64_t largest = 0;
  const auto include_tags = [&](const std::vector<std::int64_t>& tags) {
    for (const std::int64_t tag : tags) largest = std::max(largest, tag);
  };
  include_tags(mesh.node_tags);
  for (const CellBlock& block : mesh.cells) include_tags(block.tags);
  for (const CellBlock& block : mesh.facets) include_tags(block.tags);
  return largest;
}

/// Offset of the tags per preceding part, chosen so that the number in the file is visible in the last digits.
std::int64_t tag_step(const std::vector<NamedMesh>& parts) {
  std::int64_t largest = 0;
  for (const NamedMesh& part : parts) largest = std::max(largest, largest_tag(part.mesh));
  const std::int64_t most = std::numeric_limits<std::int64_t>::max() / 10 / std::int64_t(parts.size());
  std::int64_t step = 1'000'000;
  while (step <= largest && step <= most) step *= 10;
  if (step <= largest) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: a node or an element has the number {}: the numbers in the joined mesh would be too "
                            "large; number the nodes and elements of the file from 1 (in Gmsh: Mesh.Renumber)",
                            source_of(parts), largest));
  }
  return step;
}

/// Joins the blocks of all parts shape by shape, and stores where each part's blocks begin.
class BlockMerger {
 public:
  BlockMerger(const std::vector<NamedMesh>& parts, std::vector<CellBlock> Mesh::*blocks) : parts_(parts), of_(blocks) {
    std::set<CellShape> shapes;  // in the order in which the reader leaves them
    for (const NamedMesh& part : parts) {
      for (const CellBlock& block : part.mesh.*of_) shapes.insert(block.shape);
    }
    for (const CellShape shape : shapes) merged_.push_back({shape, 0, {}, {}});
    number_all();
  }

  /// Appends the blocks of the next part.
  void append(std::size_t part, Index first_node, std::int64_t more) {
    for (const CellBlock& block : parts_[part].mesh.*of_) {
      CellBlock& merged_block = merged_[block_of(block.shape)];
      merged_block.nodes_per_cell = block.nodes_per_cell;
      for (const Index node : block.nodes) merged_block.nodes.push_back(node + first_node);
      // Facets that the file does not contain have the tag 0.
      for (const std::int64_t tag : block.tags) merged_block.tags.push_back(tag == 0 ? 0 : tag + more);
    }
  }

  /// Number, through all blocks, of a cell or facet given by its number in its part.
  [[nodiscard]] Index number(std::size_t part, Index in_part) const {
    const std::vector<CellBlock>& blocks = parts_[part].mesh.*of_;
    const IndexInBlocks location = locate_in_blocks(blocks, in_part);
    return first_[part][block_of(blocks[location.block].shape)] + location.local;
  }

  [[nodiscard]] std::vector<CellBlock> release() { return std::move(merged_); }

 private:
  [[nodiscard]] std::size_t block_of(CellShape shape) const {
    const auto found = std::ranges::find_if(merged_, [shape](const CellBlock& block) { return block.shape == shape; });
    return std::size_t(found - merged_.begin());
  }

  void number_all() {
    first_.assign(parts_.size(), std::vector<Index>(merged_.size(), 0));
    Index next = 0;
    for (std::size_t k = 0; k < merged_.size(); ++k) {
      for (std::size_t part = 0; part < parts_.size(); ++part) {
        first_[part][k] = next;
        for (const CellBlock& block : parts_[part].mesh.*of_)
          next += block.shape == merged_[k].shape ? block.size() : 0;
      }
    }
  }

  const std::vector<NamedMesh>& parts_;
  std::vector<CellBlock> Mesh::*of_;
  std::vector<CellBlock> merged_;
  std::vector<std::vector<Index>> first_;  ///< per part and merged block: the number of the part's first one there
};

/// Adds the groups of a part with new tags, since tags must be unique within a dimension.
void add_groups(const NamedMesh& part, const BlockMerger& cells, const BlockMerger& facets, std::size_t number,
                Mesh& mesh) {
  for (const Group& group : part.mesh.groups) {
    const auto same =
        std::ranges::count_if(mesh.groups, [&](const Group& other) { return other.dimension == group.dimension; });
    Group merged{mesh.parts.back().group_name(group.name), int(same) + 1, group.dimension, {}};
    const BlockMerger& numbers = group.dimension == mesh.dimension ? cells : facets;
    for (const Index member : group.members) merged.members.push_back(numbers.number(number, member));
    std::ranges::sort(merged.members);
    mesh.groups.push_back(std::move(merged));
  }
}

std::vector<Index> cells_of(const NamedMesh& part, const BlockMerger& cells, std::size_t number) {
  std::vector<Index> result;
  for (Index cell = 0; cell < part.mesh.cell_count(); ++cell) result.push_back(cells.number(number, cell));
  std::ranges::sort(result);
  return result;
}

void note_numbers(const std::vector<NamedMesh>& parts, std::int64_t step) {
  for (std::size_t i = 1; i < parts.size(); ++i)
    log::info(fmt::format("part \"{}\": the numbers of its nodes and elements are those in the file plus {}",
                          parts[i].name, step * std::int64_t(i)));
}

}  // namespace

std::string mismatch_of_parts(const NamedMesh& first, const NamedMesh& other) {
  if (first.mesh.dimension != other.mesh.dimension) {
    return fmt::format(
        "part \"{}\" is a mesh of dimension {}, part \"{}\" of dimension {}: all parts must have the same dimension; "
        "use meshes of solids for all of them, or plane meshes for all",
        other.name, other.mesh.dimension, first.name, first.mesh.dimension);
  }
  if (first.mesh.degree != other.mesh.degree) {
    return fmt::format(
        "part \"{}\" is a mesh of degree {}, part \"{}\" of degree {}: all parts must have cells of the same degree; "
        "mesh them alike (gmsh FILE.geo -2 or -3 with -order {} writes such a mesh)",
        other.name, other.mesh.degree, first.name, first.mesh.degree, first.mesh.degree);
  }
  return "";
}

Mesh merge_parts(const std::vector<NamedMesh>& parts) {
  for (const NamedMesh& part : parts) {
    if (const std::string why = mismatch_of_parts(parts.front(), part); !why.empty())
      throw Error(ErrorKind::invalid_input, why);
  }
  Mesh mesh;
  mesh.source = source_of(parts);
  mesh.dimension = parts.front().mesh.dimension;
  mesh.degree = parts.front().mesh.degree;
  const std::int64_t step = tag_step(parts);
  BlockMerger cells(parts, &Mesh::cells), facets(parts, &Mesh::facets);
  Index nodes = 0;
  for (const NamedMesh& part : parts) nodes += part.mesh.node_count();
  mesh.nodes.resize(mesh.dimension, nodes);
  nodes = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Mesh& part = parts[i].mesh;
    const std::int64_t more = step * std::int64_t(i);
    mesh.nodes.middleCols(nodes, part.node_count()) = part.nodes;
    for (const std::int64_t tag : part.node_tags) mesh.node_tags.push_back(tag + more);
    cells.append(i, nodes, more);
    facets.append(i, nodes, more);
    mesh.parts.push_back({parts[i].name, nodes, part.node_count(), cells_of(parts[i], cells, i)});
    add_groups(parts[i], cells, facets, i, mesh);
    nodes += part.node_count();
  }
  mesh.cells = cells.release();
  mesh.facets = facets.release();
  note_numbers(parts, step);
  return mesh;
}

}  // namespace ricochet
