#pragma once

#include "ricochet/io/results_storage.hpp"

/// @file Reader for results.vtkhdf and obstacles.vtkhdf. Supports only the files that vtkhdf_output.cpp writes. Both
/// functions are those of ResultsFormat.
namespace ricochet {

[[nodiscard]] std::unique_ptr<ResultsStorage> open_vtkhdf_results(const std::string& directory,
                                                                  const ResultsFormat& format);
[[nodiscard]] std::vector<ObstacleFrame> read_vtkhdf_obstacles(const std::string& directory,
                                                               const ResultsFormat& format);

}  // namespace ricochet
