#pragma once

#include "ricochet/case/section_reader.hpp"

/// @file Reading of the sections on bodies: their files, positions and initial motion.
namespace ricochet {

void read_bodies(const Sections& sections, Case& result);

/// Adds the motions of the mesh or the parts that are dropped or have a velocity or a spin, then those of [[motion]].
/// Requires that gravity, meshes and parts have been read.
void read_motions(const Sections& sections, Case& result);

}  // namespace ricochet
