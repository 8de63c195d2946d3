#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// @file Content of a .msh file before it is checked and renumbered. Private to mesh/.
namespace ricochet::gmsh {

/// Elements of one Gmsh type, on one geometric entity, in the same physical groups.
struct RawElements {
  int type = 0;
  int entity = 0;           ///< tag of the point, curve, surface or volume of the geometry
  std::vector<int> groups;  ///< tags of the physical groups, ascending
  std::vector<std::int64_t> tags;
  std::vector<std::int64_t> nodes;  ///< node tags in Gmsh's order, element by element
};

struct RawMesh {
  std::vector<std::int64_t> node_tags;
  std::vector<double> coordinates;  ///< x, y, z of each node
  std::vector<RawElements> elements;
  std::map<std::pair<int, int>, std::string> physical_names;  ///< by dimension and tag
};

/// Reads the content of a .msh file, 2.2 or 4.1, ASCII or binary; `source` is its name for messages.
[[nodiscard]] RawMesh read_msh(std::string_view content, const std::string& source);

}  // namespace ricochet::gmsh
