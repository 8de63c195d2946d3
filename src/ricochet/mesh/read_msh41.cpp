#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>

#include "ricochet/base/text.hpp"
#include "ricochet/mesh/gmsh_elements.hpp"
#include "ricochet/mesh/msh_sections.hpp"

/// Format 4.1. Text and binary files hold the same numbers in the same order, so Reader is either.
namespace ricochet::gmsh {

namespace {

/// Physical groups of an entity. The sign of a group's tag only orients the entity within the group.
template <class Reader>
std::vector<int> read_physical_tags(Reader& reader) {
  const std::size_t count = reader.count("the number of an entity's physical groups", 2, sizeof(std::int32_t));
  std::vector<int> tags;
  for (std::size_t i = 0; i < count; ++i) {
    const int tag = reader.integer("an entity's physical group");
    if (tag == 0 || tag == std::numeric_limits<int>::min()) {
      reader.cursor().fail(fmt::format("an entity is in the invalid physical group {}", tag));
    }
    tags.push_back(std::abs(tag));
  }
  std::ranges::sort(tags);
  tags.erase(std::unique(tags.begin(), tags.end()), tags.end());
  return tags;
}

template <class Reader>
void read_entities(Reader reader, Entities& entities) {
  constexpr const char* what = "the number of entities of a dimension";
  reader.begin_record();
  std::size_t counts[4];
  for (std::size_t& count : counts) count = reader.count(what, 8, sizeof(std::int32_t) + 4 * sizeof(double));
  reader.end_record();
  for (int dimension = 0; dimension < 4; ++dimension) {
    for (std::size_t i = 0; i < counts[dimension]; ++i) {
      reader.begin_record();
      const int tag = reader.integer("an entity's tag");
      const int box_size = dimension == 0 ? 3 : 6;
      for (int k = 0; k < box_size; ++k) (void)reader.number("an entity's bounding box");
      std::vector<int> groups = read_physical_tags(reader);
      if (!entities.groups.try_emplace({dimension, tag}, std::move(groups)).second) {
        reader.cursor().fail(fmt::format("the entity of dimension {} and tag {} occurs twice", dimension, tag));
      }
      if (dimension > 0) {
        const std::size_t boundary =
            reader.count("the number of an entity's bounding entities", 2, sizeof(std::int32_t));
        for (std::size_t k = 0; k < boundary; ++k) (void)reader.integer("an entity's bounding entity");
      }
      reader.end_record();
    }
  }
}

/// Line at the head of $Nodes and $Elements: blocks, total and the range of tags, on which nothing here relies.
struct Head {
  std::size_t blocks = 0;
  std::size_t total = 0;
};

template <class Reader>
Head read_head(Reader& reader, const char* blocks_what, const char* total_what) {
  Head head;
  reader.begin_record();
  head.blocks = reader.count(blocks_what, 8, 3 * sizeof(std::int32_t) + sizeof(std::uint64_t));
  head.total = reader.count(total_what, 2, sizeof(std::uint64_t));
  (void)reader.tag("the smallest tag");
  (void)reader.tag("the largest tag");
  reader.end_record();
  return head;
}

void check_total(const Cursor& cursor, const char* things, std::size_t found, std::size_t announced) {
  if (found == announced) return;
  cursor.fail(
      fmt::format("the blocks contain {} {}, but the head of the section announces {}", found, things, announced));
}

template <class Reader>
void read_nodes(Reader reader, RawMesh& mesh) {
  const Head head = read_head(reader, "the number of node blocks", "the number of nodes");
  mesh.node_tags.reserve(head.total);
  mesh.coordinates.reserve(3 * head.total);
  for (std::size_t block = 0; block < head.blocks; ++block) {
    reader.begin_record();
    const int dimension = reader.integer("the dimension of a node block's entity");
    (void)reader.integer("the tag of a node block's entity");
    const int parametric = reader.integer("the parametric flag of a node block");
    if (dimension < 0 || dimension > 3 || parametric < 0 || parametric > 1) {
      reader.cursor().fail(
          fmt::format("a node block has dimension {} and parametric flag {}, which is invalid", dimension, parametric));
    }
    const std::size_t count =
        reader.count("the number of nodes of a block", 8, sizeof(std::uint64_t) + 3 * sizeof(double));
    reader.end_record();
    for (std::size_t i = 0; i < count; ++i) {
      reader.begin_record();
      mesh.node_tags.push_back(reader.tag("a node's number"));
      reader.end_record();
    }
    for (std::size_t i = 0; i < count; ++i) {
      reader.begin_record();
      for (int axis = 0; axis < 3; ++axis) mesh.coordinates.push_back(reader.number("a node's coordinate"));
      for (int k = 0; k < parametric * dimension; ++k) (void)reader.number("a node's parametric coordinate");
      reader.end_record();
    }
  }
  check_total(reader.cursor(), "nodes", mesh.node_tags.size(), head.total);
}

/// Physical groups of a block of elements.
std::vector<int> block_groups(const Cursor& cursor, const Entities& entities, int dimension, int entity) {
  if (!entities.present) return {};
  const auto found = entities.groups.find({dimension, entity});
  if (found == entities.groups.end()) {
    cursor.fail(fmt::format("elements are on the entity of dimension {} and tag {}, which is not in $Entities",
                            dimension, entity));
  }
  return found->second;
}

template <class Reader>
void read_elements(Reader reader, const Entities& entities, RawMesh& mesh) {
  const Head head = read_head(reader, "the number of element blocks", "the number of elements");
  std::size_t total = 0;
  for (std::size_t block = 0; block < head.blocks; ++block) {
    reader.begin_record();
    RawElements& elements = mesh.elements.emplace_back();
    const int dimension = reader.integer("the dimension of an element block's entity");
    elements.entity = reader.integer("the tag of an element block's entity");
    elements.type = reader.integer("the element type of a block");
    const ElementType* type = find_element_type(elements.type);
    const std::size_t nodes_each = type == nullptr ? 0 : std::size_t(type->node_count);
    const std::size_t count = reader.count("the number of elements of a block", 2 * (nodes_each + 1),
                                           sizeof(std::uint64_t) * (nodes_each + 1));
    if (nodes_each == 0) {
      reader.cursor().fail(fmt::format("{} of {} {} not supported", counted(count, "element"),
                                       describe_type(elements.type), count == 1 ? "is" : "are"));
    }
    if (type->dimension != dimension) {
      reader.cursor().fail(
          fmt::format("elements of {} are on an entity of dimension {}", describe_type(elements.type), dimension));
    }
    elements.groups = block_groups(reader.cursor(), entities, dimension, elements.entity);
    reader.end_record();
    elements.tags.reserve(count);
    elements.nodes.reserve(count * nodes_each);
    for (std::size_t i = 0; i < count; ++i) {
      reader.begin_record();
      elements.tags.push_back(reader.tag("an element's number"));
      for (std::size_t k = 0; k < nodes_each; ++k) elements.nodes.push_back(reader.tag("a node of an element"));
      reader.end_record();
    }
    total += count;
  }
  check_total(reader.cursor(), "elements", total, head.total);
}

}  // namespace

void read_entities_41(Cursor& cursor, Entities& entities) {
  entities.present = true;
  cursor.binary() ? read_entities(BinaryReader(cursor), entities) : read_entities(TextReader(cursor), entities);
}

void read_nodes_41(Cursor& cursor, RawMesh& mesh) {
  cursor.binary() ? read_nodes(BinaryReader(cursor), mesh) : read_nodes(TextReader(cursor), mesh);
}

void read_elements_41(Cursor& cursor, const Entities& entities, RawMesh& mesh) {
  cursor.binary() ? read_elements(BinaryReader(cursor), entities, mesh)
                  : read_elements(TextReader(cursor), entities, mesh);
}

}  // namespace ricochet::gmsh
