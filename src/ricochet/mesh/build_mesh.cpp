#include "ricochet/mesh/build_mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/mesh/check_overlaps.hpp"
#include "ricochet/mesh/gmsh_elements.hpp"
#include "ricochet/mesh/offenders.hpp"

namespace ricochet::gmsh {

namespace {

void check_coordinates(const RawMesh& raw, const std::string& source) {
  Offenders not_finite;
  for (std::size_t i = 0; i < raw.node_tags.size(); ++i) {
    const double* position = raw.coordinates.data() + 3 * i;
    if (!std::isfinite(position[0]) || !std::isfinite(position[1]) || !std::isfinite(position[2])) {
      not_finite.add(raw.node_tags[i]);
    }
  }
  if (not_finite.any()) fail_mesh(source, fmt::format("coordinates are not finite at {}", not_finite.text("node")));
}

/// Names groups for a file that has none: see BuildOptions.
class EntityNamer {
 public:
  EntityNamer(int dimension, RawMesh& raw) : dimension_(dimension), raw_(raw) {}

  /// Makes the groups and returns a note about them.
  std::string name_all() {
    number_entities();
    raw_.physical_names[{dimension_, body_tag}] = "body";
    for (RawElements& elements : raw_.elements) {
      const int dimension = find_element_type(elements.type)->dimension;
      if (dimension == dimension_) elements.groups = {body_tag};
      if (const int tag = tag_of(dimension, elements.entity); tag != 0) elements.groups.push_back(tag);
    }
    std::string text = "the mesh has no physical groups; all cells are in the group \"body\"";
    if (cell_entities_.size() > 1) text += fmt::format(" and in {}", describe(dimension_, cell_entities_.size()));
    if (!facet_entities_.empty())
      text += fmt::format(", and the facets in {}", describe(dimension_ - 1, facet_entities_.size()));
    return text;
  }

 private:
  static constexpr int body_tag = 1;

  /// Numbers the groups. Groups of the cells of a single body would only repeat "body"; 0 is not an entity.
  void number_entities() {
    for (const RawElements& elements : raw_.elements) {
      const int dimension = find_element_type(elements.type)->dimension;
      if (elements.entity == 0 || elements.tags.empty()) continue;
      if (dimension == dimension_) cell_entities_.try_emplace(elements.entity, 0);
      if (dimension == dimension_ - 1) facet_entities_.try_emplace(elements.entity, 0);
    }
    int tag = body_tag;
    for (auto& [entity, number] : cell_entities_) {
      number = ++tag;
      if (cell_entities_.size() > 1) raw_.physical_names[{dimension_, number}] = name(dimension_, entity);
    }
    tag = 0;
    for (auto& [entity, number] : facet_entities_) {
      number = ++tag;
      raw_.physical_names[{dimension_ - 1, number}] = name(dimension_ - 1, entity);
    }
  }

  /// Returns the tag of the group of an entity; 0 if it has none.
  [[nodiscard]] int tag_of(int dimension, int entity) const {
    const bool cells = dimension == dimension_ && cell_entities_.size() > 1;
    if (!cells && dimension != dimension_ - 1) return 0;
    const auto& entities = cells ? cell_entities_ : facet_entities_;
    const auto found = entities.find(entity);
    return found == entities.end() ? 0 : found->second;
  }

  static std::string kind(int dimension) { return dimension == 3 ? "volume" : dimension == 2 ? "surface" : "curve"; }
  static std::string name(int dimension, int entity) { return fmt::format("{} {}", kind(dimension), entity); }
  static std::string describe(int dimension, std::size_t count) {
    return fmt::format("{} \"{} N\", where N is Gmsh's number of the {}", counted(count, "group"), kind(dimension),
                       kind(dimension));
  }

  int dimension_;
  RawMesh& raw_;
  std::map<int, int> cell_entities_;  ///< tags of groups by tags of entities
  std::map<int, int> facet_entities_;
};

bool has_groups(const RawMesh& raw) {
  return !raw.physical_names.empty() ||
         std::ranges::any_of(raw.elements, [](const RawElements& e) { return !e.groups.empty(); });
}

/// Checks that a mesh of dimension 2 lies in a plane z = constant.
void check_plane(const RawMesh& raw, const std::vector<Index>& used, const std::string& source) {
  Eigen::Map<const Eigen::Matrix3Xd> all(raw.coordinates.data(), 3, Index(raw.node_tags.size()));
  const Eigen::Matrix3Xd positions = all(Eigen::all, used);
  const double size = (positions.rowwise().maxCoeff() - positions.rowwise().minCoeff()).maxCoeff();
  const double first = positions(2, 0);
  Offenders out_of_plane;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const bool in_plane = std::abs(positions(2, Index(i)) - first) <= 1e-12 * size;
    if (!in_plane) out_of_plane.add(raw.node_tags[std::size_t(used[i])]);
  }
  if (out_of_plane.any()) {
    fail_mesh(
        source,
        fmt::format("a mesh of surfaces must lie in a plane z = constant, but z differs from that of node {} at {} "
                    "(shells are not supported; if this should be a solid, its volume is not meshed or not in a "
                    "physical group)",
                    raw.node_tags[std::size_t(used[0])], out_of_plane.text("node")));
  }
}

}  // namespace

NodeNumbering::NodeNumbering(std::span<const std::int64_t> tags, const std::string& source) {
  std::int64_t largest = 0;
  Offenders not_positive;
  for (const std::int64_t tag : tags) {
    if (tag <= 0) not_positive.add(tag);
    largest = std::max(largest, tag);
  }
  if (not_positive.any())
    fail_mesh(source, fmt::format("node numbers must be positive; found {}", not_positive.text("node")));
  Offenders repeated;
  if (largest / 4 <= std::int64_t(tags.size())) {
    dense_.assign(std::size_t(largest) + 1, -1);
    for (std::size_t i = 0; i < tags.size(); ++i) {
      Index& index = dense_[std::size_t(tags[i])];
      if (index >= 0) repeated.add(tags[i]);
      index = Index(i);
    }
  } else {
    sorted_.reserve(tags.size());
    for (std::size_t i = 0; i < tags.size(); ++i) sorted_.emplace_back(tags[i], Index(i));
    std::ranges::sort(sorted_);
    for (std::size_t i = 1; i < sorted_.size(); ++i) {
      if (sorted_[i].first == sorted_[i - 1].first) repeated.add(sorted_[i].first);
    }
  }
  if (repeated.any()) fail_mesh(source, fmt::format("defined more than once in $Nodes: {}", repeated.text("node")));
}

Index NodeNumbering::find_sorted(std::int64_t tag) const {
  const auto found = std::ranges::lower_bound(sorted_, std::pair<std::int64_t, Index>{tag, 0});
  return found != sorted_.end() && found->first == tag ? found->second : -1;
}

void keep_used_nodes(const RawMesh& raw, double scale, Mesh& mesh) {
  std::vector<Index> new_number(raw.node_tags.size(), -1);
  for (const CellBlock& block : mesh.cells) {
    for (const Index node : block.nodes) new_number[std::size_t(node)] = 0;
  }
  std::vector<Index> used;
  for (std::size_t i = 0; i < new_number.size(); ++i) {
    if (new_number[i] < 0) continue;
    new_number[i] = Index(used.size());
    used.push_back(Index(i));
  }
  if (mesh.dimension == 2) check_plane(raw, used, mesh.source);
  if (const std::size_t dropped = raw.node_tags.size() - used.size(); dropped > 0) {
    log::info(fmt::format("{}: left out {} that no cell uses", mesh.source, counted(dropped, "node")));
  }
  for (auto* blocks : {&mesh.cells, &mesh.facets}) {
    for (CellBlock& block : *blocks) {
      for (Index& node : block.nodes) node = new_number[std::size_t(node)];
    }
  }
  mesh.nodes.resize(mesh.dimension, Index(used.size()));
  mesh.node_tags.resize(used.size());
  for (std::size_t i = 0; i < used.size(); ++i) {
    const auto old = std::size_t(used[i]);
    mesh.node_tags[i] = raw.node_tags[old];
    for (int axis = 0; axis < mesh.dimension; ++axis) {
      mesh.nodes(axis, Index(i)) = scale * raw.coordinates[3 * old + std::size_t(axis)];
    }
  }
  if (!mesh.nodes.allFinite())
    fail_mesh(mesh.source, fmt::format("coordinates overflow when multiplied by the scale {}", scale));
}

Mesh build_mesh(RawMesh raw, const BuildOptions& options) {
  Mesh mesh;
  mesh.source = options.source;
  check_coordinates(raw, mesh.source);
  if (options.name_entities && !has_groups(raw)) {
    const std::string note = EntityNamer(select_elements(raw, mesh.source).dimension, raw).name_all();
    log::info(fmt::format("{}: {}", mesh.source, note));
  }
  const Selection selection = select_elements(raw, mesh.source);
  mesh.dimension = selection.dimension;
  mesh.degree = selection.degree;
  add_groups(raw, mesh.source, mesh);
  const NodeNumbering numbering(raw.node_tags, mesh.source);
  mesh.cells = collect_cells(selection.cells, numbering, mesh);
  mesh.facets = collect_cells(selection.facets, numbering, mesh);
  check_facets(mesh);
  keep_used_nodes(raw, options.scale, mesh);
  orient_cells(mesh);
  warn_of_overlaps(mesh);
  check_coincident_nodes(mesh, options.bodies_may_touch);
  return mesh;
}

}  // namespace ricochet::gmsh
