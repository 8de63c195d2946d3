#include "ricochet/case/read_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace ricochet {

namespace {

void read_file(const SectionReader& reader, BodyFile& body) {
  reader.fill(body);
  reader.fill(body.placement);
  for (const SectionReader& rotation : reader.tables("turn")) {
    MeshRotation entry;
    rotation.fill(entry);
    if (rotation.is_usable("axis") && std::ranges::all_of(entry.axis, [](double a) { return a == 0.0; }))
      rotation.add_problem("axis", "\"axis\" must not be zero: it is the direction of the axis of rotation");
  }
  if (reader.is_given("rest_gap") && !reader.is_given("rest_on"))
    reader.add_problem("rest_gap",
                       "\"rest_gap\" is the distance from the obstacle of \"rest_on\": set \"rest_on\", too");
  const std::filesystem::path file = reader.text("file");
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
  if (body.size && extension == ".msh") {
    reader.add_problem(
        "size", fmt::format("\"size\" is only for geometry that the gmsh program meshes; \"{}\" is already a mesh",
                            file.string()));
  }
}

/// Adds to the velocity that of a free fall from rest through drop_height.
void add_drop(const SectionReader& reader, double height, const std::vector<double>& gravity,
              std::vector<double>& velocity) {
  if (!reader.is_usable("drop_height")) return;
  double size = 0.0;
  for (const double component : gravity) size = std::hypot(size, component);
  if (size == 0.0) {
    reader.add_problem("drop_height",
                       "\"drop_height\" requires gravity, and the case has none: set \"gravity\" of [load], or "
                       "\"velocity\" instead of the height");
    return;
  }
  velocity.resize(gravity.size(), 0.0);
  // v = √(2gH), for units in which squares may be out of range.
  const double speed = std::sqrt(2.0 * size) * std::sqrt(height);
  for (std::size_t k = 0; k < gravity.size(); ++k) velocity[k] += speed * (gravity[k] / size);
}

/// Adds the motion of a body that is dropped or has a velocity or a spin.
void read_motion_of_body(const SectionReader& reader, const BodyFile& body, const std::string& part, Case& result) {
  if (!reader.is_given("velocity") && !reader.is_given("spin") && !reader.is_given("drop_height")) return;
  MotionSection& motion = result.motions.emplace_back();
  motion.section = part.empty() ? "mesh" : "part." + part;
  motion.part = part;
  reader.fill(motion);
  add_drop(reader, body.drop_height, result.load.gravity, motion.velocity);
}

}  // namespace

void read_bodies(const Sections& sections, Case& result) {
  read_file(sections.one("mesh"), result.mesh);
  sections.one("mesh").fill(result.mesh);
  for (const SectionReader& reader : sections.all("part")) {
    PartSection& part = result.parts.emplace_back();
    part.name = reader.name();
    read_file(reader, part);
  }
}

void read_motions(const Sections& sections, Case& result) {
  read_motion_of_body(sections.one("mesh"), result.mesh, "", result);
  const std::vector<SectionReader> parts = sections.all("part"), motions = sections.all("motion");
  for (std::size_t i = 0; i < parts.size(); ++i)
    read_motion_of_body(parts[i], result.parts[i], parts[i].name(), result);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const SectionReader& reader = motions[i];
    MotionSection& motion = result.motions.emplace_back();
    motion.section = fmt::format("motion.{}", i);
    reader.fill(motion);
    if (!reader.is_given("velocity") && !reader.is_given("spin")) {
      reader.add_problem("", "[[motion]] moves nothing: set \"velocity\", \"spin\" or both");
    } else if (reader.is_given("about") && !reader.is_given("spin")) {
      reader.add_problem("about", "\"about\" is a point on the axis of \"spin\": set \"spin\", or remove \"about\"");
    }
  }
}

}  // namespace ricochet
