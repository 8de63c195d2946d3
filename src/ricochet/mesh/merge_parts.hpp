#pragma once

#include <string>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file Merging the meshes of several files into one.
namespace ricochet {

struct NamedMesh {
  std::string name;
  Mesh mesh;
};

/// Returns why the meshes of two files cannot be merged, and what to do; empty if they can.
[[nodiscard]] std::string mismatch_of_parts(const NamedMesh& first, const NamedMesh& other);

/// Merges the parts side by side, in their order; they share no nodes, even where nodes coincide. A group is called
/// "NAME.group", with the name of its part. Numbers in messages are those of the file plus 1,000,000 (or the power of
/// ten above all of them) for every preceding part; a note says so. Throws Error(invalid_input) if mismatch_of_parts
/// finds a reason.
[[nodiscard]] Mesh merge_parts(const std::vector<NamedMesh>& parts);

}  // namespace ricochet
