#pragma once

#include <string>
#include <vector>

#include "ricochet/mesh/mesh.hpp"

/// @file One mesh of the meshes of several files.
namespace ricochet {

struct NamedMesh {
  std::string name;
  Mesh mesh;
};

/// Why the meshes of two files cannot be one, and what to do; empty: they can.
[[nodiscard]] std::string mismatch_of_parts(const NamedMesh& first, const NamedMesh& other);

/// The parts side by side, in their order; none shares a node with another, also where they are at one place. A group
/// is called "NAME.group", NAME being its part's. Numbers for messages are those of the file, and 1,000,000 more (or
/// the power of ten that is above all of them) for every part before; a note says so. Throws Error(invalid_input) where
/// mismatch_of_parts has something to say.
[[nodiscard]] Mesh merge_parts(const std::vector<NamedMesh>& parts);

}  // namespace ricochet
