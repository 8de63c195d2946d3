#include <fmt/format.h>
#include <fmt/ranges.h>

#include <limits>

#include "texts.hpp"

namespace ricochet::program {

namespace {

/// Returns the positions of the nodes of cells at t = 0, without the displacement of a static equilibrium.
Points starting_positions(const Model& model) {
  const Points& nodes = model.space.nodes;
  const Points positions =
      nodes + Eigen::Map<const Points>(model.initial.displacement.data(), nodes.rows(), nodes.cols());
  return positions.leftCols(model.space.cell_node_count());
}

}  // namespace

std::string placement_text(const BodyFile& mesh) {
  std::string text;
  if (mesh.scale != 1.0) text += fmt::format(", scaled by {:g}", mesh.scale);
  for (const MeshRotation& rotation : mesh.placement.rotations) {
    if (rotation.angle != 0.0) text += fmt::format(", rotated by {:g}°", rotation.angle);
  }
  if (!mesh.placement.move.empty()) text += fmt::format(", moved");
  if (!mesh.rest_on.empty()) {
    text += mesh.rest_gap > 0.0 ? fmt::format(", {:g} above \"{}\"", mesh.rest_gap, mesh.rest_on)
                                : fmt::format(", resting on \"{}\"", mesh.rest_on);
  }
  if (mesh.drop_height > 0.0) text += fmt::format(", dropped from a height of {:g}", mesh.drop_height);
  return text;
}

std::string gap_text(double gap, double rounding) {
  if (std::abs(gap) <= rounding) return "touches";
  return gap > 0.0 ? fmt::format("is {:.4g} away from", gap) : fmt::format("is {:.4g} inside", -gap);
}

void print_position(const Case& input, const Model& model) {
  const Points& nodes = model.mesh.nodes;
  const Vector lowest = nodes.rowwise().minCoeff(), highest = nodes.rowwise().maxCoeff();
  const double size = std::max(lowest.norm(), highest.norm());
  fmt::print("  the mesh extends from {} to {}{}\n", vector_text(lowest, size, 6), vector_text(highest, size, 6),
             placement_text(input.mesh));
  const Points positions = starting_positions(model);
  for (std::size_t k = 0; k < model.obstacles.size(); ++k) {
    double nearest = std::numeric_limits<double>::infinity();
    Index at = 0;
    for (Index node = 0; node < positions.cols(); ++node) {
      const double gap = model.obstacles[k]->gap(positions.col(node));
      if (gap >= nearest) continue;
      nearest = gap;
      at = node;
    }
    fmt::print("  at the start{} the mesh {} obstacle \"{}\", nearest at {}\n",
               model.initial.static_equilibrium ? ", before its static equilibrium," : "",
               gap_text(nearest, model.obstacles[k]->gap_rounding(positions.col(at))), input.obstacles[k].name,
               vector_text(positions.col(at), size));
    if (const FreeMotion* const body = model.obstacles[k]->free_motion(); body != nullptr) {
      const FreeMotion::Inertia& inertia = body->inertia();
      fmt::print("    the obstacle moves freely: mass {:.6g}, centre {}, {} {:.6g}\n", inertia.mass,
                 vector_text(inertia.centre, size, 6),
                 inertia.moments.size() > 1 ? "principal moments of inertia" : "moment of inertia",
                 fmt::join(inertia.moments, ", "));
    }
  }
}

}  // namespace ricochet::program
