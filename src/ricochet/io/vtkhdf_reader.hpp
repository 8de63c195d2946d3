#pragma once

#include <array>
#include <string>
#include <vector>

#include "ricochet/hdf5/hdf5_file.hpp"
#include "ricochet/io/result_frames.hpp"

/// @file Reader for results.vtkhdf and obstacles.vtkhdf. Supports only the files that vtkhdf_output.cpp writes.
namespace ricochet {

/// For each component of a symmetric tensor in VTK's order, xx, yy, zz, xy, yz, xz, its index in ours, xx, xy, xz, yy,
/// yz, zz, which is XDMF's.
constexpr std::array<int, 6> vtk_tensor_from_ours = {0, 3, 5, 1, 4, 2};

/// Throws Error(invalid_input).
[[nodiscard]] ResultFrames read_vtkhdf_frames(const Hdf5Reader& file);
/// Dataset with the values of a field, frame after frame.
[[nodiscard]] std::string vtkhdf_name(const ResultField& field);
/// Throws Error(file_access) or Error(invalid_input).
[[nodiscard]] std::vector<ObstacleFrame> read_vtkhdf_obstacles(const std::string& path);

}  // namespace ricochet
