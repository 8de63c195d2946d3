#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "ricochet/base/error.hpp"
#include "ricochet/base/interruption.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/case/model.hpp"
#include "ricochet/case/recording.hpp"
#include "ricochet/case/run_case.hpp"
#include "ricochet/case/run_times.hpp"
#include "ricochet/io/contact_export.hpp"
#include "ricochet/io/failure_bundle.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/simulation/simulation.hpp"

/// @file One run: how it starts or goes on and takes its steps (run.cpp), and what it leaves on the way, checkpoints
/// and summaries (run_records.cpp).
namespace ricochet {

/// A run from its directory to its summary.
class Run {
 public:
  Run(const Case& input, const RunOptions& options);

  RunSummary go();

 private:
  [[nodiscard]] bool is_complete();
  void find_checkpoint();
  [[noreturn]] void refuse_earlier_end(long reached) const;
  void begin();
  void begin_simulation();
  void open_files();
  void start_recording();
  void take_steps();
  void stop(int signal);
  void end_early();
  void keep_state_before_step();
  [[nodiscard]] Snapshot take_snapshot();
  void write_checkpoint();
  void write_failure_bundle(long step);
  void report_progress();
  [[nodiscard]] RunTimes times_until_now() const;
  void describe_progress(RunSummary& summary) const;
  void finish();
  [[nodiscard]] std::string summary_path() const { return directory_.file("summary.json"); }

  const Case& input_;
  const RunOptions& options_;
  RunDirectory directory_;
  long steps_;
  RunTimes times_;
  std::unique_ptr<Model> model_;
  std::unique_ptr<Scheme> scheme_;
  bool knows_what_ran_ = false;       ///< to be resumed: there is a summary, and it is that of this case
  bool was_complete_ = false;         ///< to be resumed: to a later end
  std::optional<Snapshot> snapshot_;  ///< that the run goes on from
  std::optional<Simulation> simulation_;
  std::optional<ContactExport> contact_export_;
  std::optional<FailureBundle> failure_bundle_;
  std::optional<Recording> recording_;
  double contact_before_ = 0.0;
  RunSummary summary_;
  std::optional<Error> failure_;
  Timer since_checkpoint_, since_report_;
  double step_seconds_ = 0.0, snapshot_seconds_ = 0.0;  ///< the last took

  /// Held while the files of the run change: whoever ends the run in the middle of its work waits for that.
  std::timed_mutex files_;
  std::optional<RunSummary> reported_;  ///< the run's own that is on the disk
  std::optional<Snapshot> before_step_;
  std::optional<StoppingPoints> stopping_points_;
  AtInterruption at_interruption_;  ///< the last to be made, the first to go
};

}  // namespace ricochet
