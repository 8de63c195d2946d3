#pragma once

#include <string>
#include <vector>

#include "ricochet/model/model.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/solver/step_estimate.hpp"

/// @file Time and memory of a run before it begins: from the analysis of the operators and from the measured time of
/// what has no operator. What contact adds depends on how much touches at a time, which only the run tells.
namespace ricochet {

/// Cost without contact and with few iterations; with many of them, a part of the contact points pressed, and with all.
struct CostRange {
  static constexpr double part = 0.25;
  double least = 0.0, some = 0.0, most = 0.0;
};

struct CostEstimate {
  std::vector<StageEstimate> stages;
  double factorization_seconds = 0.0;  ///< of all stages
  double product_seconds = 0.0;        ///< of a step, for products with the matrices
  double force_seconds = 0.0;          ///< measured, of an evaluation of the internal force; 0 where it is linear
  double gap_seconds = 0.0;            ///< measured, of the gaps of contact that follows the motion
  int least_iterations = 1, most_iterations = 1;  ///< of a step, over the linear stages
  CostRange step_seconds, memory;                 ///< memory in bytes, of the whole process
};

[[nodiscard]] CostEstimate estimate_cost(const Case& input, const Model& model, const Scheme& scheme);

}  // namespace ricochet
