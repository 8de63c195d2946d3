#pragma once

#include <memory>
#include <optional>
#include <string>

#include "ricochet/base/error.hpp"
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
  void begin();
  void begin_simulation();
  void open_files();
  void start_recording();
  void take_steps();
  void stop(int signal);
  void write_checkpoint();
  void write_failure_bundle(long step);
  void report_progress();
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
  std::optional<Snapshot> snapshot_;  ///< that the run goes on from
  std::optional<Simulation> simulation_;
  std::optional<ContactExport> contact_export_;
  std::optional<FailureBundle> failure_bundle_;
  std::optional<Recording> recording_;
  double contact_before_ = 0.0;
  RunSummary summary_;
  std::optional<Error> failure_;
  Timer since_checkpoint_, since_report_;
};

}  // namespace ricochet
