#pragma once

#include "ricochet/model/model.hpp"

/// @file What cases on several processes cannot have yet.
namespace ricochet {

/// Throw Error(invalid_input) at the place in the case, and say what runs it.
void refuse_undividable_case(const Case& input);
void refuse_undividable_model(const Case& input, const Model& whole, int processes);

}  // namespace ricochet
