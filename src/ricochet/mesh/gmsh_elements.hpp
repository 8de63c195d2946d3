#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/mesh/cell_type.hpp"

/// @file Gmsh's element types and how Gmsh numbers their nodes. Private to mesh/.
namespace ricochet::gmsh {

struct ElementType {
  int number = 0;
  const char* name = "";
  int dimension = 0;
  int degree = 0;
  int node_count = 0;              ///< 0 when it varies from element to element
  std::optional<CellShape> shape;  ///< of the types that can be used as cells or facets
};

/// The type with that number, or nullptr when it is not known here.
[[nodiscard]] const ElementType* find_element_type(int number);

/// "type 17 (20-node hexahedron)"
[[nodiscard]] std::string describe_type(int number);

/// For a usable shape: node i in Basix's order is node node_order(…)[i] in Gmsh's.
[[nodiscard]] const std::vector<int>& node_order(CellShape shape, int degree);

}  // namespace ricochet::gmsh
