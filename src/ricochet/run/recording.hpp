#pragma once

#include <memory>

#include "ricochet/base/timer.hpp"
#include "ricochet/io/history_file.hpp"
#include "ricochet/io/results_file.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/run/distortion_watch.hpp"
#include "ricochet/run/field_schedule.hpp"
#include "ricochet/run/method_watch.hpp"
#include "ricochet/run/rotation_watch.hpp"
#include "ricochet/run/run_checks.hpp"
#include "ricochet/simulation/impact/impacts.hpp"
#include "ricochet/simulation/monitor/late_contact_watch.hpp"
#include "ricochet/simulation/monitor/peak_stress.hpp"
#include "ricochet/simulation/monitor/penetration_watch.hpp"
#include "ricochet/simulation/monitor/sliding_watch.hpp"

/// @file Output during a run: history, fields, and the watches whose reports enter the summary.
namespace ricochet {

class Recording {
 public:
  /// Records a run of so many steps, from this state on, into a directory: in new files, or in those of the run to
  /// which the snapshot belongs. `factor_entries` refers to the step solver. Throws Error(file_access).
  Recording(const Case& input, const Model& model, const Scheme& scheme, const State& state,
            const std::string& directory, long steps, std::size_t factor_entries, const Snapshot* snapshot);

  /// Records the state after every step, including the initial one, as a run without end would. Throws
  /// Error(file_access), and Error(not_converged) if the motion has diverged or violates a balance that is to stop it.
  void record(const State& state, EnergyAccount& account);
  /// Enters, before record(), every part of a step that was cut, or the whole step once.
  void enter_part(const State& state, EnergyAccount& account);
  /// Enters an impulse per dof that acted between two steps.
  void enter_impulse(const State& state, const Vector& impulse) {
    checks_.enter_impulse(state, impulse);
    impacts_.enter_impulse(state);
  }
  /// Records the last state where record() has not done so: the end of a run is always among its results.
  void record_end(const State& state, EnergyAccount& account);
  /// Saves the state that a resumed run needs, after syncing the files to the disk.
  void save(Snapshot& snapshot);
  /// Flushes the files. Throws Error(file_access) if another program has changed a file of the run.
  void flush();
  /// Describes the results so far.
  void describe(RunSummary& summary) const;
  /// Seconds spent in this class.
  [[nodiscard]] double seconds() const { return seconds_; }
  /// Seconds spent in the watches of contact, included in seconds().
  [[nodiscard]] double watch_seconds() const { return watch_seconds_; }

 private:
  void persist(const SnapshotVisitor& visit);
  [[nodiscard]] double method_energy(const State& state, EnergyAccount& account) const;
  void write_row(const State& state, EnergyAccount& account);
  void check_finite(const std::vector<double>& row) const;
  void describe_bodies(RunSummary& summary) const;
  void describe_peak_stress(RunSummary& summary) const;

  FieldSchedule fields_;
  std::unique_ptr<ResultsWriter>
      results_;  ///< first, as it checks that the fields are unchanged and modifies nothing else
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
  const Scheme& scheme_;
  std::vector<std::string> body_names_;
  ImpactRecorder impacts_;
  PeakStress peak_stress_;
  PenetrationWatch penetration_;
  SlidingWatch sliding_;
  LateContactWatch late_;
  RotationWatch rotation_;
  DistortionWatch distortion_;
  MethodWatch method_;
  long history_every_;
  Timer since_flush_;
  double seconds_ = 0.0, watch_seconds_ = 0.0;
};

}  // namespace ricochet
