#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "ricochet/base/error.hpp"
#include "ricochet/base/interruption.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/io/contact_export.hpp"
#include "ricochet/io/failure_bundle.hpp"
#include "ricochet/io/progress.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/run/newton_watch.hpp"
#include "ricochet/run/recording.hpp"
#include "ricochet/run/run_case.hpp"
#include "ricochet/run/run_times.hpp"
#include "ricochet/run/session.hpp"

/// @file One run: its start or resumption and its steps (run.cpp); its checkpoints and summaries (run_records.cpp).
namespace ricochet {

/// A run from its directory to its summary.
class Run {
 public:
  /// Keeps references to both.
  Run(Session& session, const RunOptions& options);

  /// Examines the directory, builds and starts the session, and opens the files. Nothing is left to do if the run to be
  /// resumed is complete.
  void begin();
  /// Returns true if the run to be resumed was complete already, so that there is no state.
  [[nodiscard]] bool is_complete_already() const { return is_already_complete_; }
  /// Enters an impulse per dof by which a program has changed the velocity.
  void enter_impulse(const Vector& impulse);
  /// Writes a checkpoint of the present state, unless the run has ended.
  void write_checkpoint_now();
  /// Computes and records one step. Returns false at the end, after a failure, or after a signal.
  bool take_step();
  /// Returns the summary; throws the error that ended the steps.
  RunSummary finish();

 private:
  [[nodiscard]] bool is_complete();
  void find_checkpoint();
  void check_snapshot();
  [[noreturn]] void refuse_earlier_end(double reached) const;
  void begin_simulation();
  void begin_session();
  void open_files();
  [[nodiscard]] std::size_t entries_of_whole_body() const;
  void start_recording();
  bool advance();
  [[nodiscard]] bool is_near_end();
  void write_end_checkpoint();
  void warn_of_many_iterations();
  void report_size() const;
  void end_steps();
  /// Returns "step 12 of 100", or with adaptive steps "step 12 (t = 0.5 of 2)".
  [[nodiscard]] std::string step_in_words();
  void stop(int signal);
  void interrupt(const std::string& how);
  void end_on_interruption();
  void keep_state_before_step();
  [[nodiscard]] Snapshot take_snapshot();
  void write_checkpoint();
  void write_failure_bundle(long step);
  void report_progress();
  [[nodiscard]] RunTimes times_until_now() const;
  void describe_progress(RunSummary& summary);
  void write_end();
  [[nodiscard]] std::string summary_path() const { return directory_.file("summary.json"); }

  void gather_from_ranks(RunSummary& summary);
  [[nodiscard]] Traffic traffic() const;
  void describe_processes(RunSummary& summary) const;
  void add_work_of_ranks(RunSummary& summary) const;
  void write_own_summary(const RunSummary& summary) const;

  Session& session_;
  const Case& input_;
  const RunOptions& options_;
  const Ranks& ranks_;
  RunDirectory directory_;
  long steps_;
  std::ptrdiff_t reading_warning_count_;  ///< number of warnings from reading the case
  RunTimes times_;
  bool is_already_complete_ = false;  ///< the run to be resumed is complete
  bool has_ended_ = false, has_end_checkpoint_ = false;
  bool has_matching_summary_ = false;  ///< the run to be resumed has a summary of this case
  bool was_complete_ = false;          ///< the run to be resumed had ended, and now has a later end
  std::optional<Snapshot> snapshot_;   ///< snapshot from which the run resumes
  std::optional<ContactExport> contact_export_;
  std::optional<FailureBundle> failure_bundle_;
  std::optional<Recording> recording_;
  std::optional<Progress> progress_;
  NewtonWatch newton_;
  double contact_before_ = 0.0;
  Traffic traffic_before_;  ///< before the steps
  long first_step_ = 0;     ///< number of steps before this session
  RunSummary summary_;
  std::optional<Error> failure_;
  Timer since_checkpoint_, since_report_;
  long step_ = 0;                                       ///< number of the step begun last
  double step_seconds_ = 0.0, snapshot_seconds_ = 0.0;  ///< of the last step, and of its snapshot

  /// Held while the files of the run change: an interruption in the middle of a step waits for it.
  std::timed_mutex files_;
  std::optional<RunSummary> reported_;  ///< summary that this run has written to the disk
  std::optional<Snapshot> before_step_;
  std::optional<StoppingPoints> stopping_points_;
  AtInterruption at_interruption_;  ///< made last, destroyed first
};

}  // namespace ricochet
