#pragma once

#include <string>
#include <vector>

/// @file The Python program that converts meshes, as it stands in converter/: a program that links the library needs no
/// files beside it. Private to mesh/.
namespace ricochet::gmsh {

struct ConverterFile {
  std::string name, text;
};

/// One of them is convert_mesh.py, which is run; the others it imports.
[[nodiscard]] const std::vector<ConverterFile>& converter_files();

}  // namespace ricochet::gmsh
