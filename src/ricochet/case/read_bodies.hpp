#pragma once

#include <string>
#include <vector>

#include "ricochet/case/case.hpp"
#include "ricochet/case/section_reader.hpp"

/// @file Reading of the sections on bodies: their files, positions and initial motion.
namespace ricochet {

[[nodiscard]] MeshSection read_mesh(const SectionReader& reader, const std::string& case_path);
[[nodiscard]] PartSection read_part(const SectionReader& reader, const std::string& case_path);

/// Adds the motions of the mesh or the parts that are dropped or have a velocity or a spin, then those of [[motion]].
/// Requires that gravity, meshes and parts have been read.
void read_motions(const SectionReader& mesh, const std::vector<SectionReader>& parts,
                  const std::vector<SectionReader>& motions, Case& result);

}  // namespace ricochet
