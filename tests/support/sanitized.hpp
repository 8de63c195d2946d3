#pragma once

#include <cstdlib>

/// @file Extent of a test in a build with sanitizers: these check the code, not the numbers, and cost two orders of
/// magnitude, so that a sample is enough.
namespace ricochet::test_support {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

/// Returns the number of random problems of each kind.
constexpr unsigned seeds(unsigned count) { return is_sanitized ? (count + 9) / 10 : count; }
/// Returns it as well, or `count` times RICOCHET_RANDOM_CASES if that is set.
inline unsigned samples(unsigned count) {
  const char* const factor = std::getenv("RICOCHET_RANDOM_CASES");
  return factor != nullptr ? count * unsigned(std::atoi(factor)) : seeds(count);
}

}  // namespace ricochet::test_support
