#pragma once

#include <string>
#include <vector>

/// @file The Python program that converts meshes, with the text it has in converter/: a program that links the library
/// needs no files beside it. For mesh/ and the Python package.
namespace ricochet::gmsh {

struct ConverterFile {
  std::string name, text;
};

/// Files of the converter: convert_mesh.py, which is run, those it imports, and cell_types.json.
[[nodiscard]] const std::vector<ConverterFile>& converter_files();

/// Returns the types of cells as the converter needs them, from the descriptions of the shapes, in JSON: by meshio's
/// name Gmsh's type, the dimension, the number of vertices, for each of Gmsh's nodes its number in meshio's order, the
/// facets in Abaqus' order, Exodus' sides, and whether there are nodes on faces or inside; and names for messages.
[[nodiscard]] std::string converter_cell_types();

}  // namespace ricochet::gmsh
