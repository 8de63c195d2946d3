#include "ricochet/mesh/gmsh_elements.hpp"

#include <fmt/format.h>

#include <array>
#include <map>
#include <vector>

#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet::gmsh {

namespace {

struct OtherTypes {
  const char* kind;
  int dimension;
  std::vector<std::array<int, 3>> types;  ///< number, degree and number of nodes, 0 if it varies
};

/// Types that are listed only to be refused by name, unless a shape has their number; their numbers of nodes let the
/// binary formats be read past them, so that the message can count them.
const OtherTypes other_types[] = {
    {"point", 0, {{15, 0, 1}}},
    {"line", 1, {{26, 3, 4}, {27, 4, 5}, {28, 5, 6}}},
    {"triangle", 2, {{20, 3, 9}, {21, 3, 10}, {22, 4, 12}, {25, 5, 21}}},
    {"triangle of degree 4", 2, {{23, 4, 15}}},
    {"triangle of degree 5", 2, {{24, 5, 15}}},
    {"quadrilateral", 2, {{16, 2, 8}, {36, 3, 16}, {37, 4, 25}, {38, 5, 36}, {39, 3, 12}}},
    {"polygon", 2, {{34, 1, 0}}},
    {"tetrahedron", 3, {{29, 3, 20}, {30, 4, 35}, {31, 5, 56}}},
    {"hexahedron", 3, {{17, 2, 20}, {92, 3, 64}, {93, 4, 125}}},
    {"prism", 3, {{6, 1, 6}, {13, 2, 18}, {18, 2, 15}, {90, 3, 40}, {91, 4, 75}}},
    {"pyramid", 3, {{7, 1, 5}, {14, 2, 14}, {19, 2, 13}, {118, 3, 30}, {119, 4, 55}}},
    {"polyhedron", 3, {{35, 1, 0}}},
};

std::map<int, ElementType> make_element_types() {
  std::map<int, ElementType> types;
  const auto text = [](int nodes, const std::string& kind) { return fmt::format("{}-node {}", nodes, kind); };
  for (const CellShape shape : cell_shapes()) {
    for (const int degree : {1, 2}) {
      const int nodes = node_count(shape, degree), d = dimension(shape), number = file_type(shape, degree).gmsh;
      types[number] = {number, text(nodes, d == 1 ? "line" : name(shape)), d, degree, nodes, shape};
    }
  }
  for (const auto& [kind, dimension, all] : other_types) {
    for (const auto& [number, degree, nodes] : all)
      types.try_emplace(
          number, ElementType{number, degree * nodes > 0 ? text(nodes, kind) : kind, dimension, degree, nodes, {}});
  }
  return types;
}

}  // namespace

const ElementType* find_element_type(int number) {
  static const std::map<int, ElementType> types = make_element_types();
  const auto found = types.find(number);
  return found == types.end() ? nullptr : &found->second;
}

std::string describe_type(int number) {
  const ElementType* type = find_element_type(number);
  return fmt::format("type {} ({})", number, type != nullptr ? type->name : std::string("unknown to Ricochet"));
}

}  // namespace ricochet::gmsh
