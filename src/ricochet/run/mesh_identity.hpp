#pragma once

#include <string>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Checksums that tell whether a mesh is the one with which a run began.
namespace ricochet {

struct MeshChecksum {
  std::string of;    ///< "nodes"; in a mesh of several files "nodes of part "ball""
  std::string part;  ///< name of the part; empty for the whole mesh
  std::string sum;
};

/// Returns the checksums of nodes, cells, boundary facets and groups, separately for each part, so that a message can
/// name the one that changed, and of the order of the parts.
[[nodiscard]] std::vector<MeshChecksum> mesh_checksums(const Mesh& mesh);

}  // namespace ricochet
