#include "advice_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contact_text.hpp"
#include "number_text.hpp"
#include "place_text.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/fem/mesh_measures.hpp"
#include "ricochet/fem/stress.hpp"
#include "ricochet/fem/wave_speed.hpp"
#include "ricochet/mesh/derived_groups.hpp"
#include "ricochet/run/run_description.hpp"
#include "ricochet/simulation/rigid_bodies.hpp"

namespace ricochet::program {

namespace {

/// Of a mean normal: below this length the facets are not flat.
constexpr double flat = 1.0 - 1e-6;

std::string normal_text(const MeshMeasure& measure, int dimension) {
  if (measure.inside > 0) return ", inside the body";
  const double length = measure.mean_normal.norm();
  if (length < 1e-6) return ", closed";
  const Eigen::Vector3d direction = measure.mean_normal / length;
  return fmt::format(", {} {}", length > flat ? "flat, normal" : "curved, mean normal",
                     vector_text(direction.head(dimension)));
}

/// The largest coordinate: places are rounded to a part of it.
double reach(const Mesh& mesh) {
  return mesh.nodes.cwiseAbs().maxCoeff();
}

/// Rounded down to two digits.
double two_digits(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::floor(value / unit * (1.0 + 1e-9)) * unit;
}

void print_materials(const Body& body) {
  const Vector volumes = cell_volumes(body);
  std::vector<double> volume(body.materials.size(), 0.0);
  for (Index cell = 0; cell < volumes.size(); ++cell)
    volume[static_cast<std::size_t>(body.cell_material[static_cast<std::size_t>(cell)])] += volumes[cell];
  for (std::size_t i = 0; i < body.materials.size(); ++i) {
    const Material& material = body.materials[i];
    fmt::print("  material \"{}\": {} {:.6g}, mass {:.6g}, compression waves {:.5g}, shear waves {:.5g}\n",
               material.name, body.mesh->dimension == 2 && !is_axisymmetric(body) ? "area" : "volume", volume[i],
               volume[i] * material.density, compression_wave_speed(material, is_plane_stress(body)),
               shear_wave_speed(material));
  }
}

void print_bodies(const Model& model, const ConnectedBodies& connected) {
  const int d = model.mesh.dimension;
  const RigidBodies rigid(model.problem, connected.of_node, connected.count);
  const std::vector<std::string> names = names_of_bodies(model.mesh, connected);
  constexpr std::size_t shown = 10;
  for (std::size_t i = 0; i < std::min(rigid.bodies().size(), shown); ++i) {
    const RigidBody& body = rigid.bodies()[i];
    const bool is_section = d == 2 && !is_axisymmetric(model.body);
    const std::string inertia =
        is_section ? fmt::format("{:.5g}", body.inertia(2, 2)) : vector_text(body.inertia.diagonal()) + " (xx, yy, zz)";
    fmt::print("  {}: mass {:.6g}{}, centre {}, moment of inertia about it {}\n", names[i], body.mass,
               is_section ? " per unit of thickness" : "", vector_text(body.centre.head(d), reach(model.mesh)),
               inertia);
  }
  if (rigid.bodies().size() > shown)
    fmt::print("  {}\n", counted(rigid.bodies().size() - shown, "more body", "more bodies"));
}

void print_steps(const Case& input, const Model& model, const ConnectedBodies& connected) {
  const std::vector<double> times = cell_crossing_times(model.body);
  const std::vector<double> bodies = wave_crossing_times(model.body, connected);
  fmt::print("  a compression wave crosses the smallest cell in {:.4g}, a median one in {:.4g}, {} in {:.4g}\n",
             times.front(), times[times.size() / 2], bodies.size() > 1 ? "the largest body" : "the body",
             *std::max_element(bodies.begin(), bodies.end()));
  const double step = input.time.step;
  if (const std::optional<double> critical = make_scheme(input.time)->stability_limit(model.problem)) {
    fmt::print("  critical step {:.6g}; the step is {:.3g} of it\n", *critical, step / *critical);
    if (model.problem.internal_force->is_linear()) {
      fmt::print("  suggested step {:.2g}: nine tenths of the critical one, above which {} is unstable\n",
                 two_digits(0.9 * *critical), input.time.scheme);
    } else {
      fmt::print(
          "  suggested step {:.2g}: seven tenths of the critical one of the undeformed mesh, above which {} is "
          "unstable; it falls where cells are squeezed, and the run follows it\n",
          two_digits(0.7 * *critical), input.time.scheme);
    }
    return;
  }
  const double median = times[times.size() / 2];
  fmt::print(
      "  suggested step {:.2g}: a compression wave crosses a median cell in it, so the mesh resolves the waves of an "
      "impact; the case's step {:g} is {:.3g} of that\n",
      two_digits(median), step, step / median);
}

/// When a node at this gap meets the obstacle; infinite if it does not.
double time_of_contact(double gap, double velocity, double acceleration) {
  const double never = std::numeric_limits<double>::infinity();
  if (gap <= 0.0) return 0.0;
  if (acceleration == 0.0) return velocity < 0.0 ? -gap / velocity : never;
  const double discriminant = velocity * velocity - 2.0 * acceleration * gap;
  if (discriminant < 0.0) return never;
  // The smaller positive root of gap + velocity t + acceleration t²/2, without cancellation.
  const double root = std::sqrt(discriminant);
  if (velocity <= 0.0) return 2.0 * gap / (root - velocity);
  return acceleration < 0.0 ? -(velocity + root) / acceleration : never;
}

/// Whether nothing acts on bodies before they touch but gravity, so that it can be told when they do.
bool flies_freely(const Case& input) {
  return input.tractions.empty() && input.load.body_force.empty() && input.initial.displacement.empty() &&
         !input.initial.static_equilibrium;
}

std::string meeting_text(double time, const Case& input, const std::string& would, const std::string& does_not) {
  return std::isfinite(time) ? fmt::format(" {} at t = {:.4g} (the run ends at {:g})", would, time, input.time.end)
                             : " " + does_not;
}

/// Whether no support holds a body along the direction of contact of one of the pair's points.
bool is_free_along_normals(const Case& input, const Model& model, int pair) {
  const ContactBoundary& contact = model.problem.contact;
  std::array<bool, 3> held{};
  for (const SupportSection& support : input.supports) {
    for (const int component : support.components) held[static_cast<std::size_t>(component)] = true;
  }
  for (Index point = 0; point < contact.size(); ++point) {
    if (contact.pair[static_cast<std::size_t>(point)] != pair) continue;
    for (Index k = 0; k < contact.dimension; ++k) {
      if (held[static_cast<std::size_t>(k)] && std::abs(contact.rows->normals(k, point)) > 1e-9) return false;
    }
  }
  return true;
}

/// How two bodies face each other and, where they fly freely, when they would meet: gravity moves both alike.
void print_bodies_contact(const Case& input, const Model& model, std::size_t pair) {
  const ContactBoundary& contact = model.problem.contact;
  const FacingDescription facing = *describe_facing(model, pair);
  std::string text = facing_text(facing);
  const auto number = static_cast<int>(pair);
  if (facing.points > 0 && facing.smallest_gap > 0.0 && flies_freely(input) &&
      is_free_along_normals(input, model, number)) {
    double meets = std::numeric_limits<double>::infinity();
    for (Index point = 0; point < contact.size(); ++point) {
      if (contact.pair[static_cast<std::size_t>(point)] != number) continue;
      SpaceVector velocity = SpaceVector::Zero(contact.dimension);
      contact.visit_nodes(point, [&](Index node, double weight) {
        velocity += weight * model.initial.velocity.segment(node * contact.dimension, contact.dimension);
      });
      meets =
          std::min(meets, time_of_contact(contact.initial_gap[point], contact.rows->normal(point).dot(velocity), 0.0));
    }
    text += "; the bodies" + meeting_text(meets, input, "would meet", "do not come nearer");
  }
  const ContactSection& section = input.contacts[pair];
  fmt::print("  \"{}\" against \"{}\": {}\n", section.group, section.against, text);
}

void print_contact(const Case& input, const Model& model, std::size_t pair) {
  if (model.contact_pairs[pair].has_two_sides()) return print_bodies_contact(input, model, pair);
  if (model.contact_pairs[pair].tied) return;
  const ContactBoundary& contact = model.problem.contact;
  const int d = model.mesh.dimension;
  const ContactSection& section = input.contacts[pair];
  const Obstacle& obstacle = *model.contact_pairs[pair].obstacle;
  double nearest = std::numeric_limits<double>::infinity(), meets = nearest, rounding = 0.0;
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    if (contact.node_pair[i] != static_cast<int>(pair)) continue;
    const auto row = static_cast<Index>(i);
    const Vector normal = contact.node_normals.col(row);
    const double gap = contact.node_initial_gap[row];
    if (gap < nearest) rounding = obstacle.gap_rounding(model.space.nodes.col(contact.nodes[i]));
    nearest = std::min(nearest, gap);
    const SpaceVector position = model.space.nodes.col(contact.nodes[i]);
    const double velocity = normal.dot(model.initial.velocity.segment(contact.nodes[i] * d, d)) -
                            normal.dot(obstacle.surface_velocity(position, 0.0));
    double acceleration = 0.0;
    for (int k = 0; k < d; ++k) {
      if (!input.load.gravity.empty()) acceleration += normal[k] * input.load.gravity[static_cast<std::size_t>(k)];
    }
    meets = std::min(meets, time_of_contact(gap, velocity, acceleration));
  }
  if (!std::isfinite(nearest)) return;
  fmt::print("  \"{}\" {} \"{}\" at its nearest node", section.group, gap_text(nearest, rounding), section.obstacle);
  if (input.supports.empty() && flies_freely(input) && nearest > rounding)
    fmt::print("{}", meeting_text(meets, input, "and would reach it", "and does not come nearer"));
  fmt::print("\n");
}

}  // namespace

void print_groups(const Mesh& of_file, bool axisymmetric) {
  Mesh mesh = of_file;
  const int d = mesh.dimension;
  add_built_in_group(mesh, all_cells_name, d);
  add_built_in_group(mesh, whole_boundary_name, d - 1);
  for (const MeshPart& part : of_file.parts) {
    add_built_in_group(mesh, part.group_name(all_cells_name), d);
    add_built_in_group(mesh, part.group_name(whole_boundary_name), d - 1);
  }
  const double size = reach(mesh);
  constexpr std::array<const char*, 4> sizes{"", "length", "area", "volume"};
  for (const Group& group : mesh.groups) {
    if (group.dimension != d && group.dimension != d - 1) {
      fmt::print("  group \"{}\" of dimension {}, not used\n", group.name, group.dimension);
      continue;
    }
    const MeshMeasure measure = measure_group(mesh, group, axisymmetric);
    const bool are_cells = group.dimension == d;
    fmt::print("  group \"{}\": {} of dimension {}, {} {:.5g}, centre {}, from {} to {}{}\n", group.name,
               counted(group.members.size(), are_cells ? "cell" : "facet"), group.dimension,
               sizes[static_cast<std::size_t>(group.dimension) + (axisymmetric ? 1 : 0)], measure.size,
               vector_text(measure.centre.head(d), size), vector_text(measure.lowest.head(d), size),
               vector_text(measure.highest.head(d), size), are_cells ? "" : normal_text(measure, d));
  }
}

void print_cell_sizes(const Mesh& mesh) {
  std::vector<double> heights = cell_heights(mesh);
  std::sort(heights.begin(), heights.end());
  fmt::print("  heights of cells: smallest {:.4g}, median {:.4g}, largest {:.4g}\n", heights.front(),
             heights[heights.size() / 2], heights.back());
}

void print_facings(const Case& input, const Model& model) {
  for (std::size_t pair = 0; pair < input.contacts.size(); ++pair) {
    if (model.contact_pairs[pair].has_two_sides()) print_bodies_contact(input, model, pair);
  }
}

void print_advice(const Case& input, const Model& model) {
  const ConnectedBodies connected = find_connected_bodies(model.space);
  fmt::print("  {}, {}, {}, {}\n", counted(model.sizes.nodes, "node"), counted(model.sizes.cells, "cell"),
             counted(model.sizes.dofs, "dof"), counted(model.sizes.contact_points, "contact point"));
  print_place(input, model);
  print_materials(model.body);
  print_bodies(model, connected);
  print_groups(model.mesh, is_axisymmetric(model.body));
  print_cell_sizes(model.mesh);
  for (std::size_t pair = 0; pair < input.contacts.size(); ++pair) print_contact(input, model, pair);
  print_steps(input, model, connected);
}

}  // namespace ricochet::program
