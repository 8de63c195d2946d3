#include <fmt/format.h>

#include <algorithm>

#include "ricochet/mesh/build_mesh.hpp"
#include "ricochet/mesh/offenders.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/vertex_set_table.hpp"

namespace ricochet::gmsh {

namespace {

enum class Match : char { none, vertices, all_nodes };

/// Searches for the facets of one block among the facets of the cells.
class FacetFinder {
 public:
  FacetFinder(const Mesh& mesh, const CellBlock& facets, std::size_t node_count)
      : degree_(mesh.degree),
        facets_(facets),
        vertex_count_(vertex_count(facets.shape)),
        table_(vertex_count_, facets.tags.size()),
        marked_(node_count),
        matches_(facets.tags.size(), Match::none) {
    for (Index i = 0; i < facets.size(); ++i) {
      table_.find_or_add(facets.cell(i));
      for (int k = 0; k < vertex_count_; ++k) marked_[std::size_t(facets.cell(i)[k])] = 1;
    }
  }

  void search(const CellBlock& cells) {
    std::vector<Index> nodes(static_cast<std::size_t>(facets_.nodes_per_cell));
    std::vector<std::vector<int>> locals;
    for (std::size_t facet = 0; facet < facet_nodes(cells.shape, degree_).size(); ++facet) {
      if (facet_shape(cells.shape, facet) == facets_.shape) locals.push_back(facet_nodes(cells.shape, degree_)[facet]);
    }
    for (Index i = 0; i < cells.size(); ++i) {
      for (const std::vector<int>& local : locals) {
        if (!candidate(cells.cell(i), local)) continue;
        for (std::size_t k = 0; k < nodes.size(); ++k) nodes[k] = cells.cell(i)[local[k]];
        compare(nodes);
      }
    }
  }

  const std::vector<Match>& matches() const { return matches_; }

 private:
  // Few facets of a cell have all their vertices on the facets searched for; this check spares the others the hash
  // table.
  bool candidate(const Index* cell, const std::vector<int>& local) const {
    for (int k = 0; k < vertex_count_; ++k) {
      if (marked_[std::size_t(cell[local[std::size_t(k)]])] == 0) return false;
    }
    return true;
  }

  void compare(const std::vector<Index>& nodes) {
    const Index found = table_.find(nodes.data());
    if (found < 0) return;
    const bool all = std::is_permutation(nodes.begin(), nodes.end(), facets_.cell(found));
    Match& match = matches_[std::size_t(found)];
    match = std::max(match, all ? Match::all_nodes : Match::vertices);
  }

  int degree_;
  const CellBlock& facets_;
  int vertex_count_;
  VertexSetTable table_;
  std::vector<char> marked_;
  std::vector<Match> matches_;
};

std::size_t count_nodes(const Mesh& mesh) {
  Index largest = -1;
  for (const auto* blocks : {&mesh.cells, &mesh.facets}) {
    for (const CellBlock& block : *blocks) {
      for (const Index node : block.nodes) largest = std::max(largest, node);
    }
  }
  return std::size_t(largest + 1);
}

}  // namespace

void check_facets(const Mesh& mesh) {
  std::vector<Match> matches;
  std::vector<std::int64_t> tags;
  const std::size_t nodes = count_nodes(mesh);
  for (const CellBlock& facets : mesh.facets) {
    FacetFinder finder(mesh, facets, nodes);
    for (const CellBlock& cells : mesh.cells) finder.search(cells);
    matches.insert(matches.end(), finder.matches().begin(), finder.matches().end());
    tags.insert(tags.end(), facets.tags.begin(), facets.tags.end());
  }
  for (const Group& group : mesh.groups) {
    if (group.dimension != mesh.dimension - 1) continue;
    Offenders alone;
    Offenders other_nodes;
    for (const Index member : group.members) {
      const auto i = std::size_t(member);
      if (matches[i] == Match::none) alone.add(tags[i]);
      if (matches[i] == Match::vertices) other_nodes.add(tags[i]);
    }
    const char* kind = mesh.dimension == 3 ? "surface element" : "line element";
    if (alone.any()) {
      fail_mesh(mesh.source,
                fmt::format("in the group \"{}\", {} {} not on the boundary of any cell; parts of dimension {} in a "
                            "mesh of dimension {} are not supported",
                            group.name, alone.text(kind), alone.count() == 1 ? "is" : "are", mesh.dimension - 1,
                            mesh.dimension));
    }
    if (other_nodes.any()) {
      fail_mesh(mesh.source,
                fmt::format("in the group \"{}\", {} share{} the vertices of a cell but not its second-order nodes",
                            group.name, other_nodes.text(kind), other_nodes.count() == 1 ? "s" : ""));
    }
  }
}

}  // namespace ricochet::gmsh
