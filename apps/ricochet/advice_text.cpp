#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "ricochet/base/rounded.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/fem/connected_bodies.hpp"
#include "ricochet/fem/mesh_measures.hpp"
#include "ricochet/fem/stress.hpp"
#include "ricochet/fem/wave_speed.hpp"
#include "ricochet/mesh/derived_groups.hpp"
#include "ricochet/run/run_description.hpp"
#include "ricochet/simulation/impact/rigid_bodies.hpp"
#include "texts.hpp"

namespace ricochet::program {

namespace {

/// Length of a mean normal below which the facets are not flat.
constexpr double flat = 1.0 - 1e-6;

std::string normal_text(const MeshMeasure& measure, int dimension) {
  if (measure.inside > 0) return ", inside the body";
  const double length = measure.mean_normal.norm();
  if (length < 1e-6) return ", closed";
  const Eigen::Vector3d direction = measure.mean_normal / length;
  return fmt::format(", {} {}", length > flat ? "flat, normal" : "curved, mean normal",
                     vector_text(direction.head(dimension)));
}

/// Returns the largest coordinate, relative to which positions are rounded.
double reach(const Mesh& mesh) { return mesh.nodes.cwiseAbs().maxCoeff(); }

void print_materials(const Body& body) {
  const Vector volumes = cell_volumes(body);
  std::vector<double> volume(body.materials.size(), 0.0);
  for (Index cell = 0; cell < volumes.size(); ++cell)
    volume[std::size_t(body.cell_material[std::size_t(cell)])] += volumes[cell];
  for (std::size_t i = 0; i < body.materials.size(); ++i) {
    const Material& material = body.materials[i];
    fmt::print("  material \"{}\": {} {:.6g}, mass {:.6g}, speed of compression waves {:.5g}, of shear waves {:.5g}\n",
               material.name, body.mesh->dimension == 2 && !is_axisymmetric(body) ? "area" : "volume", volume[i],
               volume[i] * material.density, compression_wave_speed(material, is_plane_stress(body)),
               shear_wave_speed(material));
  }
}

void print_bodies(const Case& input, const Model& model, const ConnectedBodies& connected) {
  const int d = model.mesh.dimension;
  const RigidBodies rigid(model.problem, connected.of_node, connected.count);
  const std::vector<std::string> names = names_of_all_bodies(input, model);
  constexpr std::size_t shown = 10;
  for (std::size_t i = 0; i < std::min(rigid.bodies().size(), shown); ++i) {
    const RigidBody& body = rigid.bodies()[i];
    const bool is_section = d == 2 && !is_axisymmetric(model.body);
    const std::string inertia =
        is_section ? fmt::format("{:.5g}", body.inertia(2, 2)) : vector_text(body.inertia.diagonal()) + " (xx, yy, zz)";
    const std::string name = i < model.bodies.names.size() ? names[i] : fmt::format("rigid body \"{}\"", names[i]);
    fmt::print("  {}: mass {:.6g}{}, centre {}, moment of inertia about it {}\n", name, body.mass,
               is_section ? " per unit of thickness" : "", vector_text(body.centre.head(d), reach(model.mesh)),
               inertia);
  }
  if (rigid.bodies().size() > shown)
    fmt::print("  {}\n", counted(rigid.bodies().size() - shown, "more body", "more bodies"));
}

/// Prints the crossing times of each material if they differ much: the median cell may then be one of the stiff body.
void print_medians_of_materials(const Body& body) {
  constexpr double much = 3.0;
  const std::vector<double> medians = median_crossing_times(body);
  const auto [least, most] = std::ranges::minmax_element(medians);
  if (!(*least > 0.0 && *most > much * *least)) return;
  std::vector<std::string> texts;
  for (std::size_t i = 0; i < medians.size(); ++i)
    texts.push_back(fmt::format("{:.2g} in \"{}\"", rounded_down(medians[i], 2), body.materials[i].name));
  fmt::print(
      "  a median cell of each material: {}; between a stiff and a soft body, the time of the soft one suffices\n",
      fmt::join(texts, ", "));
}

void print_steps(const Case& input, const Model& model, const ConnectedBodies& connected) {
  const std::vector<double> times = cell_crossing_times(model.body);
  const std::vector<double> bodies = wave_crossing_times(model.body, connected);
  fmt::print("  a compression wave crosses the smallest cell in {:.4g}, a median one in {:.4g}, {} in {:.4g}\n",
             times.front(), times[times.size() / 2], bodies.size() > 1 ? "the largest body" : "the body",
             *std::ranges::max_element(bodies));
  const double step = input.time.step;
  if (const std::optional<double> critical = make_scheme(input.time)->stability_limit(model.problem)) {
    fmt::print("  critical step {:.6g}; the step is {:.3g} of it\n", *critical, step / *critical);
    if (model.problem.internal_force->is_linear()) {
      fmt::print("  suggested step {:.2g}: nine tenths of the critical step, above which {} is unstable\n",
                 rounded_down(0.9 * *critical, 2), input.time.scheme);
    } else {
      fmt::print(
          "  suggested step {:.2g}: seven tenths of the critical step of the undeformed mesh, above which {} is "
          "unstable; the critical step decreases where cells are compressed, and the run tracks it\n",
          rounded_down(0.7 * *critical, 2), input.time.scheme);
    }
    return;
  }
  const double median = times[times.size() / 2];
  fmt::print(
      "  suggested step {:.2g}: the time in which a compression wave crosses a median cell, so that the mesh resolves "
      "the waves of an impact; the step of the case, {:g}, is {:.3g} of that\n",
      rounded_down(median, 2), step, step / median);
  print_medians_of_materials(model.body);
}

/// Returns the time at which a node with this gap meets the obstacle; infinite if it does not.
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

/// Returns true if only gravity acts on bodies before they touch, so that the time of contact can be predicted.
bool flies_freely(const Case& input) {
  return input.tractions.empty() && input.load.body_force.empty() && input.initial.displacement.empty() &&
         !input.initial.static_equilibrium;
}

std::string meeting_text(double time, const Case& input, const std::string& would, const std::string& does_not) {
  return std::isfinite(time) ? fmt::format(" {} at t = {:.4g} (the run ends at {:g})", would, time, input.time.end)
                             : " " + does_not;
}

/// Returns true if no support holds a body along the direction of contact of one of the pair's points.
bool is_free_along_normals(const Case& input, const Model& model, int pair) {
  const ContactBoundary& contact = model.problem.contact;
  std::array<bool, 3> is_supported{};
  for (const SupportSection& support : input.supports) {
    for (const int component : support.components) is_supported[std::size_t(component)] = true;
  }
  for (Index point = 0; point < contact.size(); ++point) {
    if (contact.pair[std::size_t(point)] != pair) continue;
    for (Index k = 0; k < contact.dimension; ++k) {
      if (is_supported[std::size_t(k)] && std::abs(contact.rows->normals(k, point)) > 1e-9) return false;
    }
  }
  return true;
}

/// Returns the time at which facing points of a pair would meet in free flight, in which gravity moves both bodies
/// equally. None if no point faces the other side, or if a surface faces itself, as it must then deform.
std::optional<double> time_of_meeting(const Model& model, std::size_t pair) {
  if (model.contact_pairs[pair].is_self()) return {};
  const ContactBoundary& contact = model.problem.contact;
  std::optional<double> meets;
  for (Index point = 0; point < contact.size(); ++point) {
    if (contact.pair[std::size_t(point)] != int(pair)) continue;
    const double gap = contact.initial_gap[point];
    if (contact.slides(point) && gap >= contact.unpaired_gap) continue;
    SpaceVector velocity = SpaceVector::Zero(contact.dimension);
    contact.visit_nodes(point, [&](Index node, double weight) {
      velocity += weight * model.initial.velocity.segment(node * contact.dimension, contact.dimension);
    });
    const double time = time_of_contact(gap, contact.rows->normal(point).dot(velocity), 0.0);
    meets = std::min(meets.value_or(time), time);
  }
  return meets;
}

/// Prints how two bodies face each other and, if they fly freely, when they would meet.
void print_bodies_contact(const Case& input, const Model& model, std::size_t pair) {
  const PairingDescription facing = *describe_facing(model, pair);
  std::string text = facing_text(facing);
  if (facing.points > 0 && facing.smallest_gap > 0.0 && flies_freely(input) &&
      is_free_along_normals(input, model, int(pair))) {
    if (const std::optional<double> meets = time_of_meeting(model, pair))
      text += "; the bodies" + meeting_text(*meets, input, "would meet", "do not approach each other in free flight");
  }
  const ContactSection& section = model.contacts[pair];
  fmt::print("  \"{}\" against \"{}\": {}\n", section.group, section.against, text);
}

/// A node in free flight.
struct Flight {
  SpaceVector position, velocity, acceleration;
  [[nodiscard]] SpaceVector at(double time) const {
    return position + time * velocity + (0.5 * time * time) * acceleration;
  }
};

/// Returns the time at which the first of some nodes meets an obstacle with any motion: gaps are evaluated at as many
/// instants of the run as are cheap, followed by bisection. Infinite if none does.
double time_of_contact(const std::vector<Flight>& flights, const Obstacle& obstacle, double end) {
  constexpr double evaluations = 1e6;
  constexpr int least_instants = 100, most_instants = 10000, halvings = 50;
  const int instants = std::clamp(int(evaluations / double(flights.size())), least_instants, most_instants);
  const auto touches = [&](double time) {
    const PosedObstacle placed = obstacle.at(time);
    return std::ranges::any_of(flights, [&](const Flight& flight) { return placed.gap(flight.at(time)) <= 0.0; });
  };
  for (int k = 1; k <= instants; ++k) {
    double before = end * (k - 1) / instants, after = end * k / instants;
    if (!touches(after)) continue;
    for (int halving = 0; halving < halvings; ++halving) {
      const double middle = 0.5 * (before + after);
      (touches(middle) ? after : before) = middle;
    }
    return after;
  }
  return std::numeric_limits<double>::infinity();
}

/// Returns the time of contact with an obstacle at rest, whose gap changes along its normal as the node moves.
double time_of_contact(const Flight& flight, double gap, const SpaceVector& normal) {
  return time_of_contact(gap, normal.dot(flight.velocity), normal.dot(flight.acceleration));
}

/// Returns the words of print_contact about a pair's nodes that fly towards an obstacle.
std::string obstacle_meeting_text(const Case& input, const Model& model, std::size_t pair) {
  const ContactBoundary& contact = model.problem.contact;
  const int d = model.mesh.dimension;
  const Obstacle& obstacle = *model.contact_pairs[pair].obstacle;
  if (obstacle.free_motion() != nullptr || obstacle.steered_path() != nullptr) return "";
  SpaceVector gravity = SpaceVector::Zero(d);
  for (std::size_t k = 0; k < input.load.gravity.size(); ++k) gravity[Index(k)] = input.load.gravity[k];
  std::vector<Flight> flights;
  double meets = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    if (contact.node_pair[i] != int(pair)) continue;
    const auto row = Index(i);
    flights.push_back(
        {model.space.nodes.col(contact.nodes[i]), model.initial.velocity.segment(contact.nodes[i] * d, d), gravity});
    meets =
        std::min(meets, time_of_contact(flights.back(), contact.node_initial_gap[row], contact.node_normals.col(row)));
  }
  if (!obstacle.moves())
    return meeting_text(meets, input, "and would reach it", "and does not approach it in free flight");
  meets = time_of_contact(flights, obstacle, input.time.end);
  return meeting_text(meets, input, "and would reach it", "and does not reach it by the end of the run");
}

/// Prints, for contact of every body with every other, the number of pairs and the nearest two bodies.
void print_pairs(const Model& model, std::size_t entry) {
  const std::string* all = nullptr;
  std::size_t count = 0, nearest = 0;
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t pair = 0; pair < model.contacts.size(); ++pair) {
    if (model.contacts[pair].entry != entry || model.contacts[pair].all_pairs_group.empty()) continue;
    all = &model.contacts[pair].all_pairs_group;
    ++count;
    const double least = model.pair_facings[pair].smallest_gap;
    if (!(least < gap)) continue;
    gap = least;
    nearest = pair;
  }
  if (all == nullptr) return;
  fmt::print("  every body of \"{}\" against every other: {}", *all, counted(count, "pair"));
  if (std::isfinite(gap)) {
    fmt::print("; the nearest are \"{}\" and \"{}\", {:.4g} apart where they face each other",
               model.contacts[nearest].group, model.contacts[nearest].against, gap);
  }
  fmt::print("\n");
}

void print_contact(const Case& input, const Model& model, std::size_t pair) {
  if (model.contact_pairs[pair].is_one_of_many || model.contact_pairs[pair].at_corners) return;
  if (model.contact_pairs[pair].has_two_sides()) return print_bodies_contact(input, model, pair);
  if (model.contact_pairs[pair].tied) return;
  const ContactBoundary& contact = model.problem.contact;
  const ContactSection& section = model.contacts[pair];
  const Obstacle& obstacle = *model.contact_pairs[pair].obstacle;
  double nearest = std::numeric_limits<double>::infinity(), rounding = 0.0;
  for (std::size_t i = 0; i < contact.nodes.size(); ++i) {
    if (contact.node_pair[i] != int(pair)) continue;
    const double gap = contact.node_initial_gap[Index(i)];
    if (gap < nearest) rounding = obstacle.gap_rounding(model.space.nodes.col(contact.nodes[i]));
    nearest = std::min(nearest, gap);
  }
  if (!std::isfinite(nearest)) return;
  fmt::print("  \"{}\" {} \"{}\" at its nearest node", section.group, gap_text(nearest, rounding), section.obstacle);
  if (input.supports.empty() && flies_freely(input) && nearest > rounding)
    fmt::print("{}", obstacle_meeting_text(input, model, pair));
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
               sizes[std::size_t(group.dimension) + (axisymmetric ? 1 : 0)], measure.size,
               vector_text(measure.centre.head(d), size), vector_text(measure.lowest.head(d), size),
               vector_text(measure.highest.head(d), size), are_cells ? "" : normal_text(measure, d));
  }
}

void print_cell_sizes(const Mesh& mesh) {
  std::vector<double> heights = cell_heights(mesh);
  std::ranges::sort(heights);
  fmt::print("  heights of cells: smallest {:.4g}, median {:.4g}, largest {:.4g}\n", heights.front(),
             heights[heights.size() / 2], heights.back());
}

void print_facings(const Case& input, const Model& model) {
  for (std::size_t pair = 0; pair < model.contacts.size(); ++pair) {
    const ContactPair& of = model.contact_pairs[pair];
    if (of.has_two_sides() && !of.is_one_of_many && !of.at_corners) print_bodies_contact(input, model, pair);
  }
}

void print_advice(const Case& input, const Model& model) {
  const ConnectedBodies connected = find_connected_bodies(model.space);
  fmt::print("  {}, {}, {}, {}\n", counted(model.sizes.nodes, "node"), counted(model.sizes.cells, "cell"),
             counted(model.sizes.dofs, "dof"), counted(model.sizes.contact_points, "contact point"));
  print_position(input, model);
  print_materials(model.body);
  print_bodies(input, model, connected);
  print_groups(model.mesh, is_axisymmetric(model.body));
  print_cell_sizes(model.mesh);
  for (std::size_t pair = 0; pair < model.contacts.size(); ++pair) print_contact(input, model, pair);
  for (std::size_t entry = 0; entry < input.contacts.size(); ++entry) print_pairs(model, entry);
  print_steps(input, model, connected);
}

}  // namespace ricochet::program
