#include "ricochet/fem/connected_bodies.hpp"

#include <algorithm>
#include <limits>

#include "ricochet/base/point_sets.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/fem/mesh_measures.hpp"
#include "ricochet/fem/wave_speed.hpp"
#include "ricochet/mesh/disjoint_sets.hpp"

namespace ricochet {

ConnectedBodies find_connected_bodies(const DisplacementSpace& space) {
  DisjointSets sets(space.node_count());
  each_cell(space.cells, [&](Index, std::span<const Index> nodes) {
    for (const Index node : nodes.subspan(1)) sets.join(nodes[0], node);
  });
  for (const auto& [one, other] : space.glued) sets.join(one, other);
  ConnectedBodies result;
  const auto count = std::size_t(space.node_count());
  std::vector<int> of_root(count, -1);
  each_cell(space.cells, [&](Index, std::span<const Index> nodes) {
    int& body = of_root[std::size_t(sets.root(nodes[0]))];
    if (body < 0) body = result.count++;
    result.of_cell.push_back(body);
  });
  result.of_node.reserve(count);
  for (Index node = 0; node < space.node_count(); ++node)
    result.of_node.push_back(of_root[std::size_t(sets.root(node))]);
  return result;
}

std::vector<std::string> names_of_bodies(const Mesh& mesh, const ConnectedBodies& bodies) {
  if (bodies.count == 1) return {"the body"};
  const auto count = std::size_t(bodies.count);
  const auto body_of = [&](Index cell) { return std::size_t(bodies.of_cell[std::size_t(cell)]); };
  std::vector<std::size_t> cells(count, 0);
  for (const int body : bodies.of_cell) ++cells[std::size_t(body)];
  std::vector<std::string> equal_group(count);         // a group that is exactly this body
  std::vector<std::vector<std::string>> parts(count);  // groups that lie entirely within this body
  const auto compare = [&](const std::string& name, const std::vector<Index>& members) {
    if (members.empty()) return;
    const std::size_t body = body_of(members.front());
    if (!std::ranges::all_of(members, [&](Index cell) { return body_of(cell) == body; })) return;
    parts[body].push_back(name);
    if (equal_group[body].empty() && members.size() == cells[body]) equal_group[body] = name;
  };
  std::vector<std::size_t> in_parts(count, 0);
  for (const MeshPart& part : mesh.parts) {  // a body from one or several mesh files of its own is named after them
    compare(part.name, part.cells);
    if (!part.cells.empty()) in_parts[body_of(part.cells.front())] += part.cells.size();
  }
  const std::vector<std::vector<std::string>> files = parts;
  for (const Group& group : mesh.groups) {
    if (group.dimension == mesh.dimension) compare(group.name, group.members);
  }
  std::vector<std::string> result;
  for (std::size_t body = 0; body < count; ++body) {
    if (!equal_group[body].empty()) {
      parts[body] = {equal_group[body]};
    } else if (!files[body].empty() && in_parts[body] == cells[body]) {
      parts[body] = files[body];
    }
    result.push_back("body " + (parts[body].empty() ? std::to_string(body) : join_names(parts[body])));
  }
  return result;
}

std::vector<double> body_diameters(const Body& body, const ConnectedBodies& bodies) {
  const Points& nodes = body.space->nodes;
  std::vector<std::vector<Index>> nodes_of(static_cast<std::size_t>(bodies.count));
  for (Index node = 0; node < nodes.cols(); ++node) {
    const int number = bodies.of_node[std::size_t(node)];
    if (number >= 0) nodes_of[std::size_t(number)].push_back(node);  // else of a rigid body
  }
  std::vector<double> result;
  for (const std::vector<Index>& own : nodes_of) result.push_back(enclosing_diameter(nodes(Eigen::all, own)));
  return result;
}

std::vector<double> wave_crossing_times(const Body& body, const ConnectedBodies& bodies) {
  const std::vector<double> diameters = body_diameters(body, bodies);
  const auto count = std::size_t(bodies.count);
  std::vector<double> speed(count, std::numeric_limits<double>::infinity()), result;
  for (std::size_t cell = 0; cell < bodies.of_cell.size(); ++cell) {
    const Material& material = body.materials[std::size_t(body.cell_material[cell])];
    double& slowest = speed[std::size_t(bodies.of_cell[cell])];
    slowest = std::min(slowest, compression_wave_speed(material, is_plane_stress(body)));
  }
  for (std::size_t b = 0; b < count; ++b) result.push_back(diameters[b] / speed[b]);
  return result;
}

BodiesOfMesh describe_bodies(const Body& body) {
  BodiesOfMesh result;
  result.connected = find_connected_bodies(*body.space);
  result.names = names_of_bodies(*body.mesh, result.connected);
  result.sizes = body_diameters(body, result.connected);
  result.crossing_times = wave_crossing_times(body, result.connected);
  result.boundary = boundary_facets(body.space->cells);
  return result;
}

namespace {

/// Time in which a compression wave crosses the height of each cell.
std::vector<double> unsorted_crossing_times(const Body& body) {
  std::vector<double> times = cell_heights(*body.mesh);
  for (std::size_t cell = 0; cell < times.size(); ++cell) {
    const Material& material = body.materials[std::size_t(body.cell_material[cell])];
    times[cell] /= compression_wave_speed(material, is_plane_stress(body));
  }
  return times;
}

}  // namespace

std::vector<double> cell_crossing_times(const Body& body) {
  std::vector<double> times = unsorted_crossing_times(body);
  std::ranges::sort(times);
  return times;
}

std::vector<double> median_crossing_times(const Body& body) {
  const std::vector<double> times = unsorted_crossing_times(body);
  std::vector<std::vector<double>> of_material(body.materials.size());
  for (std::size_t cell = 0; cell < times.size(); ++cell)
    of_material[std::size_t(body.cell_material[cell])].push_back(times[cell]);
  std::vector<double> result;
  for (std::vector<double>& own : of_material) {
    std::ranges::sort(own);
    result.push_back(own.empty() ? 0.0 : own[own.size() / 2]);
  }
  return result;
}

}  // namespace ricochet
