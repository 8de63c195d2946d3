#pragma once

#include "ricochet/io/results_storage.hpp"

/// @file Reader for results.h5 with results.xdmf, and for obstacles.xdmf. Supports only the documents that XdmfFile
/// writes. Both functions are those of ResultsFormat.
namespace ricochet {

[[nodiscard]] std::unique_ptr<ResultsStorage> open_xdmf_results(const std::string& directory,
                                                                const ResultsFormat& format);
[[nodiscard]] std::vector<ObstacleFrame> read_xdmf_obstacles(const std::string& directory, const ResultsFormat& format);

}  // namespace ricochet
