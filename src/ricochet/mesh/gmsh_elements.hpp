#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/mesh/cell_type.hpp"

/// @file Gmsh's element types and their node numbering. Private to mesh/.
namespace ricochet::gmsh {

struct ElementType {
  int number = 0;
  const char* name = "";
  int dimension = 0;
  int degree = 0;
  int node_count = 0;              ///< 0 if it varies from element to element
  std::optional<CellShape> shape;  ///< for the types that can be cells or facets
};

/// Returns the type with that number, or null if it is unknown here.
[[nodiscard]] const ElementType* find_element_type(int number);

/// Returns "type 17 (20-node hexahedron)".
[[nodiscard]] std::string describe_type(int number);

/// For a usable shape: node i in Basix's order is node node_order(…)[i] in Gmsh's.
[[nodiscard]] const std::vector<int>& node_order(CellShape shape, int degree);

}  // namespace ricochet::gmsh
