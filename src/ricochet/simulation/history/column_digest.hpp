#pragma once

#include <array>

/// @file Columns of the history, over a run.
namespace ricochet {

/// The columns that are works, cumulative.
inline constexpr std::array work_columns{"load_work",    "contact_work",  "friction_work",
                                         "support_work", "obstacle_work", "damping_work"};

/// What a column did over a run.
struct ColumnDigest {
  double first = 0.0, last = 0.0, minimum = 0.0, maximum = 0.0;
  double total_variation = 0.0;  ///< Σ |difference of consecutive rows|
};

}  // namespace ricochet
