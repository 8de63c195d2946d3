#pragma once

#include "ricochet/base/keys.hpp"

namespace ricochet {

/// Key "restitution" of schemes with a coefficient of restitution at every contact point.
[[nodiscard]] inline Key restitution_key() {
  return number_key("restitution", "1", {.default_value = "0", .range = {.at_least = 0.0, .at_most = 1.0}},
                    "Newton's coefficient of restitution of each contact point; an elastic body bounces without it.");
}

}  // namespace ricochet
