#pragma once

#include <tuple>

/// @file Digests of the columns of a history.
namespace ricochet {

/// Summary of a column over a run.
struct ColumnDigest {
  double first = 0.0, last = 0.0, minimum = 0.0, maximum = 0.0;
  double total_variation = 0.0;  ///< Σ |difference of consecutive rows|

  [[nodiscard]] auto members() { return std::tie(first, last, minimum, maximum, total_variation); }
};

}  // namespace ricochet
