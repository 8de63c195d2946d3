#pragma once

/// @file How much of a test a build with sanitizers does: they look at the code and not at the numbers, and cost two
/// orders of magnitude, so a sample is enough.
namespace ricochet::test {

#ifdef __SANITIZE_ADDRESS__
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

/// Of each kind of random problem.
constexpr unsigned seeds(unsigned count) {
  return is_sanitized ? (count + 9) / 10 : count;
}

}  // namespace ricochet::test
