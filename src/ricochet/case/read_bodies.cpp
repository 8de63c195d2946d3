#include "ricochet/case/read_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace ricochet {

namespace {

MeshRotation read_rotation(const SectionReader& reader) {
  const MeshRotation rotation{reader.number("angle"), reader.vector("axis"), reader.vector("about")};
  if (reader.is_usable("axis") &&
      std::all_of(rotation.axis.begin(), rotation.axis.end(), [](double a) { return a == 0.0; }))
    reader.add_problem("axis", "\"axis\" must not be zero: it is the direction of the axis of rotation");
  return rotation;
}

/// Reads rotations and translation.
Placement read_placement(const SectionReader& reader) {
  Placement placement;
  for (const SectionReader& entry : reader.tables("turn")) placement.rotations.push_back(read_rotation(entry));
  placement.move = reader.vector("move");
  return placement;
}

void read_rest(const SectionReader& reader, BodyFile& body) {
  body.rest_on = reader.text("rest_on");
  body.rest_gap = reader.number("rest_gap");
  body.drop_height = reader.number("drop_height");
  if (reader.is_given("rest_gap") && !reader.is_given("rest_on"))
    reader.add_problem("rest_gap",
                       "\"rest_gap\" is the distance from the obstacle of \"rest_on\": set \"rest_on\", too");
}

void read_file(const SectionReader& reader, const std::string& case_path, BodyFile& body) {
  const std::filesystem::path file = reader.text("file");
  if (reader.is_usable("file"))
    body.file = (std::filesystem::path(case_path).parent_path() / file).lexically_normal().string();
  body.size = reader.optional_number("size");
  body.scale = reader.optional_number("scale").value_or(1.0);
  body.refinements = static_cast<int>(reader.optional_integer("refine").value_or(0));
  body.placement = read_placement(reader);
  read_rest(reader, body);
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (body.size && extension == ".msh") {
    reader.add_problem(
        "size", fmt::format("\"size\" is only for geometry that the gmsh program meshes; \"{}\" is already a mesh",
                            file.string()));
  }
}

bool moves(const SectionReader& reader) {
  return reader.is_given("velocity") || reader.is_given("spin");
}

/// Adds to the velocity that of a free fall from rest through drop_height.
std::vector<double> with_drop(std::vector<double> velocity, const SectionReader& reader, double height,
                              const std::vector<double>& gravity) {
  if (!reader.is_given("drop_height") || !reader.is_usable("drop_height")) return velocity;
  double size = 0.0;
  for (const double component : gravity) size = std::hypot(size, component);
  if (size == 0.0) {
    reader.add_problem("drop_height",
                       "\"drop_height\" requires gravity, and the case has none: set \"gravity\" of [load], or "
                       "\"velocity\" instead of the height");
    return velocity;
  }
  velocity.resize(gravity.size(), 0.0);
  // v = √(2gH), for units in which squares may be out of range.
  const double speed = std::sqrt(2.0 * size) * std::sqrt(height);
  for (std::size_t k = 0; k < gravity.size(); ++k) velocity[k] += speed * (gravity[k] / size);
  return velocity;
}

}  // namespace

MeshSection read_mesh(const SectionReader& reader, const std::string& case_path) {
  MeshSection mesh;
  read_file(reader, case_path, mesh);
  mesh.degree = static_cast<int>(reader.integer("degree"));
  mesh.plane = reader.text("plane");
  return mesh;
}

PartSection read_part(const SectionReader& reader, const std::string& case_path) {
  PartSection part;
  part.name = reader.name();
  read_file(reader, case_path, part);
  return part;
}

void read_motions(const SectionReader& mesh, const std::vector<SectionReader>& parts,
                  const std::vector<SectionReader>& motions, Case& result) {
  const std::vector<double>& gravity = result.load.gravity;
  if (mesh.is_given("drop_height"))
    result.motions.push_back({"mesh", "", "", with_drop({}, mesh, result.mesh.drop_height, gravity), {}, {}});
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const SectionReader& reader = parts[i];
    if (!moves(reader) && !reader.is_given("drop_height")) continue;
    result.motions.push_back({"part." + reader.name(),
                              "",
                              reader.name(),
                              with_drop(reader.vector("velocity"), reader, result.parts[i].drop_height, gravity),
                              reader.axial("spin"),
                              {}});
  }
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const SectionReader& reader = motions[i];
    if (!moves(reader)) {
      reader.add_problem("", "[[motion]] moves nothing: set \"velocity\", \"spin\" or both");
    } else if (reader.is_given("about") && !reader.is_given("spin")) {
      reader.add_problem("about", "\"about\" is a point on the axis of \"spin\": set \"spin\", or remove \"about\"");
    }
    result.motions.push_back({fmt::format("motion.{}", i), reader.groups("group", result.group_lists), "",
                              reader.vector("velocity"), reader.axial("spin"), reader.vector("about")});
  }
}

}  // namespace ricochet
