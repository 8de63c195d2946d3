#pragma once

#include <optional>
#include <string>

#include "ricochet/mesh/mesh.hpp"

/// @file Reading meshes: Gmsh .msh (2.2 and 4.1, ASCII and binary) by ourselves; .geo and CAD through the gmsh program;
/// the formats of other programs (.inp, .vtu, .med, Exodus, …) through Python's meshio, see docs/meshes.md.
namespace ricochet {

struct MeshFile {
  std::string path;
  std::optional<double> size;  ///< target element size, for .geo and CAD files only, in the file's units
  double scale = 1.0;          ///< multiplies coordinates
  int geometry_degree = 1;     ///< order asked of the gmsh program for .geo and CAD files
  /// Two nodes at one place are nearly always a mesh whose parts should have been joined. With this they are allowed
  /// where they belong to bodies that share no node.
  bool bodies_may_touch = false;
};

/// True for files that need the gmsh program (.geo, .step, .stp, .iges, .igs, .brep).
[[nodiscard]] bool needs_gmsh_program(const std::string& path);

/// True where gmsh could run shell commands for such a file: for a .geo file, and for any that has an options file
/// (FILE.opt) beside it. These are handed to gmsh only where a user asks for the mesh.
[[nodiscard]] bool may_run_commands(const std::string& path);

/// Whether the mesh of such a file is kept from before, so that reading it does not run gmsh on it. Throws as
/// read_mesh.
[[nodiscard]] bool is_meshed(const MeshFile& file);

/// True for meshes in the formats of other programs, by the extension of the file.
[[nodiscard]] bool is_foreign_mesh(const std::string& path);

/// Reads and checks a mesh. Throws Error(file_access) when the file cannot be read, Error(invalid_input) when it is not
/// a valid mesh; messages name the file, the line (ASCII) or the byte (binary), and the entities concerned.
[[nodiscard]] Mesh read_mesh(const MeshFile& file);

}  // namespace ricochet
