#pragma once

#include <optional>
#include <string>

#include "ricochet/mesh/mesh.hpp"

/// @file Reading meshes: Gmsh .msh (2.2 and 4.1, ASCII and binary) with our own reader; .geo and CAD through the gmsh
/// program; the formats of other programs (.inp, .vtu, .med, Exodus, …) through Python's meshio, see docs/meshes.md.
namespace ricochet {

struct MeshFile {
  std::string path;
  std::optional<double> size;  ///< target element size, for .geo and CAD files only, in the file's units
  double scale = 1.0;          ///< multiplies coordinates
  int geometry_degree = 1;     ///< order requested from the gmsh program for .geo and CAD files
  /// Permits coincident nodes of bodies that share no node. Otherwise they are refused: nearly always the parts of the
  /// mesh should have been joined.
  bool bodies_may_touch = false;
};

/// Returns true for files that need the gmsh program (.geo, .step, .stp, .iges, .igs, .brep).
[[nodiscard]] bool needs_gmsh_program(const std::string& path);

/// Returns whether gmsh could run shell commands for such a file: for a .geo file, and for any file with an options
/// file (FILE.opt) beside it. These are passed to gmsh only if a user asks for the mesh.
[[nodiscard]] bool may_run_commands(const std::string& path);

/// Returns whether the mesh of such a file is in the cache, so that reading it does not run gmsh. Throws as read_mesh
/// does.
[[nodiscard]] bool is_mesh_cached(const MeshFile& file);

/// Returns true for meshes in the formats of other programs, by the extension of the file.
[[nodiscard]] bool is_foreign_mesh(const std::string& path);

/// Reads and checks a mesh. Throws Error(file_access) if the file cannot be read, Error(invalid_input) if it is not a
/// valid mesh; messages name the file, the line (ASCII) or the byte (binary), and the entities concerned.
[[nodiscard]] Mesh read_mesh(const MeshFile& file);

}  // namespace ricochet
