#pragma once

#include <cstdint>

namespace ricochet {

/// Statistics of adaptive steps since the start.
struct StepCounts {
  std::int64_t refused = 0;              ///< attempts whose error was too large
  std::int64_t unsolved = 0;             ///< attempts without a solution
  std::int64_t tolerated = 0;            ///< smallest steps with an error above the tolerance
  double largest_error = 0.0;            ///< of accepted steps, relative to the tolerance
  double shortest = 0.0, longest = 0.0;  ///< accepted steps
};

}  // namespace ricochet
