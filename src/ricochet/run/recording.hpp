#pragma once

#include <memory>

#include "ricochet/base/timer.hpp"
#include "ricochet/io/history_file.hpp"
#include "ricochet/io/results_file.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/run/field_schedule.hpp"
#include "ricochet/run/method_watch.hpp"
#include "ricochet/run/rotation_watch.hpp"
#include "ricochet/run/run_checks.hpp"
#include "ricochet/simulation/impact/impacts.hpp"
#include "ricochet/simulation/monitor/late_contact_watch.hpp"
#include "ricochet/simulation/monitor/peak_stress.hpp"
#include "ricochet/simulation/monitor/penetration_watch.hpp"
#include "ricochet/simulation/monitor/sliding_watch.hpp"

/// @file Everything that is written while a run goes on: history and fields.
namespace ricochet {

class Recording {
 public:
  /// Of a run of so many steps, from this state on, into a directory: new files, or those of the run that the snapshot
  /// belongs to. `factor_entries`: of the step solver. Throws Error(file_access).
  Recording(const Case& input, const Model& model, const Scheme& scheme, const State& state,
            const std::string& directory, long steps, std::size_t factor_entries, const Snapshot* snapshot);

  /// Of the state after every step, the first one included: what a run without end would write. Throws
  /// Error(file_access), and Error(not_converged) when the motion has grown beyond all bounds or breaks an account that
  /// is to stop it.
  void record(const State& state, EnergyAccount& account);
  /// Before that: of every part of a step that was cut, or once.
  void enter_part(const State& state, EnergyAccount& account);
  /// An impulse per dof that acted between two steps.
  void enter_impulse(const State& state, const Vector& impulse) {
    checks_.enter_impulse(state, impulse);
    impacts_.enter_impulse(state);
  }
  /// Of the last state, what record() has left out: the end of a run is always in its results.
  void record_end(const State& state, EnergyAccount& account);
  /// What is needed to go on; the files are on the disk then.
  void save(Snapshot& snapshot);
  /// Hands over what has been recorded. Throws Error(file_access) where another program has changed a file of the run.
  void flush();
  /// What there is so far.
  void describe(RunSummary& summary) const;
  /// Spent here.
  [[nodiscard]] double seconds() const { return seconds_; }
  /// Of these, looking for penetration.
  [[nodiscard]] double watch_seconds() const { return watch_seconds_; }

 private:
  [[nodiscard]] double of_method(const State& state, EnergyAccount& account) const;
  void write_row(const State& state, EnergyAccount& account);
  void check_finite(const std::vector<double>& row) const;
  void describe_bodies(RunSummary& summary) const;
  void describe_peak_stress(RunSummary& summary) const;

  FieldSchedule fields_;
  std::unique_ptr<ResultsWriter>
      results_;  ///< first: looks whether the fields are what was written, and changes nothing else
  HistoryRecorder recorder_;
  std::unique_ptr<HistoryWriter> history_;  ///< on the first rank
  /// Probes with an interval of their own.
  struct Sampled {
    long every;
    SensorRecorder recorder;
    std::unique_ptr<HistoryWriter> file;  ///< on the first rank
  };
  void write_row_of(Sampled& sampled, const State& state);
  std::vector<Sampled> sampled_;
  HistoryDigest digest_;
  RunChecks checks_;
  const Model& model_;
  std::vector<std::string> body_names_;
  ImpactRecorder impacts_;
  PeakStress peak_stress_;
  PenetrationWatch penetration_;
  SlidingWatch sliding_;
  LateContactWatch late_;
  RotationWatch rotation_;
  MethodWatch method_;
  long history_every_;
  Timer since_flush_;
  double seconds_ = 0.0, watch_seconds_ = 0.0;
};

}  // namespace ricochet
