#pragma once

#include <array>

#include "ricochet/io/results_storage.hpp"

/// @file Reader for results.vtkhdf and obstacles.vtkhdf. Supports only the files that vtkhdf_output.cpp writes. Both
/// functions are those of ResultsFormat.
namespace ricochet {

/// For each component of a symmetric tensor in VTK's order, xx, yy, zz, xy, yz, xz, its index in ours, xx, xy, xz, yy,
/// yz, zz, which is XDMF's.
constexpr std::array<int, 6> vtk_tensor_from_ours = {0, 3, 5, 1, 4, 2};

[[nodiscard]] std::unique_ptr<ResultsStorage> open_vtkhdf_results(const std::string& directory,
                                                                  const ResultsFormat& format);
[[nodiscard]] std::vector<ObstacleFrame> read_vtkhdf_obstacles(const std::string& directory,
                                                               const ResultsFormat& format);

}  // namespace ricochet
