#pragma once

#include <optional>
#include <string>

#include "ricochet/mesh/shapes/cell_shape.hpp"

/// @file Gmsh's element types. Private to mesh/.
namespace ricochet::gmsh {

struct ElementType {
  int number = 0;
  std::string name;
  int dimension = 0;
  int degree = 0;
  int node_count = 0;              ///< 0 if it varies from element to element
  std::optional<CellShape> shape;  ///< for the types that can be cells or facets
};

/// Returns the type with that number, or null if it is unknown here.
[[nodiscard]] const ElementType* find_element_type(int number);

/// Returns "type 17 (20-node hexahedron)".
[[nodiscard]] std::string describe_type(int number);

}  // namespace ricochet::gmsh
