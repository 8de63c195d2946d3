#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/log.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file Rigid obstacles and their motions.
namespace ricochet {

namespace {

std::unique_ptr<const ObstaclePath> make_path(const Case& input, const ObstacleSection& section, int dimension) {
  const std::string key = "obstacle." + section.name;
  if (!section.table.empty()) {
    try {
      return read_path(section.table, dimension);
    } catch (const Error& problem) {
      throw Error(problem.kind(), fmt::format("{}: {}", input.where(key + ".table").text(), problem.what()));
    }
  }
  if (section.is_free()) return nullptr;  // its velocity is an initial condition
  std::vector<Expression> motion = section.motion;
  if (section.rotation.empty() && motion.empty()) return make_uniform_path(as_vector(section.velocity));
  for (std::size_t k = 0; k < section.velocity.size(); ++k)
    motion.emplace_back("rate*t", std::map<std::string, double>{{"rate", section.velocity[k]}});
  return make_path(std::move(motion), section.rotation, dimension);
}

}  // namespace

std::unique_ptr<Obstacle> make_obstacle(const Case& input, const ObstacleSection& section, int dimension) {
  const std::string key = "obstacle." + section.name;
  try {
    std::unique_ptr<ObstacleShape> shape = make_obstacle_shape(section.type, section.parameters);
    if (shape->centre().size() > 0 && shape->centre().size() != dimension) {
      refuse(input, key,
             fmt::format("obstacle \"{}\" has dimension {}, but the mesh has dimension {}", section.name,
                         shape->centre().size(), dimension));
    }
    if (section.rotation_rate != 0.0 && !shape->symmetry_axis().exists) {
      refuse(
          input, key + ".rotation_rate",
          fmt::format("obstacle \"{}\" has no axis about which it could rotate without changing its surface (in three "
                      "dimensions the normal of a plane is one): use \"rotation\" instead of \"rotation_rate\"",
                      section.name));
    }
    Vector about = as_vector(section.about);
    if (about.size() == 0)
      about = shape->centre().size() > 0 ? Vector(shape->centre()) : Vector(Vector::Zero(dimension));
    std::unique_ptr<const ObstaclePath> path = make_path(input, section, dimension);
    if (!section.is_steered)
      return std::make_unique<Obstacle>(std::move(shape), std::move(path), section.rotation_rate, about,
                                        input.time.step);
    auto steered = std::make_unique<Obstacle>(std::move(shape), nullptr, section.rotation_rate, about, input.time.step);
    steered->set_steered(std::make_unique<SteeredPath>(std::move(path), dimension));
    return steered;
  } catch (const Error& problem) {
    if (problem.kind() != ErrorKind::invalid_input) throw;
    const std::string location = input.where(key).text();
    if (std::string(problem.what()).starts_with(location.substr(0, location.find(':')))) throw;
    refuse(input, key, problem.what());
  }
}

void fit_obstacles(const Case& input, Model& model) {
  const bool has_scales = !model.contact_scales.empty();  // scales of the whole body if this rank holds a part of it
  for (std::size_t k = 0; k < model.obstacles.size(); ++k) {
    ContactScale scale{extent(model.mesh.nodes), 0.0};
    for (const ContactPair& pair : model.contact_pairs) {
      if (pair.obstacle == model.obstacles[k].get())
        scale.spacing = std::max(scale.spacing, node_spacing(model.space, pair.facets));
    }
    if (!has_scales) model.contact_scales.push_back(scale);
    model.obstacles[k]->fit(model.contact_scales[k]);
    const std::string remarks = model.obstacles[k]->shape().remarks();
    if (!remarks.empty()) log::info(fmt::format("obstacle \"{}\": {}", input.obstacles[k].name, remarks));
  }
}

}  // namespace ricochet
