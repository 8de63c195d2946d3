#include "ricochet/mesh/derived_groups.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>

#include "ricochet/mesh/boundary_facets.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/vertex_set_table.hpp"

namespace ricochet {

namespace {

int free_tag(const Mesh& mesh, int dimension) {
  int largest = 0;
  for (const Group& group : mesh.groups) {
    if (group.dimension == dimension) largest = std::max(largest, group.tag);
  }
  return largest == std::numeric_limits<int>::max() ? 0 : largest + 1;
}

std::vector<Index> numbers_up_to(Index count) {
  std::vector<Index> numbers(static_cast<std::size_t>(count));
  std::iota(numbers.begin(), numbers.end(), Index{0});
  return numbers;
}

/// Index of the block of a shape, created if missing; blocks stay in the order of the shapes, as the reader leaves
/// them.
std::size_t block_of(Mesh& mesh, CellShape shape) {
  const auto found =
      std::ranges::find_if(mesh.facets, [shape](const CellBlock& block) { return block.shape >= shape; });
  const auto index = std::size_t(found - mesh.facets.begin());
  if (found == mesh.facets.end() || found->shape != shape)
    mesh.facets.insert(found, CellBlock{shape, node_count(shape, mesh.degree), {}, {}});
  return index;
}

std::vector<Index> first_numbers(const std::vector<CellBlock>& blocks) {
  std::vector<Index> first{0};
  for (const CellBlock& block : blocks) first.push_back(first.back() + block.size());
  return first;
}

/// Adds facets to a block and returns their numbers in it, both of new and of existing ones.
std::vector<Index> add_facets(const Mesh& mesh, const std::vector<CellFacet>& facets, CellBlock& block) {
  VertexSetTable table(vertex_count(block.shape), facets.size() + block.tags.size());
  for (Index i = 0; i < block.size(); ++i) table.find_or_add(block.cell(i));
  std::vector<Index> members;
  for (const CellFacet& facet : facets) {
    const std::vector<Index> nodes = nodes_of_facet(mesh.cells, facet);
    const auto size = std::ptrdiff_t(block.nodes.size());
    block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
    const Index existing = table.find_or_add(block.nodes.data() + size);
    if (existing >= 0) {
      block.nodes.resize(std::size_t(size));
      members.push_back(existing);
    } else {
      members.push_back(block.size());
      block.tags.push_back(0);
    }
  }
  std::ranges::sort(members);
  return members;
}

/// Renumbers facets, which are numbered through all blocks: those behind a block that has grown have new numbers.
void renumber(const std::vector<Index>& before, const std::vector<Index>& after, int dimension, Mesh& mesh) {
  for (Group& group : mesh.groups) {
    if (group.dimension != dimension) continue;
    for (Index& member : group.members) {
      const auto block = std::size_t(std::ranges::upper_bound(before, member) - before.begin()) - 1;
      member += after[block] - before[block];
    }
  }
}

/// Adds a group of the boundary facets that satisfy `selects(facet)`.
template <class Selects>
void add_boundary(Mesh& mesh, const std::string& name, const Selects& selects) {
  std::map<CellShape, std::vector<CellFacet>> by_shape;
  for (const CellFacet& facet : boundary_facets(mesh.cells)) {
    if (selects(facet)) by_shape[facet_shape(mesh.cells[facet.block].shape, facet.local)].push_back(facet);
  }
  Group boundary{name, free_tag(mesh, mesh.dimension - 1), mesh.dimension - 1, {}};
  for (const auto& [shape, facets] : by_shape) (void)block_of(mesh, shape);
  const std::vector<Index> before = first_numbers(mesh.facets);
  std::vector<std::vector<Index>> members;
  for (CellBlock& block : mesh.facets) members.push_back(add_facets(mesh, by_shape[block.shape], block));
  const std::vector<Index> after = first_numbers(mesh.facets);
  renumber(before, after, mesh.dimension - 1, mesh);
  for (std::size_t block = 0; block < members.size(); ++block) {
    for (const Index member : members[block]) boundary.members.push_back(after[block] + member);
  }
  mesh.groups.push_back(std::move(boundary));
}

/// The group that a built-in name denotes.
struct BuiltIn {
  bool exists = false;
  const MeshPart* part = nullptr;  ///< null: the whole mesh
};

BuiltIn find_built_in(const Mesh& mesh, const std::string& name, int dimension) {
  if (dimension != mesh.dimension && dimension != mesh.dimension - 1) return {};
  const std::string of_whole = dimension == mesh.dimension ? all_cells_name : whole_boundary_name;
  if (name == of_whole) return {true, nullptr};
  for (const MeshPart& part : mesh.parts) {
    if (name == part.group_name(of_whole)) return {true, &part};
  }
  return {};
}

}  // namespace

bool is_built_in_group(const Mesh& mesh, const std::string& name, int dimension) {
  return find_built_in(mesh, name, dimension).exists;
}

void add_built_in_group(Mesh& mesh, const std::string& name, int dimension) {
  if (mesh.find_group(name, dimension) != nullptr) return;
  const auto [exists, part] = find_built_in(mesh, name, dimension);
  if (!exists) return;
  if (dimension == mesh.dimension - 1) {
    return add_boundary(mesh, name, [&mesh, part = part](const CellFacet& facet) {
      return part == nullptr || part->has_node(mesh.cells[facet.block].cell(facet.cell)[0]);
    });
  }
  mesh.groups.push_back(
      {name, free_tag(mesh, dimension), dimension, part != nullptr ? part->cells : numbers_up_to(mesh.cell_count())});
}

void add_boundary_of_cells(Mesh& mesh, const std::string& name, const std::vector<char>& cells) {
  const std::vector<Index> first = first_numbers(mesh.cells);
  add_boundary(mesh, name,
               [&](const CellFacet& facet) { return cells[std::size_t(first[facet.block] + facet.cell)] != 0; });
}

void add_union_of_groups(Mesh& mesh, const std::string& name, const std::vector<std::string>& parts, int dimension) {
  if (mesh.find_group(name, dimension) != nullptr) return;
  Group result{name, free_tag(mesh, dimension), dimension, {}};
  for (const std::string& part : parts) {
    const std::vector<Index>& members = mesh.group(part, dimension).members;
    result.members.insert(result.members.end(), members.begin(), members.end());
  }
  std::ranges::sort(result.members);
  result.members.erase(std::unique(result.members.begin(), result.members.end()), result.members.end());
  mesh.groups.push_back(std::move(result));
}

}  // namespace ricochet
