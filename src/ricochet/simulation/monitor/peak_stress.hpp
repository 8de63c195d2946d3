#pragma once

#include <memory>

#include "ricochet/base/ranks.hpp"
#include "ricochet/base/snapshot.hpp"
#include "ricochet/fem/stress.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/monitor/peak_stress_result.hpp"
#include "ricochet/simulation/monitor/stress_raisers.hpp"

/// @file The largest von Mises stress of a run: means of cells, as in the field of that name.
///
/// A look at all cells costs a good part of a step, so where that would take more than `share` of the run only some
/// states are looked at: every so many, and while there is contact those in which the contact forces press harder than
/// in any state looked at before, for which what other times save is spent. How many were looked at is told. Which ones
/// depends on the case alone, never on the clock.
namespace ricochet {

class PeakStress {
 public:
  /// Of all looks together, in the time of the steps.
  static constexpr double share = 0.05;

  /// `step_work`: how much a step of the whole body does, see step_work(). Keeps a reference to the body.
  /// Of a body that is divided: the largest of the cells of this rank, at the same looks on all.
  /// `raisers`: says what the largest stress sits on; null: nobody asks.
  PeakStress(const Body& body, double step_work, const Ranks& ranks = one_rank(),
             std::unique_ptr<StressRaisers> raisers = nullptr);
  void save(Snapshot& snapshot, const std::string& name) const;
  void load(const Snapshot& snapshot, const std::string& name);

  /// A state, one after the other. One of a frame is looked at in any case.
  void enter(const State& state, bool is_frame);
  /// The last of these states gets a frame all the same, as an end does.
  void enter_frame(const State& state);
  [[nodiscard]] const PeakStressResult& result() const { return result_; }

 private:
  void look(const State& state);

  const Body& body_;
  const Ranks& ranks_;
  CellStress stress_;
  std::unique_ptr<StressRaisers> raisers_;
  double looks_per_step_;       ///< that may be taken
  double saved_ = 0.0;          ///< looks for states that press harder
  double since_look_ = 0.0;     ///< looks that regular ones have not taken
  double hardest_press_ = 0.0;  ///< Σ r_N of the states looked at
  long last_look_ = -1;         ///< its step
  PeakStressResult result_;
};

/// Time of a look at all cells relative to that of reading a number of a factor: measured, see docs/performance.md.
[[nodiscard]] double look_work(const Body& body);
/// What a step reads at least, in numbers: the factor twice, or the stiffness where there is none.
[[nodiscard]] double step_work(Index dofs, std::size_t factor_entries);

}  // namespace ricochet
