#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "ricochet/mesh/read_mesh.hpp"

/// @file Meshes made by the gmsh program or converted, kept by the content they were made from. Private to mesh/.
namespace ricochet::gmsh {

/// The .msh file of a .geo or CAD file: made now, or before from the same content with the same parameters and program.
[[nodiscard]] std::filesystem::path meshed_file(const MeshFile& file);

/// The same where it was made before; none: it was not. Throws Error(invalid_input) where the gmsh program is not
/// installed: meshes are kept by its version.
[[nodiscard]] std::optional<std::filesystem::path> meshed_before(const MeshFile& file);

/// The .msh file of a mesh in another program's format: converted now, or before from the same content.
[[nodiscard]] std::filesystem::path converted_file(const std::string& path);

/// In lower case, with its dot.
[[nodiscard]] std::string extension_of(const std::string& path);

/// True for formats that only hold geometry (.step, .iges, .brep), false for .geo, which can define groups.
[[nodiscard]] bool is_cad_file(const std::string& path);

/// The FNV-1a hash of 128 bits, as 32 hexadecimal digits.
[[nodiscard]] std::string fnv1a_128(std::string_view content);

/// All of a file. Throws Error(file_access).
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& path);

}  // namespace ricochet::gmsh
