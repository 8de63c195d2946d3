#pragma once

#include <string>
#include <vector>

#include "ricochet/hdf5/hdf5_file.hpp"
#include "ricochet/io/result_frames.hpp"

/// @file Reader for results.vtkhdf and obstacles.vtkhdf. Supports only the files that vtkhdf_output.cpp writes.
namespace ricochet {

/// Throws Error(invalid_input).
[[nodiscard]] ResultFrames read_vtkhdf_frames(const Hdf5Reader& file);
/// Dataset with the values of a field, frame after frame.
[[nodiscard]] std::string vtkhdf_name(const ResultField& field);
/// Throws Error(file_access) or Error(invalid_input).
[[nodiscard]] std::vector<ObstacleFrame> read_vtkhdf_obstacles(const std::string& path);

}  // namespace ricochet
