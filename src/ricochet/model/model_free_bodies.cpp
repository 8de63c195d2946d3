#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/linear_algebra/diagonal_matrix.hpp"
#include "ricochet/model/model_parts.hpp"
#include "ricochet/problem/ground_springs.hpp"

/// @file Rigid obstacles that move freely under the forces on them.
namespace ricochet {

namespace {

/// Calls visit(section, motion, key of the section) for each freely moving obstacle, in the order of the case.
template <class Visit>
void for_each_free_body(const Case& input, const Model& model, const Visit& visit) {
  for (std::size_t k = 0; k < model.obstacles.size(); ++k) {
    FreeMotion* const motion = model.obstacles[k]->free_motion();
    if (motion != nullptr) visit(input.obstacles[k], *motion, "obstacle." + input.obstacles[k].name);
  }
}

/// Refuses a rigid body that nothing but contact holds in a static start: its equilibrium would not be unique.
void require_ground(const Case& input, const ObstacleSection& section, const std::string& key, Index dimension) {
  const std::vector<std::string> motions{"x", "y", "z", "rotation"};
  for (std::size_t k = 0; k < motions.size(); ++k) {
    const bool is_rotation = k == 3;
    if (!is_rotation && Index(k) >= dimension) continue;
    const bool has_spring =
        is_rotation ? section.rotation_spring > 0.0 : k < section.spring.size() && section.spring[k] > 0.0;
    const bool is_supported = std::ranges::find(section.hold, motions[k]) != section.hold.end();
    if (has_spring || is_supported) continue;
    refuse(input, key,
           fmt::format("initial.displacement = \"static\" requires a restraint of \"{}\" against {}, because contact "
                       "alone holds no rigid body in a static start: add a {}, however weak, or add \"{}\" to \"hold\"",
                       section.name, is_rotation ? "rotation" : "motion along " + motions[k],
                       is_rotation ? "rotation_spring (in two dimensions)" : "spring", motions[k]));
  }
}

/// Returns mass, centre and principal moments, as given or computed from the shape.
FreeMotion::Inertia inertia_of(const Case& input, const ObstacleSection& section, const ObstacleShape& shape,
                               int dimension) {
  const std::string key = "obstacle." + section.name;
  const std::optional<ObstacleShape::Solid> solid = shape.solid();
  const auto need_solid = [&](const std::string& what) {
    if (!solid)
      refuse(input, key,
             fmt::format("obstacle \"{}\" encloses nothing that has {}: set its mass, inertia and centre_of_mass (for "
                         "a ball, a ring or a closed surface, seen from outside, they follow from its density)",
                         section.name, what));
  };
  FreeMotion::Inertia result;
  if (section.density) need_solid("a mass");
  result.mass = section.density ? *section.density * solid->volume : *section.mass;
  if (section.centre_of_mass.empty()) need_solid("a centre of mass");
  result.centre = section.centre_of_mass.empty() ? solid->centre : SpaceVector(vector_of(section.centre_of_mass));
  if (!section.inertia.empty()) {
    result.moments = vector_of(section.inertia);
  } else {
    need_solid("a moment of inertia");
    const double density = result.mass / solid->volume;
    Matrix tensor = density * solid->inertia;
    // Parallel-axis theorem (Steiner) if the centre of mass is given.
    const SpaceVector away = result.centre - solid->centre;
    if (dimension == 2) {
      result.moments = SpaceVector::Constant(1, tensor(0, 0) + result.mass * away.squaredNorm());
    } else {
      tensor += result.mass * (away.squaredNorm() * Matrix::Identity(3, 3) - Matrix(away * away.transpose()));
      const SymmetricEigen axes = symmetric_eigen(tensor);
      Eigen::Matrix3d principal = axes.vectors;
      if (principal.col(0).cross(principal.col(1)).dot(principal.col(2)) < 0.0) principal.col(0) = -principal.col(0);
      result.moments = axes.values;
      result.principal = principal;
    }
  }
  if (!(result.moments.minCoeff() > 0.0)) refuse(input, key + ".inertia", "moments of inertia must be positive");
  if (dimension == 3 && 2.0 * result.moments.maxCoeff() > result.moments.sum() * (1.0 + 1e-9)) {
    refuse(input, key + ".inertia",
           "a moment of inertia must not be larger than the sum of the other two: no body has such moments");
  }
  return result;
}

}  // namespace

void add_free_bodies(const Case& input, Model& model) {
  const int d = model.mesh.dimension;
  for (std::size_t k = 0; k < model.obstacles.size(); ++k) {
    const ObstacleSection& section = input.obstacles[k];
    if (!section.is_free()) continue;
    if (d == 3 && section.rotation_spring > 0.0)
      refuse(input, "obstacle." + section.name + ".rotation_spring",
             "a spring against rotation is supported in two dimensions only: in three, hold the rotation or damp it");
    const FreeMotion::Inertia inertia = inertia_of(input, section, model.obstacles[k]->shape(), d);
    Points& nodes = model.space.nodes;
    const Index first = nodes.cols();
    nodes.conservativeResize(d, first + 2);
    model.space.nodes_without_cells += 2;
    for (Index node = first; node < first + 2; ++node) {
      nodes.col(node) = inertia.centre;
      model.space.number.push_back(node);
    }
    const auto motion = std::make_shared<FreeMotion>(inertia, first);
    model.obstacles[k]->set_free(motion);
    model.problem.free_bodies.push_back(motion);
  }
}

void support_free_bodies(const Case& input, Model& model) {
  const Index d = model.mesh.dimension;
  const Expression still(0.0);
  for_each_free_body(input, model, [&](const ObstacleSection& section, const FreeMotion& body, const std::string& key) {
    const std::vector<std::string> axes{"x", "y", "z"};
    for (const std::string& direction : section.hold) {
      const auto axis = Index(std::ranges::find(axes, direction) - axes.begin());
      if (axis < 3 && axis >= d) refuse(input, key + ".hold", "there is no direction \"z\" in two dimensions");
      if (axis < 3) model.problem.supports.add(body.centre_node() * d + axis, still);
      for (Index k = 0; axis == 3 && k < d; ++k) model.problem.supports.add(body.rotation_node() * d + k, still);
    }
    if (d == 2) model.problem.supports.add(body.rotation_node() * d + 1, still);  // plane rotations have one component
    if (input.initial.static_equilibrium) require_ground(input, section, key, d);
  });
}

SparseMatrix resized(SparseMatrix matrix, Index dofs) {
  matrix.conservativeResize(dofs, dofs);
  return matrix;
}

SparseMatrix with_free_bodies(const Model& model, SparseMatrix mass) {
  if (model.problem.free_bodies.empty()) return mass;
  const Index d = model.mesh.dimension, dofs = model.space.dof_count();
  Vector of_bodies = Vector::Zero(dofs);
  for (const auto& body : model.problem.free_bodies)
    of_bodies.segment(body->centre_node() * d, 2 * d).setConstant(body->inertia().mass);
  return resized(std::move(mass), dofs) + diagonal_matrix(of_bodies);
}

void add_ground(const Case& input, Model& model) {
  const Index d = model.mesh.dimension, dofs = model.space.dof_count();
  Vector stiffness = Vector::Zero(dofs), damping = Vector::Zero(dofs);
  for_each_free_body(input, model, [&](const ObstacleSection& section, const FreeMotion& body, const std::string& key) {
    for (const auto& [name, values, target] :
         {std::tuple{"spring", &section.spring, &stiffness}, std::tuple{"damper", &section.damper, &damping}}) {
      for (std::size_t k = 0; k < values->size(); ++k) {
        if ((*values)[k] < 0.0)
          refuse(input, key + "." + name, fmt::format("\"{}\" must not be negative: it would create energy", name));
        (*target)[body.centre_node() * d + Index(k)] = (*values)[k];
      }
    }
    for (Index k = 0; k < body.gyration().size(); ++k) {
      const double square = body.gyration()[k] * body.gyration()[k];
      stiffness[body.rotation_node() * d + k] = section.rotation_spring / square;
      damping[body.rotation_node() * d + k] = section.rotation_damper / square;
    }
  });
  if (!stiffness.isZero(0.0))
    model.problem.internal_force = std::make_shared<GroundSprings>(model.problem.internal_force, stiffness);
  if (!damping.isZero(0.0)) model.problem.damping.set_ground_part(damping);
}

void add_forces_on_free_bodies(const Case& input, Model& model) {
  const Index d = model.mesh.dimension;
  Loads& loads = model.problem.loads;
  const auto add = [&](Index dof, const Expression& value) {
    Vector pattern = Vector::Zero(model.space.dof_count());
    pattern[dof] = 1.0;
    if (!value.is_constant()) return loads.add_separable(std::move(pattern), value);
    if (value(0.0, 0.0, 0.0, 0.0) != 0.0) loads.add_constant(value(0.0, 0.0, 0.0, 0.0) * pattern);
  };
  for_each_free_body(input, model, [&](const ObstacleSection& section, const FreeMotion& body, const std::string&) {
    for (std::size_t k = 0; k < section.force.size(); ++k) add(body.centre_node() * d + Index(k), section.force[k]);
    if (section.torque.empty()) return;
    // The torque does work on the spatial rotation θ of a step, about the principal axes at the start of the step.
    loads.add_general([&body, torque = section.torque](double time, Vector& load) {
      SpaceVector value(static_cast<Index>(torque.size()));
      for (Index k = 0; k < value.size(); ++k) value[k] = torque[std::size_t(k)](0.0, 0.0, 0.0, time);
      body.add_torque(value, load);
    });
  });
}

void start_free_bodies(const Case& input, Model& model) {
  const Index d = model.mesh.dimension;
  const Vector undeformed = Vector::Zero(model.space.dof_count());
  for_each_free_body(input, model, [&](const ObstacleSection& section, const FreeMotion& body, const std::string&) {
    auto centre = model.initial.velocity.segment(body.centre_node() * d, d);
    centre.setZero();
    if (!section.velocity.empty()) centre = vector_of(section.velocity);
    model.initial.displacement.segment(body.centre_node() * d, 2 * d).setZero();
    auto spin_velocity = model.initial.velocity.segment(body.rotation_node() * d, d);
    spin_velocity.setZero();
    if (!section.spin.empty()) spin_velocity = body.rotational_velocity(vector_of(section.spin), undeformed);
  });
}

std::vector<std::string> names_of_all_bodies(const Case& input, const Model& model) {
  std::vector<std::string> names = model.bodies.names;
  for (std::size_t i = 0; i < input.obstacles.size(); ++i) {
    if (model.obstacles[i]->free_motion() != nullptr) names.push_back(input.obstacles[i].name);
  }
  return names;
}

}  // namespace ricochet
