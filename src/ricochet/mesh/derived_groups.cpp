#include "ricochet/mesh/derived_groups.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

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

/// One facet of one cell.
struct CellFacet {
  const CellBlock* block = nullptr;
  Index cell = 0;
  std::size_t local = 0;
};

/// Facets of the cells by their vertex of the smallest number, so that equal ones meet.
class FacetBuckets {
 public:
  explicit FacetBuckets(const Mesh& mesh) : mesh_(mesh), starts_(static_cast<std::size_t>(mesh.node_count()) + 1) {
    visit([&](std::size_t vertex, const CellFacet&) { ++starts_[vertex + 1]; });
    std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
    facets_.resize(starts_.back());
    order_.resize(starts_.back());
    std::vector<std::size_t> next(starts_.begin(), starts_.end() - 1);
    std::size_t number = 0;
    visit([&](std::size_t vertex, const CellFacet& facet) {
      order_[number++] = next[vertex];
      facets_[next[vertex]++] = facet;
    });
  }

  /// Those that only one cell has, in the order of the cells.
  [[nodiscard]] std::vector<CellFacet> single() const {
    std::vector<char> shared(facets_.size(), 0);
    for (std::size_t bucket = 0; bucket + 1 < starts_.size(); ++bucket)
      mark_shared(starts_[bucket], starts_[bucket + 1], shared);
    std::vector<CellFacet> result;
    for (const std::size_t place : order_) {
      if (shared[place] == 0) result.push_back(facets_[place]);
    }
    return result;
  }

 private:
  using Key = std::array<Index, 4>;

  [[nodiscard]] Key key(const CellFacet& facet) const {
    const CellShape shape = facet_shape(facet.block->shape);
    const std::vector<int>& local = facet_nodes(facet.block->shape, mesh_.degree)[facet.local];
    const auto count = static_cast<std::size_t>(vertex_count(shape));
    Key result{-1, -1, -1, -1};
    for (std::size_t v = 0; v < count; ++v) {  // insertion: there are at most four
      const Index vertex = facet.block->cell(facet.cell)[local[v]];
      std::size_t place = v;
      for (; place > 0 && result[place - 1] > vertex; --place) result[place] = result[place - 1];
      result[place] = vertex;
    }
    return result;
  }

  template <class Visit>
  void visit(Visit call) const {
    for (const CellBlock& block : mesh_.cells) {
      const std::size_t facets = facet_nodes(block.shape, mesh_.degree).size();
      for (Index cell = 0; cell < block.size(); ++cell) {
        for (std::size_t local = 0; local < facets; ++local) {
          const CellFacet facet{&block, cell, local};
          call(static_cast<std::size_t>(key(facet)[0]), facet);
        }
      }
    }
  }

  void mark_shared(std::size_t first, std::size_t last, std::vector<char>& shared) const {
    std::vector<Key> keys;
    for (std::size_t i = first; i < last; ++i) keys.push_back(key(facets_[i]));
    for (std::size_t i = 0; i < keys.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        if (keys[i] == keys[j]) shared[first + i] = shared[first + j] = 1;
      }
    }
  }

  const Mesh& mesh_;
  std::vector<std::size_t> starts_;
  std::vector<CellFacet> facets_;
  std::vector<std::size_t> order_;  ///< places in facets_, in the order of the cells
};

/// The block of that shape, made when there is none; blocks stay in the order of the shapes, as the reader leaves them.
std::size_t block_of(Mesh& mesh, CellShape shape) {
  const auto found = std::find_if(mesh.facets.begin(), mesh.facets.end(),
                                  [shape](const CellBlock& block) { return block.shape >= shape; });
  const auto place = static_cast<std::size_t>(found - mesh.facets.begin());
  if (found == mesh.facets.end() || found->shape != shape)
    mesh.facets.insert(found, CellBlock{shape, node_count(shape, mesh.degree), {}, {}});
  return place;
}

std::vector<Index> first_numbers(const std::vector<CellBlock>& blocks) {
  std::vector<Index> first{0};
  for (const CellBlock& block : blocks) first.push_back(first.back() + block.size());
  return first;
}

/// Adds facets to a block and returns their numbers in it, whether new or there before.
std::vector<Index> add_facets(const Mesh& mesh, const std::vector<CellFacet>& facets, CellBlock& block) {
  VertexSetTable table(vertex_count(block.shape), facets.size() + block.tags.size());
  for (Index i = 0; i < block.size(); ++i) table.find_or_add(block.cell(i));
  std::vector<Index> members;
  for (const CellFacet& facet : facets) {
    const Index* cell = facet.block->cell(facet.cell);
    const std::vector<int>& local = facet_nodes(facet.block->shape, mesh.degree)[facet.local];
    const auto size = static_cast<std::ptrdiff_t>(block.nodes.size());
    for (const int node : local) block.nodes.push_back(cell[node]);
    const Index known = table.find_or_add(block.nodes.data() + size);
    if (known >= 0) {
      block.nodes.resize(static_cast<std::size_t>(size));
      members.push_back(known);
    } else {
      members.push_back(block.size());
      block.tags.push_back(0);
    }
  }
  std::sort(members.begin(), members.end());
  return members;
}

/// Facets are numbered through all blocks: those behind a block that has grown have other numbers.
void renumber(const std::vector<Index>& before, const std::vector<Index>& after, int dimension, Mesh& mesh) {
  for (Group& group : mesh.groups) {
    if (group.dimension != dimension) continue;
    for (Index& member : group.members) {
      const auto block =
          static_cast<std::size_t>(std::upper_bound(before.begin(), before.end(), member) - before.begin()) - 1;
      member += after[block] - before[block];
    }
  }
}

void add_whole_boundary(Mesh& mesh) {
  std::array<std::vector<CellFacet>, 5> by_shape;  // of CellShape
  for (const CellFacet& facet : FacetBuckets(mesh).single())
    by_shape[static_cast<std::size_t>(facet_shape(facet.block->shape))].push_back(facet);
  Group boundary{whole_boundary_name, free_tag(mesh, mesh.dimension - 1), mesh.dimension - 1, {}};
  for (std::size_t shape = 0; shape < by_shape.size(); ++shape) {
    if (!by_shape[shape].empty()) (void)block_of(mesh, static_cast<CellShape>(shape));
  }
  const std::vector<Index> before = first_numbers(mesh.facets);
  std::vector<std::vector<Index>> members;
  for (CellBlock& block : mesh.facets)
    members.push_back(add_facets(mesh, by_shape[static_cast<std::size_t>(block.shape)], block));
  const std::vector<Index> after = first_numbers(mesh.facets);
  renumber(before, after, mesh.dimension - 1, mesh);
  for (std::size_t block = 0; block < members.size(); ++block) {
    for (const Index member : members[block]) boundary.members.push_back(after[block] + member);
  }
  mesh.groups.push_back(std::move(boundary));
}

}  // namespace

void add_built_in_group(Mesh& mesh, const std::string& name, int dimension) {
  if (mesh.find_group(name, dimension) != nullptr) return;
  if (name == all_cells_name && dimension == mesh.dimension)
    mesh.groups.push_back({name, free_tag(mesh, dimension), dimension, numbers_up_to(mesh.cell_count())});
  if (name == whole_boundary_name && dimension == mesh.dimension - 1) add_whole_boundary(mesh);
}

void add_union_of_groups(Mesh& mesh, const std::string& name, const std::vector<std::string>& parts, int dimension) {
  if (mesh.find_group(name, dimension) != nullptr) return;
  Group result{name, free_tag(mesh, dimension), dimension, {}};
  for (const std::string& part : parts) {
    const std::vector<Index>& members = mesh.group(part, dimension).members;
    result.members.insert(result.members.end(), members.begin(), members.end());
  }
  std::sort(result.members.begin(), result.members.end());
  result.members.erase(std::unique(result.members.begin(), result.members.end()), result.members.end());
  mesh.groups.push_back(std::move(result));
}

}  // namespace ricochet
