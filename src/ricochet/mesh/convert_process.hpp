#pragma once

#include <filesystem>
#include <string>
#include <string_view>

/// @file Meshes in the formats of other programs, made .msh by a child process: Python's meshio and converter/,
/// which is part of the library. Private to mesh/.
namespace ricochet::gmsh {

/// The versions that decide what comes out. Throws Error(invalid_input), which says what to install for `source`.
[[nodiscard]] std::string converter_version(const std::string& source);

/// Writes `input` as .msh to `output`, in the directory `workspace` which is there. Throws Error(invalid_input), which
/// says what is wrong with the file or what to install.
void convert_mesh(const std::string& input, const std::filesystem::path& workspace,
                  const std::filesystem::path& output);

/// Says what the converter noted in a file that it wrote, as notes and warnings about `source`.
void repeat_notes(std::string_view content, const std::string& source);

}  // namespace ricochet::gmsh
