#pragma once

#include <memory>

#include "ricochet/base/ranks.hpp"
#include "ricochet/base/snapshot.hpp"
#include "ricochet/fem/stress.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/monitor/peak_stress_result.hpp"
#include "ricochet/simulation/monitor/stress_raisers.hpp"

/// @file Largest von Mises stress of a run: means over cells, as in the field of that name.
///
/// Evaluating all cells costs a good part of a step. If this would take more than `share` of the run, only some states
/// are evaluated: at regular intervals, and during contact those with a larger contact force than any state evaluated
/// before, for which the budget saved at other times is spent. The number of evaluated states is reported; their
/// selection depends on the case alone, never on the clock.
namespace ricochet {

class PeakStress {
 public:
  /// Largest share of all evaluations in the time of the steps.
  static constexpr double share = 0.05;

  /// `step_work`: work of a step of the whole body, see step_work(). Keeps a reference to the body.
  /// On a divided body the result is the largest stress of the cells of this rank, at the same states on all ranks.
  /// `raisers`: identifies what raises the largest stress; null if this is not required.
  PeakStress(const Body& body, double step_work, const Ranks& ranks = one_rank(),
             std::unique_ptr<StressRaisers> raisers = nullptr);
  void persist(const SnapshotVisitor& visit);

  /// Enters the next state. A state that is saved in a frame is always evaluated.
  void enter(const State& state, bool is_frame);
  /// Evaluates the last of these states if it is saved in a frame after all, as at the end.
  void enter_frame(const State& state);
  [[nodiscard]] const PeakStressResult& result() const { return result_; }

 private:
  void evaluate(const State& state);

  const Body& body_;
  const Ranks& ranks_;
  CellStress stress_;
  std::unique_ptr<StressRaisers> raisers_;
  double evaluations_per_step_;     ///< budget of evaluations
  double evaluation_budget_ = 0.0;  ///< evaluations saved for larger contact forces
  double since_evaluation_ = 0.0;   ///< fraction of the next regular evaluation
  double hardest_press_ = 0.0;      ///< largest Σ r_N of the evaluated states
  long last_evaluation_ = -1;       ///< step of the last evaluation
  PeakStressResult result_;
};

/// Time of evaluating all cells relative to that of reading a number of a factor: measured, see docs/performance.md.
[[nodiscard]] double evaluation_work(const Body& body);
/// Numbers that a step reads at least: the factor twice, or the stiffness if there is no factor.
[[nodiscard]] double step_work(Index dofs, std::size_t factor_entries);

}  // namespace ricochet
