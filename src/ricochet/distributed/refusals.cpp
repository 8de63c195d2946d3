#include "ricochet/distributed/refusals.hpp"

#include <fmt/format.h>

#include "ricochet/base/text.hpp"
#include "ricochet/model/model_parts.hpp"

namespace ricochet {

namespace {

[[noreturn]] void refuse_several(const Case& input, const std::string& key, const std::string& what) {
  refuse(input, key, what + " cannot be run by several processes yet: use `ricochet run`, on one machine");
}

}  // namespace

void refuse_undividable_case(const Case& input) {
  if (input.solver.method == "direct") {
    refuse(input, "solver.method",
           "several processes solve steps by iterations, without a factor of the whole body: set solver.method = "
           "\"iterative\" or remove it, or use `ricochet run`");
  }
  for (std::size_t i = 0; i < input.contacts.size(); ++i) {
    const ContactSection& contact = input.contacts[i];
    if (contact.between_bodies())
      refuse_several(input, fmt::format("contact.{}.{}", i, contact.is_of_all_pairs() ? "group" : "against"),
                     "contact between bodies");
  }
  for (const ObstacleSection& obstacle : input.obstacles) {
    if (obstacle.is_free())
      refuse_several(input, "obstacle." + obstacle.name, "an obstacle that moves under the forces on it");
  }
  // These fields need cells of other processes.
  for (const std::string& name : input.output.fields) {
    if (name.starts_with("nodal_") || name == "all")
      refuse_several(input, "output.fields",
                     fmt::format("the field \"{}\"{}", name, name == "all" ? ", with stresses at nodes," : ""));
  }
  if (!make_scheme(input.time)->traits().supports_ranks)
    refuse_several(input, "time.scheme", fmt::format("scheme \"{}\"", input.time.scheme));
}

void refuse_undividable_model(const Case& input, const Model& global, int processes) {
  if (has_finite_strain(global.body)) refuse_several(input, "material", "a body at finite strain");
  if (global.bodies.connected.count > 1) {
    refuse_several(input, input.parts.empty() ? "mesh.file" : "part",
                   fmt::format("{} bodies, which nothing would keep from passing through each other,",
                               global.bodies.connected.count));
  }
  if (const Index cells = global.mesh.cell_count(); cells < processes)
    refuse(input, "mesh.file",
           fmt::format("the mesh has {}, too few for {}: use fewer", counted(cells, "cell"),
                       counted(processes, "process", "processes")));
}

}  // namespace ricochet
