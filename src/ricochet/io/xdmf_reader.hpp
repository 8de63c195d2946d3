#pragma once

#include <string>
#include <vector>

#include "ricochet/io/result_frames.hpp"

/// @file Reader for results.xdmf and obstacles.xdmf: the content of each frame, and the surfaces of the obstacles.
/// Supports only the documents that XdmfFile writes.
namespace ricochet {

/// Throws Error(file_access) or Error(invalid_input).
[[nodiscard]] ResultFrames read_xdmf_frames(const std::string& path);

/// Throws Error(file_access) or Error(invalid_input).
[[nodiscard]] std::vector<ObstacleFrame> read_xdmf_obstacles(const std::string& path);

}  // namespace ricochet
