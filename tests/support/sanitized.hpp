#pragma once

/// @file Extent of a test in a build with sanitizers: these check the code, not the numbers, and cost two orders of
/// magnitude, so that a sample is enough.
namespace ricochet::test_support {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

/// Returns the number of random problems of each kind.
constexpr unsigned seeds(unsigned count) {
  return is_sanitized ? (count + 9) / 10 : count;
}

}  // namespace ricochet::test_support
