#pragma once

#include "ricochet/case/case.hpp"
#include "ricochet/case/section_reader.hpp"

namespace ricochet {

/// Paths of files are relative to the case file, `case_path`.
[[nodiscard]] ObstacleSection read_obstacle(const SectionReader& reader, const std::string& case_path);

}  // namespace ricochet
