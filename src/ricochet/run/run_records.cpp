#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>

#include "ricochet/base/log.hpp"
#include "ricochet/base/memory.hpp"
#include "ricochet/base/run_name.hpp"
#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/rank_checkpoints.hpp"
#include "ricochet/run/run.hpp"
#include "ricochet/run/run_identity.hpp"
#include "ricochet/run/run_judgement.hpp"

namespace ricochet {

namespace {

/// Longest wait for the files of the run to be at rest when it ends in the middle of a step.
constexpr std::chrono::milliseconds longest_wait{300};
/// Duration of a step, in seconds, from which the state before it is kept, provided that this takes no more than the
/// given fraction of the step.
constexpr double long_step = 0.5, snapshot_share = 0.05;

void merge(const UnwatchedPenetration& other, std::vector<UnwatchedPenetration>& found) {
  const auto same = std::ranges::find_if(found, [&](const UnwatchedPenetration& own) {
    return own.obstacle == other.obstacle && own.bodies == other.bodies && own.passed_through == other.passed_through;
  });
  if (same == found.end()) {
    found.push_back(other);
    return;
  }
  const double first_time = std::min(same->first_time, other.first_time);
  if (other.depth > same->depth) *same = other;
  same->first_time = first_time;
}

/// Keeps the larger share; shares refer to the contact force on one process.
void merge(const UnsettledContact& other, std::vector<UnsettledContact>& contacts) {
  const auto same =
      std::ranges::find_if(contacts, [&](const UnsettledContact& own) { return own.contact == other.contact; });
  if (same == contacts.end()) {
    contacts.push_back(other);
  } else if (other.share > same->share) {
    *same = other;
  }
}

void merge(const ContactBeyondRim& other, std::vector<ContactBeyondRim>& rims) {
  const auto same = std::ranges::find_if(
      rims, [&](const ContactBeyondRim& own) { return own.group == other.group && own.obstacle == other.obstacle; });
  if (same == rims.end()) {
    rims.push_back(other);
  } else if (other.time < same->time) {
    *same = other;
  }
}

/// Merges the findings of another rank into a summary: the deepest penetration of each kind, doubtful contacts, and the
/// largest stress.
void merge_findings(const RunSummary& other, RunSummary& summary) {
  for (const UnwatchedPenetration& each : other.penetration.found) merge(each, summary.penetration.found);
  for (const ContactBeyondRim& each : other.penetration.rims) merge(each, summary.penetration.rims);
  for (const UnsettledContact& each : other.unsettled) merge(each, summary.unsettled);
  if (!other.peak_stress) return;
  if (!summary.peak_stress || other.peak_stress->peak.von_mises > summary.peak_stress->peak.von_mises)
    summary.peak_stress = other.peak_stress;
}

}  // namespace

/// Writes the state before the failed step (or after it, if its results are not available) and its contact problem; the
/// message states where they are.
void Run::write_failure_bundle(long step) {
  Snapshot snapshot;
  session_.save(snapshot);
  try {
    const std::string note = failure_bundle_->write(step, snapshot, failure_->what());
    failure_ = Error(failure_->kind(), fmt::format("{}\n{}", failure_->what(), note));
  } catch (const Error& problem) {
    log::warning(problem.what());
  }
}

void Run::stop(int signal) {
  interruption::reach_stopping_point();
  interrupt(fmt::format("stopped by SIG{}", sigabbrev_np(signal)));
}

std::string Run::step_in_words() {
  const State& state = session_.simulation().state();
  if (input_.time.adaptive)
    return fmt::format("step {} (t = {:.6g} of {:.6g})", state.step, state.time, input_.time.end);
  return fmt::format("step {} of {}", state.step, steps_);
}

void Run::interrupt(const std::string& how) {
  const std::lock_guard files(files_);
  write_checkpoint();
  // After the checkpoint: a resumed run removes these results again.
  recording_->record_end(session_.state(), session_.simulation().account());
  summary_.status = "interrupted";
  summary_.message = fmt::format("{} after {}; {} continues from there", how, step_in_words(),
                                 session_.is_steered()   ? "the program that steers the run"
                                 : !ranks_.are_several() ? "run --resume"
                                                         : run_command(ranks_.size()) + " --resume");
}

/// Runs on another thread while the run is in the middle of something that takes too long. The files on the disk always
/// suffice for --resume; if they are at rest, more of the run is kept.
void Run::end_on_interruption() {
  if (ranks_.are_several()) return;  // the other ranks are busy as well
  const std::unique_lock files(files_, longest_wait);
  if (!files || !reported_) return;
  RunSummary& summary = *reported_;
  summary.status = "interrupted";
  summary.message = fmt::format("stopped during a step or before the first one; run --resume {}",
                                before_step_ ? "continues from the state before that step"
                                             : "continues from the last checkpoint, if there is one");
  if (before_step_) {
    summary.steps = summary.checkpoint_step = long(before_step_->integer("state.step"));
    ricochet::write_checkpoint(options_.output_directory, summary.checkpoint_step, *before_step_);
  }
  write_summary(summary_path(), summary);
  interruption::write_to_stderr(fmt::format("ricochet: {}\n", log::with_run_name(summary.message)).c_str());
}

/// Keeps the state before a step if steps take longer than a user who stops the run should have to wait: a checkpoint
/// of that state can then be written at any time.
void Run::keep_state_before_step() {
  if (ranks_.are_several()) return;
  const bool is_due = step_seconds_ >= long_step && snapshot_seconds_ <= snapshot_share * step_seconds_;
  if (!is_due && !before_step_) return;
  const std::lock_guard files(files_);
  before_step_.reset();
  if (!is_due) return;
  const Timer timer;
  before_step_ = take_snapshot();
  snapshot_seconds_ = timer.seconds();
}

RunTimes Run::times_until_now() const {
  RunTimes times = times_;
  times.contact += session_.simulation().contact_seconds() - contact_before_;
  times.output += recording_->seconds();
  times.watch += recording_->watch_seconds();
  return times;
}

Snapshot Run::take_snapshot() {
  Snapshot snapshot;
  session_.save(snapshot);
  recording_->save(snapshot);
  times_until_now().persist(snapshot.saver("run.times"));
  newton_.persist(snapshot.saver("run.newton"));
  snapshot.save("run.warnings", session_.warnings());
  snapshot.save("run.case_path", summary_.case_path);
  snapshot.save("run.settings", Snapshot::Texts(summary_.settings));
  snapshot.save("run.resumed_at", Snapshot::Integers(summary_.resumed_at.begin(), summary_.resumed_at.end()));
  return snapshot;
}

void Run::write_checkpoint() {
  const Timer timer;
  const long step = session_.simulation().state().step;
  if (ranks_.are_several()) {
    write_rank_checkpoint(ranks_, options_.output_directory, step, take_snapshot());
  } else {
    ricochet::write_checkpoint(options_.output_directory, step, take_snapshot());
  }
  summary_.checkpoint_step = step;
  times_.checkpoints += timer.seconds();
  since_checkpoint_.restart();
}

void Run::describe_progress(RunSummary& summary) {
  recording_->describe(summary);
  summary.steered = session_.is_steered();
  summary.factor_entries = session_.simulation().factor_entries();
  const IterationCounts counts = session_.simulation().iteration_counts();
  const auto new_steps = double(std::max(1L, session_.simulation().state().step - first_step_));
  if (counts.schwarz_iterations > 0)
    summary.iterations =
        IterationReport{double(counts.schwarz_iterations) / new_steps, double(counts.gradients) / new_steps};
  summary.critical_step = session_.scheme().critical_step();
  summary.steps = session_.simulation().state().step;
  if (const StepControl* const control = session_.simulation().control()) {
    summary.adaptive = AdaptiveSteps{.tolerance = input_.time.tolerance, .time = control->time()};
    summary.adaptive->counts = control->counts();
    // The total number of steps is known only at the end.
    if (session_.at_end()) summary.all_steps = summary.steps;
  }
  const RunTimes times = times_until_now();
  summary.timings = times.phases();
  summary.processor_seconds = times.processor();
  summary.peak_memory = peak_memory();
  summary.time_per_step = summary.steps > 0 ? times.steps / double(summary.steps) : 0.0;
  gather_from_ranks(summary);
  summary.warnings = session_.warnings();
}

Traffic Run::traffic() const { return session_.model().problem.ranks->traffic() += ranks_.traffic(); }

void Run::describe_processes(RunSummary& summary) const {
  const Traffic now = traffic();
  const auto steps = double(std::max(1L, session_.simulation().state().step - first_step_));
  const auto most_per_step = [&](std::int64_t after, std::int64_t before) {
    return ranks_.maximum(double(after - before)) / steps;
  };
  const auto dofs = double(session_.model().problem.dof_count());
  summary.processes = ProcessReport{ranks_.size(),
                                    std::lround(ranks_.minimum(dofs)),
                                    std::lround(ranks_.maximum(dofs)),
                                    most_per_step(now.messages, traffic_before_.messages),
                                    most_per_step(now.bytes, traffic_before_.bytes),
                                    most_per_step(now.reductions, traffic_before_.reductions)};
}

/// Sums time and memory over all ranks; contact may be solved on other ranks than the first.
void Run::add_work_of_ranks(RunSummary& summary) const {
  std::array<double, 2> sums{double(summary.factor_entries), summary.processor_seconds};
  ranks_.sum(sums);
  summary.factor_entries = std::size_t(sums[0]);
  summary.processor_seconds = sums[1];
  summary.peak_memory = ranks_.maximum(summary.peak_memory);
  for (auto& [phase, seconds] : summary.timings) {
    if (phase == "contact_solver") seconds = ranks_.maximum(seconds);
  }
}

/// Gathers the findings of ranks in their parts of the body. The first rank issues the warnings, and those that several
/// ranks have, each with its own positions, only once.
void Run::gather_from_ranks(RunSummary& summary) {
  if (!ranks_.are_several()) return;
  describe_processes(summary);
  add_work_of_ranks(summary);
  summary.warnings = session_.warnings();
  for (const std::string& text : ranks_.gather_texts(ranks_.is_first() ? "" : to_json(summary))) {
    if (text.empty()) continue;
    const RunSummary other = summary_from_json(text, "the summary of another process");
    merge_findings(other, summary);
    for (const std::string& warning : other.warnings) {
      const std::vector<std::string>& reported = session_.warnings();
      if (std::ranges::none_of(reported, [&, form = message_pattern(warning)](const std::string& before) {
            return message_pattern(before) == form;
          }))
        log::warning(warning);
    }
  }
}

/// Writes the summary on the first rank.
void Run::write_own_summary(const RunSummary& summary) const {
  if (ranks_.is_first()) write_summary(summary_path(), summary);
}

/// Writes the progress of a run for its observers.
void Run::report_progress() {
  RunSummary summary = summary_;
  summary.status = "running";
  describe_progress(summary);
  ranks_.run_collectively([&] { write_own_summary(summary); });
  reported_ = std::move(summary);
  since_report_.restart();
}

void Run::write_end() {
  const std::lock_guard files(files_);
  reported_.reset();
  if (failure_) {
    summary_.status = "failed";
    summary_.message = failure_->what();
  }
  describe_progress(summary_);
  // An energy that is mere rounding has no meaningful parts.
  if (is_rounding_of_energy(summary_.energy_scale(), session_.model().problem, session_.simulation().state()))
    summary_.method_energy = MethodEnergy{};
  // A step that cannot be solved often ends a motion that has gained energy.
  const bool fails_to_converge = failure_ && failure_->kind() == ErrorKind::not_converged;
  if (summary_.status == "done" || fails_to_converge) {
    judge_energy(summary_, session_.scheme(), session_.model().problem, session_.simulation().state());
    judge_velocity_corrections(summary_, input_.solver.newton_tolerance, session_.model().problem,
                               session_.simulation().state());
    judge_unsettled(summary_);
    judge_sliding(summary_, session_.model().problem, session_.model().body);
    judge_strain(summary_, session_.model().body);
    judge_rotation_growth(summary_);
    summary_.warnings = session_.warnings();
  }
  if (contact_export_) summary_.contact_export = contact_export_->report();
  if (summary_.status == "done" && ranks_.is_first())
    summary_.expectations = check_expectations(input_, options_.output_directory, to_json(summary_));
  const auto attempt = [this](const auto& write) {
    try {
      write();
    } catch (const Error&) {
      // The first error is the one to report, here and, if there is room, in the summary.
      if (!failure_) throw;
    }
  };
  attempt([this] { ranks_.run_collectively([this] { recording_->flush(); }); });
  attempt([this] { write_own_summary(summary_); });
}

}  // namespace ricochet
