#include <fmt/format.h>

#include <cstring>

#include "ricochet/base/log.hpp"
#include "ricochet/case/run.hpp"
#include "ricochet/case/run_identity.hpp"
#include "ricochet/case/run_judgement.hpp"
#include "ricochet/io/checkpoint.hpp"

namespace ricochet {

/// The state before the step that failed (or after it, where its results are not to be had) and its contact problem;
/// the message tells where they are.
void Run::write_failure_bundle(long step) {
  Snapshot snapshot;
  simulation_->save(snapshot);
  save_identity(input_, *model_, snapshot);
  try {
    const std::string note = failure_bundle_->write(step, snapshot, failure_->what());
    failure_ = Error(failure_->kind(), fmt::format("{}\n{}", failure_->what(), note));
  } catch (const Error& problem) {
    log::warning(problem.what());
  }
}

void Run::stop(int signal) {
  write_checkpoint();
  summary_.status = "interrupted";
  summary_.message = fmt::format("stopped by SIG{} after step {} of {}; run --resume goes on from there",
                                 sigabbrev_np(signal), simulation_->state().step, steps_);
}

void Run::write_checkpoint() {
  const Timer timer;
  Snapshot snapshot;
  simulation_->save(snapshot);
  recording_->save(snapshot);
  save_identity(input_, *model_, snapshot);
  RunTimes times = times_;
  times.contact += simulation_->contact_seconds() - contact_before_;
  times.output += recording_->seconds();
  times.save(snapshot, "run.times");
  snapshot.save("run.warnings", log::warnings());
  snapshot.save("run.resumed_at", Snapshot::Integers(summary_.resumed_at.begin(), summary_.resumed_at.end()));
  const long step = simulation_->state().step;
  ricochet::write_checkpoint(options_.output_directory, step, snapshot);
  summary_.checkpoint_step = step;
  times_.checkpoints += timer.seconds();
  since_checkpoint_.restart();
}

void Run::describe_progress(RunSummary& summary) const {
  recording_->describe(summary);
  summary.factor_entries = simulation_->factor_entries();
  summary.steps = simulation_->state().step;
  RunTimes times = times_;
  times.contact += simulation_->contact_seconds() - contact_before_;
  times.output += recording_->seconds();
  summary.timings = times.phases();
  summary.time_per_step = summary.steps > 0 ? times.steps / static_cast<double>(summary.steps) : 0.0;
  summary.warnings = log::warnings();
}

/// For those who look at a run that goes on.
void Run::report_progress() {
  RunSummary summary = summary_;
  summary.status = "running";
  describe_progress(summary);
  write_summary(summary_path(), summary);
  since_report_.restart();
}

void Run::finish() {
  if (failure_) {
    summary_.status = "failed";
    summary_.message = failure_->what();
  }
  if (summary_.status == "done") {
    describe_progress(summary_);
    judge_energy(summary_, model_->problem, simulation_->state());
  }
  describe_progress(summary_);
  if (contact_export_) summary_.contact_export = contact_export_->report();
  if (summary_.status == "done")
    summary_.expectations = check_expectations(input_, options_.output_directory, to_json(summary_));
  const auto attempt = [this](const auto& write) {
    try {
      write();
    } catch (const Error&) {
      // What has failed first is what a user must hear, here and in the summary, if there is room for that.
      if (!failure_) throw;
    }
  };
  attempt([this] { recording_->flush(); });
  attempt([this] { write_summary(summary_path(), summary_); });
}

}  // namespace ricochet
