#pragma once

/// @file Formats of fields (`output.format`).
namespace ricochet {

enum class ResultsFormat {
  xdmf,   ///< results.h5 with results.xdmf and obstacles.xdmf
  vtkhdf  ///< results.vtkhdf and obstacles.vtkhdf
};

/// File of a run that is locked while its frames are written or read. It is not an HDF5 file, as HDF5 locks its files
/// itself.
[[nodiscard]] constexpr const char* lock_of_results(ResultsFormat format) {
  return format == ResultsFormat::xdmf ? "results.xdmf" : "history.csv";
}

}  // namespace ricochet
