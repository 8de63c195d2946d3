#pragma once

#include "ricochet/case/keys.hpp"

/// @file The parts of the table of keys, in keys_table*.cpp. Nothing else in the program lists the keys of a case file.
/// Not part of the public interface.
namespace ricochet {

inline const Range positive{.above = 0.0};
inline const Range nonnegative{.at_least = 0.0};

// keys_table_model.cpp: what is simulated.
[[nodiscard]] Section mesh_section();
[[nodiscard]] Section material_section();
[[nodiscard]] Section obstacle_section();
[[nodiscard]] Section contact_section();
[[nodiscard]] Section support_section();
[[nodiscard]] Section traction_section();
[[nodiscard]] Section load_section();
[[nodiscard]] Section initial_section();
// keys_table_method.cpp: how.
[[nodiscard]] Section mass_section();
[[nodiscard]] Section time_section();
[[nodiscard]] Section solver_section();
// keys_table_results.cpp: what is watched, written, kept and expected.
[[nodiscard]] Section probe_section();
[[nodiscard]] Section output_section();
[[nodiscard]] Section check_section();
[[nodiscard]] Section expect_section();

}  // namespace ricochet
