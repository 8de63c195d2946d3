#pragma once

#include "ricochet/base/types.hpp"

/// @file Estimates of a run's memory, in bytes, before anything is assembled.
namespace ricochet {

/// Peak memory of a run that is solved by iterations; a factor takes more.
[[nodiscard]] inline double memory_of_iterations(Index dofs) {
  constexpr double per_dof = 2400.0;
  return per_dof * double(dofs);
}

/// Memory of a dense contact problem of so many rows, with its factor and copies.
[[nodiscard]] inline double memory_of_contact(double rows) {
  constexpr double copies = 12.0;
  return copies * sizeof(double) * rows * rows;
}

}  // namespace ricochet
