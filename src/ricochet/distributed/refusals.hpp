#pragma once

#include "ricochet/model/model.hpp"

/// @file Features that cases on several processes do not support yet.
namespace ricochet {

/// Throws Error(invalid_input) at the location in the case, and states a remedy.
void refuse_undividable_case(const Case& input);
void refuse_undividable_model(const Case& input, const Model& global, int processes);

}  // namespace ricochet
