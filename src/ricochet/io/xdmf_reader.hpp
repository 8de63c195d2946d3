#pragma once

#include <string>
#include <vector>

#include "ricochet/io/result_frames.hpp"

/// @file Reads results.xdmf and obstacles.xdmf back: what is in each frame, and the surfaces of the obstacles. Only the
/// documents that XdmfFile writes are understood.
namespace ricochet {

/// Throws Error(file_access) or Error(invalid_input).
[[nodiscard]] ResultFrames read_xdmf_frames(const std::string& path);

/// Throws Error(file_access) or Error(invalid_input).
[[nodiscard]] std::vector<ObstacleFrame> read_xdmf_obstacles(const std::string& path);

}  // namespace ricochet
