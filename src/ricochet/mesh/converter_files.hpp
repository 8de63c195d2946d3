#pragma once

#include <string>
#include <vector>

/// @file The Python program that converts meshes, with the text it has in converter/: a program that links the library
/// needs no files beside it. Private to mesh/.
namespace ricochet::gmsh {

struct ConverterFile {
  std::string name, text;
};

/// Files of the converter: convert_mesh.py, which is run, and those it imports.
[[nodiscard]] const std::vector<ConverterFile>& converter_files();

}  // namespace ricochet::gmsh
