#pragma once

#include <vector>

#include "ricochet/model/model.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/solver/step_estimate.hpp"

/// @file Time and memory of a run before it starts, from the analysis of the operators and, for evaluations without an
/// operator, from measured times. The cost of contact depends on how many points press at a time, which only the run
/// shows.
namespace ricochet {

/// Cost without contact and with few iterations; with many iterations and a part of the contact points pressed; with
/// all pressed.
struct CostRange {
  static constexpr double part = 0.25;
  double least = 0.0, some = 0.0, most = 0.0;
};

struct CostEstimate {
  std::vector<StageEstimate> stages;
  double factorization_seconds = 0.0;             ///< sum over all stages
  double product_seconds = 0.0;                   ///< per step, for products with the matrices
  double force_seconds = 0.0;                     ///< per evaluation of the internal force, measured; 0 if it is linear
  double gap_seconds = 0.0;                       ///< per evaluation of gaps that follow the motion, measured
  int least_iterations = 1, most_iterations = 1;  ///< per step, over the linear stages
  CostRange step_seconds, memory;                 ///< memory in bytes, of the whole process
};

[[nodiscard]] CostEstimate estimate_cost(const Case& input, const Model& model, const Scheme& scheme);

}  // namespace ricochet
