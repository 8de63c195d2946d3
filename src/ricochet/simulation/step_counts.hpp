#pragma once

#include <cstdint>

namespace ricochet {

/// What adaptive steps came to since the start.
struct StepCounts {
  std::int64_t refused = 0;              ///< attempts whose error was too large
  std::int64_t unsolved = 0;             ///< attempts that found no solution
  std::int64_t tolerated = 0;            ///< smallest steps with an error above the tolerance
  double largest_error = 0.0;            ///< relative to the tolerance, of steps that stayed
  double shortest = 0.0, longest = 0.0;  ///< steps that stayed
};

}  // namespace ricochet
