#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdlib>

#include "ricochet/mesh/gmsh_elements.hpp"
#include "ricochet/mesh/msh_sections.hpp"

/// Format 2.2. The counts at the head of $Nodes and $Elements are text in binary files, too.
namespace ricochet::gmsh {

namespace {

std::size_t read_count(Cursor& cursor, const char* what, std::size_t text_bytes_each, std::size_t binary_bytes_each) {
  TextReader text(cursor);
  text.begin_record();
  const std::size_t bytes_each = cursor.binary() ? binary_bytes_each : text_bytes_each;
  const std::size_t count = text.count(what, bytes_each, bytes_each);
  text.end_record();
  return count;
}

/// Finds the block to which an element belongs. Files need not be sorted, and a block for each run of equal elements
/// could give as many blocks as elements.
class Blocks {
 public:
  explicit Blocks(std::vector<RawElements>& elements) : elements_(elements) {}

  RawElements& find(int type, int group, int entity) {
    const std::array<int, 3> key{type, group, entity};
    if (last_ == nowhere || key != last_key_) {
      const auto [found, added] = index_.try_emplace(key, elements_.size());
      if (added) add(type, group, entity);
      last_ = found->second;
      last_key_ = key;
    }
    return elements_[last_];
  }

 private:
  void add(int type, int group, int entity) {
    RawElements& block = elements_.emplace_back();
    block.type = type;
    block.entity = entity;
    // A negative tag orients the entity within its group; Gmsh has reversed the elements already.
    if (group != 0) block.groups.push_back(std::abs(group));
  }

  static constexpr std::size_t nowhere = std::size_t(-1);
  std::vector<RawElements>& elements_;
  std::map<std::array<int, 3>, std::size_t> index_;
  std::array<int, 3> last_key_{};
  std::size_t last_ = nowhere;
};

const ElementType& fixed_type(const Cursor& cursor, int number) {
  const ElementType* type = find_element_type(number);
  if (type == nullptr || type->node_count == 0) {
    cursor.fail(fmt::format("elements of {} are not supported", describe_type(number)));
  }
  return *type;
}

/// Adds an element from the numbers after its type; `read` returns the next one. The first of its tags is the physical
/// group and the second the geometric entity; the others concern partitions.
template <class Read>
void add_element(const Cursor& cursor, Blocks& blocks, const ElementType& type, std::int64_t tag, int tag_count,
                 Read read) {
  int group = 0;
  int entity = 0;
  for (int i = 0; i < tag_count; ++i) {
    const int value = read("a tag of an element");
    if (i == 0) group = value;
    if (i == 1) entity = value;
  }
  if (group == std::numeric_limits<int>::min())
    cursor.fail(fmt::format("element {} is in the invalid physical group {}", tag, group));
  RawElements& block = blocks.find(type.number, group, entity);
  block.tags.push_back(tag);
  for (int i = 0; i < type.node_count; ++i) block.nodes.push_back(read("a node of an element"));
}

void read_text_elements(Cursor& cursor, RawMesh& mesh) {
  const std::size_t count = read_count(cursor, "the number of elements", 6, 6);
  TextReader text(cursor);
  Blocks blocks(mesh.elements);
  for (std::size_t i = 0; i < count; ++i) {
    text.begin_record();
    const std::int64_t tag = text.integer64("an element's number");
    const ElementType& type = fixed_type(cursor, text.integer("an element's type"));
    const int tag_count = text.integer("the number of an element's tags");
    if (tag_count < 0) cursor.fail(fmt::format("element {} has an invalid number of tags, {}", tag, tag_count));
    add_element(cursor, blocks, type, tag, tag_count, [&](const char* what) { return text.integer(what); });
    text.end_record();
  }
}

void read_binary_elements(Cursor& cursor, RawMesh& mesh) {
  const std::size_t count = read_count(cursor, "the number of elements", 8, 8);
  BinaryReader binary(cursor);
  Blocks blocks(mesh.elements);
  const auto read = [&](const char* what) { return binary.integer(what); };
  for (std::size_t done = 0; done < count;) {
    const ElementType& type = fixed_type(cursor, binary.integer("an element's type"));
    const int block_size = binary.integer("the number of elements of a block");
    const int tag_count = binary.integer("the number of tags of a block's elements");
    if (block_size < 1 || std::size_t(block_size) > count - done || tag_count < 0) {
      cursor.fail(fmt::format("a block has {} elements with {} tags each, but {} elements remain", block_size,
                              tag_count, count - done));
    }
    for (int i = 0; i < block_size; ++i)
      add_element(cursor, blocks, type, read("an element's number"), tag_count, read);
    done += std::size_t(block_size);
  }
}

}  // namespace

void read_nodes_22(Cursor& cursor, RawMesh& mesh) {
  const std::size_t count = read_count(cursor, "the number of nodes", 8, sizeof(std::int32_t) + 3 * sizeof(double));
  mesh.node_tags.reserve(count);
  mesh.coordinates.reserve(3 * count);
  const auto read_records = [&](auto reader) {
    for (std::size_t i = 0; i < count; ++i) {
      reader.begin_record();
      mesh.node_tags.push_back(reader.integer("a node's number"));
      for (int axis = 0; axis < 3; ++axis) mesh.coordinates.push_back(reader.number("a node's coordinate"));
      reader.end_record();
    }
  };
  if (cursor.binary()) {
    read_records(BinaryReader(cursor));
  } else {
    read_records(TextReader(cursor));
  }
}

void read_elements_22(Cursor& cursor, RawMesh& mesh) {
  if (cursor.binary()) {
    read_binary_elements(cursor, mesh);
  } else {
    read_text_elements(cursor, mesh);
  }
}

}  // namespace ricochet::gmsh
