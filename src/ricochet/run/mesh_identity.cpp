#include "ricochet/run/mesh_identity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "ricochet/base/checksum.hpp"

namespace ricochet {

namespace {

std::vector<MeshChecksum> of_whole(const Mesh& mesh) {
  Checksum cells, facets, groups;
  for (const CellBlock& block : mesh.cells) cells.add(block.nodes.data(), block.nodes.size());
  for (const CellBlock& block : mesh.facets) facets.add(block.nodes.data(), block.nodes.size());
  for (const Group& group : mesh.groups) {
    groups.add(group.name.data(), group.name.size()).add(&group.dimension, 1);
    groups.add(group.members.data(), group.members.size());
  }
  const Checksum nodes = Checksum().add(mesh.nodes.data(), static_cast<std::size_t>(mesh.nodes.size()));
  return {{"boundary facets", "", facets.text()},
          {"cells", "", cells.text()},
          {"groups", "", groups.text()},
          {"nodes", "", nodes.text()}};
}

/// Checksums of one part, with its own numbering, so that changes in other parts leave them unchanged.
class PartChecksums {
 public:
  PartChecksums(const Mesh& mesh, const MeshPart& part) : mesh_(mesh), part_(part) {
    for (Index facet = 0; facet < mesh.facet_count(); ++facet) {
      const IndexInBlocks at = locate_in_blocks(mesh.facets, facet);
      if (part.has_node(mesh.facets[at.block].cell(at.local)[0])) facets_.push_back(facet);
    }
  }

  void append_to(std::vector<MeshChecksum>& sums) const {
    const auto add = [&](const char* what, const Checksum& sum) {
      sums.push_back({fmt::format("{} of part \"{}\"", what, part_.name), part_.name, sum.text()});
    };
    add("boundary facets", of_nodes(mesh_.facets, facets_));
    add("cells", of_nodes(mesh_.cells, part_.cells));
    add("groups", of_groups());
    add("nodes", Checksum().add(mesh_.nodes.data() + part_.first_node * mesh_.nodes.rows(),
                                static_cast<std::size_t>(part_.node_count * mesh_.nodes.rows())));
  }

 private:
  [[nodiscard]] Checksum of_nodes(const std::vector<CellBlock>& blocks, const std::vector<Index>& members) const {
    Checksum sum;
    std::vector<Index> nodes;
    for (const Index member : members) {
      const IndexInBlocks at = locate_in_blocks(blocks, member);
      const CellBlock& block = blocks[at.block];
      nodes.assign(block.cell(at.local), block.cell(at.local) + block.nodes_per_cell);
      for (Index& node : nodes) node -= part_.first_node;
      sum.add(nodes.data(), nodes.size());
    }
    return sum;
  }

  [[nodiscard]] Checksum of_groups() const {
    Checksum sum;
    for (const Group& group : mesh_.groups) {
      if (!group.name.starts_with(part_.group_name(""))) continue;
      const std::vector<Index>& all = group.dimension == mesh_.dimension ? part_.cells : facets_;
      std::vector<Index> members;
      for (const Index member : group.members)
        members.push_back(std::lower_bound(all.begin(), all.end(), member) - all.begin());
      sum.add(group.name.data(), group.name.size()).add(&group.dimension, 1);
      sum.add(members.data(), members.size());
    }
    return sum;
  }

  const Mesh& mesh_;
  const MeshPart& part_;
  std::vector<Index> facets_;
};

}  // namespace

std::vector<MeshChecksum> mesh_checksums(const Mesh& mesh) {
  if (mesh.parts.empty()) return of_whole(mesh);
  std::vector<MeshChecksum> sums;
  Checksum order;
  for (const MeshPart& part : mesh.parts) {
    PartChecksums(mesh, part).append_to(sums);
    order.add(part.name.data(), part.name.size() + 1);  // including the terminating zero
  }
  sums.push_back({"the order of the parts", "", order.text()});
  return sums;
}

}  // namespace ricochet
