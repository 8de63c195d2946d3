#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file Checks of cases with mesh.plane = "axisymmetric", and the conditions on the axis x = 0.
namespace ricochet {

namespace {

/// Distance from the axis, relative to the size of the mesh, within which nodes count as lying on it. Mesh files round
/// coordinates, and the cosine of a right angle is not exactly zero.
constexpr double on_axis = 1e-9;

/// Refuses a translation across the axis, which would carry every point of the ring away from it.
void refuse_radial(const Case& input, const std::string& key_path, double radial, const std::string& what) {
  if (radial == 0.0) return;
  refuse(input, key_path,
         fmt::format("{} has the radial component {:g}, but an axisymmetric body can translate only along the axis, y: "
                     "write [0.0, …]",
                     what, radial));
}

void refuse_spin(const Case& input, const MotionSection& motion) {
  const bool spins = std::ranges::any_of(motion.spin, [](double rate) { return rate != 0.0; });
  if (!spins) return;
  refuse(input, motion.section + ".spin",
         "an axisymmetric body cannot rotate in the plane of its section (and a spin about its axis is not part of the "
         "model): remove \"spin\"");
}

}  // namespace

void check_axisymmetry(const Case& input, int dimension) {
  if (!is_axisymmetric(input)) return;
  if (dimension != 2)
    refuse(input, "mesh.plane",
           "\"axisymmetric\" requires a mesh in the plane of a section, but this mesh has dimension 3");
  if (!input.load.gravity.empty()) refuse_radial(input, "load.gravity", input.load.gravity[0], "gravity");
  for (std::size_t i = 0; i < input.contacts.size(); ++i) {
    const std::vector<double>& position = input.contacts[i].pair_at;
    if (!position.empty()) refuse_radial(input, fmt::format("contact.{}.pair_at", i), position[0], "\"pair_at\"");
  }
  for (const MotionSection& motion : input.motions) {
    if (!motion.velocity.empty())
      refuse_radial(input, motion.section + ".velocity", motion.velocity[0], "\"velocity\"");
    refuse_spin(input, motion);
  }
  for (const ObstacleSection& obstacle : input.obstacles) {
    if (obstacle.is_free())
      refuse(input, "obstacle." + obstacle.name,
             "rigid bodies that move freely are supported in plane and three-dimensional cases, not in axisymmetric "
             "cases: mesh the body as a part with a stiff material, or prescribe its motion");
  }
}

void check_without_mesh(const Case& input) {
  if (!is_axisymmetric(input)) return;  // other cases have the dimension of their mesh
  check_axisymmetry(input, 2);
  Model obstacles;
  make_obstacles(input, obstacles, 2);
}

void check_axisymmetric_obstacle(const Case& input, const ObstacleSection& section, const Obstacle& obstacle) {
  const std::string& name = section.name;
  if (!is_axisymmetric(input) || !obstacle.moves()) return;
  const std::string key = "obstacle." + name;
  if (obstacle.rotates() || obstacle.spins())
    refuse(input, key,
           fmt::format("obstacle \"{}\" rotates, but the case is axisymmetric: obstacles can move only along the axis",
                       name));
  if (!section.velocity.empty())
    refuse_radial(input, key, section.velocity[0], fmt::format("the motion of \"{}\"", name));
  constexpr int instants = 64;
  for (int k = 1; k <= instants; ++k)
    refuse_radial(input, key, obstacle.translation(input.time.end * k / instants)[0],
                  fmt::format("the motion of \"{}\"", name));
}

void place_on_axis(const Case& input, Mesh& mesh) {
  if (!is_axisymmetric(input)) return;
  const double limit = on_axis * extent(mesh.nodes);
  Index moved = 0;
  for (Index node = 0; node < mesh.node_count(); ++node) {
    double& x = mesh.nodes(0, node);
    if (x < -limit) {
      refuse(input, "mesh.plane",
             fmt::format("node {} is at ({:.6g}, {:.6g}), on the wrong side of the axis: x is the distance from the "
                         "axis and must not be negative; move the mesh (\"move\"), or mesh one half of the section",
                         mesh.node_tags[std::size_t(node)], x, mesh.nodes(1, node)));
    }
    if (x > limit || x == 0.0) continue;
    x = 0.0;
    ++moved;
  }
  if (moved > 0)
    log::info(fmt::format("axisymmetric: {} within {:.2g} of the axis x = 0 {} moved onto it", counted(moved, "node"),
                          limit, moved == 1 ? "is" : "are"));
}

std::vector<Index> facets_off_axis(const Case& input, const std::string& key_path, const Mesh& mesh,
                                   const Group& group) {
  if (!is_axisymmetric(input)) return group.members;
  std::vector<Index> result;
  for (const Index facet : group.members) {
    const IndexInBlocks at = locate_in_blocks(mesh.facets, facet);
    const Index* const nodes = mesh.facets[at.block].cell(at.local);
    if (mesh.nodes(0, nodes[0]) != 0.0 || mesh.nodes(0, nodes[1]) != 0.0) result.push_back(facet);
  }
  const std::size_t left_out = group.members.size() - result.size();
  if (result.empty() && !mesh.is_piece)
    refuse(input, key_path,
           fmt::format("group \"{}\" lies on the axis, which is not a surface of the body", group.name));
  if (left_out > 0) {
    log::info(fmt::format("{}: {} of group \"{}\" {} on the axis, which is not a surface of the body, and {} left out",
                          input.where(key_path).text(), counted(left_out, "facet"), group.name,
                          left_out == 1 ? "lies" : "lie", left_out == 1 ? "is" : "are"));
  }
  return result;
}

void add_axis_supports(const Case& input, Model& model) {
  if (!is_axisymmetric(model.body)) return;
  const Expression at_rest;
  Index supported = 0;
  for (Index node = 0; node < model.space.node_count(); ++node) {
    if (!is_on_axis(model.body, node) || model.tied.is_tied(node)) continue;
    const Index dof = node * model.space.dimension;
    ++supported;
    if (model.problem.supports.add(dof, at_rest) || model.problem.supports.expression(dof) == at_rest) continue;
    refuse(input, "support",
           fmt::format("a support prescribes x of the node at (0, {:.6g}) as \"{}\": a node on the axis of an "
                       "axisymmetric body cannot leave the axis",
                       model.space.nodes(1, node), model.problem.supports.expression(dof).text()));
  }
  log::info(supported > 0 ? fmt::format("axisymmetric about the axis x = 0: {} held there in the radial direction",
                                        counted(supported, "node is", "nodes are"))
                          : std::string("axisymmetric about the axis x = 0, where the mesh has no node"));
}

}  // namespace ricochet
