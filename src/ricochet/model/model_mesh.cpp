#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "ricochet/base/error.hpp"
#include "ricochet/mesh/refine_mesh.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file The mesh of a case, from one file or from the files of its parts.
namespace ricochet {

std::vector<CaseMeshFile> mesh_files(const Case& input) {
  const auto make_file = [&](const std::string& section, const std::string& part, const BodyFile& body) {
    return CaseMeshFile{section,          part,           {body.file, body.size, body.scale, input.mesh.degree},
                        body.refinements, body.placement, body.rest_on,
                        body.rest_gap};
  };
  if (input.parts.empty()) return {make_file("mesh", "", input.mesh)};
  std::vector<CaseMeshFile> files;
  for (const PartSection& part : input.parts) files.push_back(make_file("part." + part.name, part.name, part));
  return files;
}

void require_mesh_files(const Case& input) {
  std::string missing;
  for (const CaseMeshFile& file : mesh_files(input)) {
    if (std::filesystem::exists(file.file.path)) continue;
    missing += fmt::format("{}{}: there is no file {}; a relative path is relative to the folder of the case file",
                           missing.empty() ? "" : "\n", input.where(file.section + ".file").text(), file.file.path);
  }
  if (!missing.empty()) throw Error(ErrorKind::file_access, missing);
}

namespace {

Mesh read_part(const Case& input, const CaseMeshFile& file) {
  const bool bodies_touch =
      std::ranges::any_of(input.contacts, [](const ContactSection& contact) { return contact.between_bodies(); });
  MeshFile requested = file.file;
  requested.bodies_may_touch = bodies_touch;
  const auto read = [&] {
    Mesh mesh = read_mesh(requested);
    refine(mesh, file.refinements);
    return mesh;
  };
  if (file.part.empty()) return read();
  try {
    return read();
  } catch (const Error& problem) {
    throw Error(problem.kind(), fmt::format("{}: part \"{}\": {}", input.where(file.section + ".file").text(),
                                            file.part, problem.what()));
  }
}

}  // namespace

std::vector<NamedMesh> read_mesh_files(const Case& input) {
  std::vector<NamedMesh> meshes;
  for (const CaseMeshFile& file : mesh_files(input)) {
    meshes.push_back({file.part, read_part(input, file)});
    if (const std::string why = mismatch_of_parts(meshes.front(), meshes.back()); !why.empty())
      refuse(input, file.section + ".file", why);
  }
  return meshes;
}

void check_placement(const Case& input, const CaseMeshFile& file, int dimension) {
  const Placement& placement = file.placement;
  check_length(input, file.section + ".move", placement.move.size(), dimension);
  for (std::size_t i = 0; i < placement.rotations.size(); ++i) {
    const MeshRotation& rotation = placement.rotations[i];
    std::string key = file.section + ".turn";
    if (input.locations.contains(fmt::format("{}.{}", key, i))) key += fmt::format(".{}", i);
    check_length(input, key + ".about", rotation.about.size(), dimension);
    if (dimension == 2 && !rotation.axis.empty())
      refuse(input, key + ".axis", "the mesh has dimension 2, where it rotates about a point: remove the axis");
    check_length(input, key + ".axis", rotation.axis.size(), dimension);
    if (dimension == 3 && rotation.axis.empty() && rotation.angle != 0.0)
      refuse(input, key, "the mesh has dimension 3: add an axis to \"turn\", as in axis = [0, 0, 1]");
  }
}

Mesh merge_meshes(const Case& input, const Model& model, std::vector<NamedMesh> files) {
  const std::vector<CaseMeshFile> case_files = mesh_files(input);
  for (std::size_t i = 0; i < files.size(); ++i) {
    place_mesh(files[i].mesh, case_files[i].placement);
    if (!case_files[i].rest_on.empty()) rest_on_obstacle(input, case_files[i], model, files[i].mesh);
  }
  return input.parts.empty() ? std::move(files.front().mesh) : merge_parts(files);
}

}  // namespace ricochet
