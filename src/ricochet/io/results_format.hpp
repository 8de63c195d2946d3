#pragma once

/// @file The formats that fields are written in (`output.format`).
namespace ricochet {

enum class ResultsFormat {
  xdmf,   ///< results.h5 with results.xdmf and obstacles.xdmf
  vtkhdf  ///< results.vtkhdf and obstacles.vtkhdf
};

/// The file of a run that is locked while its frames change or are looked at: not one of HDF5, which locks its files
/// itself.
[[nodiscard]] constexpr const char* lock_of_results(ResultsFormat format) {
  return format == ResultsFormat::xdmf ? "results.xdmf" : "history.csv";
}

}  // namespace ricochet
