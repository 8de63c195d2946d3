#pragma once

#include "ricochet/case/case.hpp"
#include "ricochet/case/section_reader.hpp"

namespace ricochet {

/// Files are beside the case file, at `case_path`.
[[nodiscard]] ObstacleSection read_obstacle(const SectionReader& reader, const std::string& case_path);

}  // namespace ricochet
