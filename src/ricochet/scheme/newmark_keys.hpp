#pragma once

#include <vector>

#include "ricochet/base/parameters.hpp"

/// @file Keys of Newmark's beta and gamma in a case file: by value or by the name of a preset.
namespace ricochet {

struct NewmarkParameters {
  double beta = 0.0, gamma = 0.0;  ///< textbook definition
};

[[nodiscard]] std::vector<Key> newmark_keys();
/// Resolves a preset: afterwards `values` contains the effective beta and gamma, and the preset if both come from it.
void check_newmark(const ParameterCheck& check, Parameters& values);
[[nodiscard]] NewmarkParameters newmark_parameters(const Parameters& values);

}  // namespace ricochet
