#pragma once

#include "ricochet/base/types.hpp"

/// @file Largest von Mises stress of a run and the number of states that were evaluated for it.
namespace ricochet {

/// Causes of a stress that grows with refinement, see stress_raisers.hpp.
enum class StressRaiser : char { none, reentrant_edge, support_edge, contact_edge, obstacle_edge };
inline constexpr int stress_raisers = 5;

struct PeakStressResult {
  double von_mises = 0.0, time = 0.0;
  long step = 0;
  Index cell = -1;                   ///< numbered through all blocks; −1: not evaluated yet
  long evaluations = 0, states = 0;  ///< evaluated states, and all states
  StressRaiser raised_by = StressRaiser::none;
};

}  // namespace ricochet
