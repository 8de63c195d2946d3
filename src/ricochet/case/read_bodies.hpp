#pragma once

#include <string>
#include <vector>

#include "ricochet/case/case.hpp"
#include "ricochet/case/section_reader.hpp"

/// @file Reading the sections about bodies: their files, places, and how they move at the start.
namespace ricochet {

[[nodiscard]] MeshSection read_mesh(const SectionReader& reader, const std::string& case_path);
[[nodiscard]] PartSection read_part(const SectionReader& reader, const std::string& case_path);

/// Adds those of the parts that have a velocity or a spin, then those of [[motion]].
void read_motions(const std::vector<SectionReader>& parts, const std::vector<SectionReader>& motions, Case& result);

}  // namespace ricochet
