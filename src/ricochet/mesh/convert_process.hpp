#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// @file Meshes in the formats of other programs, converted to .msh by a child process: Python's meshio and converter/,
/// which is part of the library. Private to mesh/.
namespace ricochet::gmsh {

/// Returns the versions that determine the result. Throws Error(invalid_input), which says what to install for
/// `source`.
[[nodiscard]] std::string converter_version(const std::string& source);

/// Writes `input` as .msh to `output`, in the existing directory `workspace`. Throws Error(invalid_input), which says
/// what is wrong with the file or what to install.
void convert_mesh(const std::string& input, const std::filesystem::path& workspace,
                  const std::filesystem::path& output);

/// Logs the notes that the converter left in a file it wrote, as notes and warnings about `source`.
void repeat_notes(std::string_view content, const std::string& source);

}  // namespace ricochet::gmsh
