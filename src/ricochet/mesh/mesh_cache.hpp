#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "ricochet/mesh/read_mesh.hpp"

/// @file Cache of meshes made by the gmsh program or converted, by the content of their sources. Private to mesh/.
namespace ricochet::gmsh {

/// Returns the .msh file of a .geo or CAD file: made now, or earlier from the same content, parameters and program.
[[nodiscard]] std::filesystem::path meshed_file(const MeshFile& file);

/// Returns that file if it was made earlier. Throws Error(invalid_input) if the gmsh program is not installed, since
/// its version is part of the key.
[[nodiscard]] std::optional<std::filesystem::path> meshed_before(const MeshFile& file);

/// Returns the .msh file of a mesh in another program's format: converted now, or earlier from the same content.
[[nodiscard]] std::filesystem::path converted_file(const std::string& path);

/// Returns the extension in lower case, with its dot.
[[nodiscard]] std::string extension_of(const std::string& path);

/// Returns true for formats that hold geometry only (.step, .iges, .brep), false for .geo, which can define groups.
[[nodiscard]] bool is_cad_file(const std::string& path);

/// Returns the 128-bit FNV-1a hash as 32 hexadecimal digits.
[[nodiscard]] std::string fnv1a_128(std::string_view content);

/// Reads a whole file. Throws Error(file_access).
[[nodiscard]] std::string read_whole_file(const std::filesystem::path& path);

}  // namespace ricochet::gmsh
