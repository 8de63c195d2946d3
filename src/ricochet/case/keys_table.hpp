#pragma once

#include "ricochet/case/keys.hpp"

/// @file The parts of the table of keys, in keys_table*.cpp. Nothing else in the program lists the keys of a case file.
/// Not part of the public interface.
namespace ricochet {

inline const Range positive{.above = 0.0};
inline const Range nonnegative{.at_least = 0.0};

[[nodiscard]] Section probe_section();
[[nodiscard]] Section output_section();
[[nodiscard]] Section check_section();
[[nodiscard]] Section expect_section();

}  // namespace ricochet
