#include "ricochet/case/read_obstacle.hpp"

#include <fmt/format.h>

#include <filesystem>

namespace ricochet {

namespace {

std::string beside(const std::string& case_path, const std::string& file) {
  return (std::filesystem::path(case_path).parent_path() / file).lexically_normal().string();
}

/// Refuses two keys with the same meaning.
void refuse_both(const SectionReader& reader, const char* key, const char* other) {
  if (reader.is_given(key) && reader.is_given(other))
    reader.add_problem(key, fmt::format("the obstacle already has \"{}\": remove \"{}\"", other, key));
}

void read_motion(const SectionReader& reader, const std::string& case_path, ObstacleSection& obstacle) {
  obstacle.velocity = reader.vector("velocity");
  obstacle.rotation_rate = reader.number("rotation_rate");
  obstacle.motion = reader.formulas("motion");
  obstacle.rotation = reader.axial_formulas("rotation");
  obstacle.about = reader.vector("about");
  if (reader.is_given("table") && reader.is_usable("table")) obstacle.table = beside(case_path, reader.text("table"));
  refuse_both(reader, "motion", "velocity");
  for (const char* const key : {"velocity", "motion", "rotation"}) refuse_both(reader, "table", key);
  if (reader.is_given("about") && !reader.is_given("rotation") && !reader.is_given("table"))
    reader.add_problem("about", "\"about\" is the centre of a rotation: set \"rotation\", or remove \"about\"");
}

void read_free_body(const SectionReader& reader, ObstacleSection& obstacle) {
  obstacle.mass = reader.optional_number("mass");
  obstacle.density = reader.optional_number("density");
  obstacle.inertia = reader.axial("inertia");
  obstacle.centre_of_mass = reader.vector("centre_of_mass");
  obstacle.spin = reader.axial("spin");
  obstacle.force = reader.formulas("force");
  obstacle.torque = reader.axial_formulas("torque");
  obstacle.spring = reader.vector("spring");
  obstacle.damper = reader.vector("damper");
  obstacle.rotation_spring = reader.number("rotation_spring");
  obstacle.rotation_damper = reader.number("rotation_damper");
  obstacle.hold = reader.chosen("hold");
  refuse_both(reader, "density", "mass");
  const bool is_free = reader.is_given("mass") || reader.is_given("density");
  const auto only = [&](bool allowed, const char* key, const char* reason) {
    if (!allowed && reader.is_given(key)) reader.add_problem(key, fmt::format("\"{}\" {}", key, reason));
  };
  for (const char* const key : {"inertia", "centre_of_mass", "spin", "force", "torque", "spring", "damper",
                                "rotation_spring", "rotation_damper", "hold"})
    only(is_free, key, "requires a rigid body that moves under the forces on it: set its \"mass\" or \"density\", too");
  for (const char* const key : {"motion", "rotation", "table"})
    only(!is_free, key, "prescribes a motion; an obstacle with a mass or density moves under the forces on it");
  only(!is_free, "rotation_rate",
       "prescribes a motion; an obstacle with a mass or density moves under the forces on it; for a driven roller that "
       "a force presses, set \"spin\", a large \"inertia\" (a flywheel) and \"force\"");
}

}  // namespace

ObstacleSection read_obstacle(const SectionReader& reader, const std::string& case_path) {
  ObstacleSection obstacle;
  obstacle.name = reader.name();
  obstacle.type = reader.text("type");
  obstacle.parameters = reader.type_parameters(*find_section("obstacle"));
  if (obstacle.parameters.has("file"))
    obstacle.parameters.set("file", beside(case_path, obstacle.parameters.text("file")));
  read_motion(reader, case_path, obstacle);
  read_free_body(reader, obstacle);
  return obstacle;
}

}  // namespace ricochet
