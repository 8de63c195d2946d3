#include "ricochet/case/read_bodies.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace ricochet {

namespace {

/// Turn and move.
Placement read_placement(const SectionReader& reader) {
  Placement placement;
  if (reader.is_usable("turn")) {
    const SectionReader turn = reader.table("turn");
    placement = {turn.number("angle"), turn.vector("axis"), turn.vector("about"), {}};
    const std::vector<double>& axis = placement.axis;
    if (turn.is_usable("axis") && std::all_of(axis.begin(), axis.end(), [](double a) { return a == 0.0; }))
      turn.add_problem("axis", "\"axis\" must not be zero: it is the direction that the mesh turns about");
  }
  placement.move = reader.vector("move");
  return placement;
}

void read_file(const SectionReader& reader, const std::string& case_path, BodyFile& body) {
  const std::filesystem::path file = reader.text("file");
  if (reader.is_usable("file"))
    body.file = (std::filesystem::path(case_path).parent_path() / file).lexically_normal().string();
  body.size = reader.optional_number("size");
  body.scale = reader.optional_number("scale").value_or(1.0);
  body.refinements = static_cast<int>(reader.optional_integer("refine").value_or(0));
  body.placement = read_placement(reader);
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  if (body.size && extension == ".msh") {
    reader.add_problem(
        "size",
        fmt::format("\"size\" is for geometry that is still to be meshed; \"{}\" is a mesh already", file.string()));
  }
}

bool moves(const SectionReader& reader) {
  return reader.is_given("velocity") || reader.is_given("spin");
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

void read_motions(const std::vector<SectionReader>& parts, const std::vector<SectionReader>& motions, Case& result) {
  for (const SectionReader& reader : parts) {
    if (!moves(reader)) continue;
    result.motions.push_back(
        {"part." + reader.name(), "", reader.name(), reader.vector("velocity"), reader.axial("spin"), {}});
  }
  for (std::size_t i = 0; i < motions.size(); ++i) {
    const SectionReader& reader = motions[i];
    if (!moves(reader)) {
      reader.add_problem("", "[[motion]] moves nothing: give \"velocity\", \"spin\" or both");
    } else if (reader.is_given("about") && !reader.is_given("spin")) {
      reader.add_problem("about", "\"about\" is a point of the axis of \"spin\": give \"spin\", or leave it out");
    }
    result.motions.push_back({fmt::format("motion.{}", i), reader.groups("group", result.group_lists), "",
                              reader.vector("velocity"), reader.axial("spin"), reader.vector("about")});
  }
}

}  // namespace ricochet
