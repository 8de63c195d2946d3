#pragma once

#include <string>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file What says whether a mesh is the one that a run began with.
namespace ricochet {

struct MeshChecksum {
  std::string of;    ///< "nodes"; of a mesh of several files "nodes of part "ball""
  std::string part;  ///< its name; empty for those of the whole mesh
  std::string sum;
};

/// Of nodes, cells, boundary facets and groups; of each part by itself, so that a message can name the one that
/// changed, and of the order of the parts.
[[nodiscard]] std::vector<MeshChecksum> mesh_checksums(const Mesh& mesh);

}  // namespace ricochet
