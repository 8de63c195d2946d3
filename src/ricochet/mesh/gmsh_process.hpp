#pragma once

#include <array>
#include <filesystem>
#include <string>

/// @file Running the gmsh program. Private to mesh/.
namespace ricochet::gmsh {

/// Options of the command line, on which a mesh depends as on its file: all entities are meshed, of any dimension.
inline constexpr std::array command_options{"-3", "-v", "2", "-nt", "1"};

/// Returns the version of the gmsh program. Throws Error(invalid_input) that says what to do if it is not installed;
/// `source` is the file that needs it.
[[nodiscard]] std::string program_version(const std::string& source);

/// Meshes a .geo or CAD file into `output`, in the existing empty directory `workspace`. If gmsh fails, throws
/// Error(invalid_input) with the end of its output.
void run_program(const std::string& input, const std::string& options, const std::filesystem::path& workspace,
                 const std::filesystem::path& output);

}  // namespace ricochet::gmsh
