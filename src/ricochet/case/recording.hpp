#pragma once

#include <optional>

#include "ricochet/base/timer.hpp"
#include "ricochet/case/model.hpp"
#include "ricochet/case/run_checks.hpp"
#include "ricochet/io/history_file.hpp"
#include "ricochet/io/results_file.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/simulation/impacts.hpp"
#include "ricochet/simulation/peak_stress.hpp"

/// @file Everything that is written while a run goes on: history and fields.
namespace ricochet {

/// The steps after which fields are written.
class FieldSchedule {
 public:
  FieldSchedule(const Case& input, long steps, Index dofs);
  [[nodiscard]] bool any() const { return every_ > 0 || interval_ > 0.0; }
  [[nodiscard]] bool includes(long step) const;

 private:
  [[nodiscard]] double intervals(long step) const;

  long every_ = 0;
  double interval_ = 0.0;  ///< time, instead
  double step_size_;
  long steps_;
};

class Recording {
 public:
  /// Of a run of so many steps, from this state on, into a directory: new files, or those of the run that the snapshot
  /// belongs to. `factor_entries`: of the step solver. Throws Error(file_access).
  Recording(const Case& input, const Model& model, const Scheme& scheme, const State& state,
            const std::string& directory, long steps, std::size_t factor_entries, const Snapshot* snapshot);

  /// Of the state after every step, the first one included. Throws Error(file_access), and Error(not_converged) when
  /// the motion has grown beyond all bounds or breaks an account that is to stop it.
  void record(const State& state, EnergyAccount& account);
  /// What is needed to go on; the files are on the disk then.
  void save(Snapshot& snapshot);
  void flush();
  /// What there is so far.
  void describe(RunSummary& summary) const;
  /// Spent here.
  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  void open_results(const OutputSection& output, const Model& model, const std::string& directory,
                    const Snapshot* snapshot);
  void check_finite(const std::vector<double>& row) const;
  void describe_bodies(RunSummary& summary) const;
  void describe_peak_stress(RunSummary& summary) const;
  void watch_rotation(const std::vector<double>& row);

  HistoryRecorder recorder_;
  HistoryWriter history_;
  /// Probes with an interval of their own.
  struct Sampled {
    long every;
    SensorRecorder recorder;
    HistoryWriter file;
  };
  std::vector<Sampled> sampled_;
  std::optional<ResultsWriter> results_;
  HistoryDigest digest_;
  RunChecks checks_;
  const Model& model_;
  ImpactRecorder impacts_;
  PeakStress peak_stress_;
  long history_every_;
  FieldSchedule fields_;
  long steps_;
  bool rotation_warned_ = false;
  Timer since_flush_;
  double seconds_ = 0.0;
};

}  // namespace ricochet
