#include "ricochet/case/run_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <optional>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/case/model.hpp"
#include "ricochet/case/recording.hpp"
#include "ricochet/case/run_description.hpp"
#include "ricochet/case/run_identity.hpp"
#include "ricochet/case/run_judgement.hpp"
#include "ricochet/case/run_times.hpp"
#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/failure_bundle.hpp"
#include "ricochet/io/progress.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/simulation/simulation.hpp"

namespace ricochet {

namespace {

/// summary.json says how far a run is this often, in seconds.
constexpr double report_interval = 2.0;
/// Dofs from which on the start of a run takes seconds, and says so.
constexpr Index large_body = 20000;

std::string export_directory(const RunOptions& options) {
  const bool elsewhere = !options.export_contact.empty() && !options.export_contact_to.empty();
  return elsewhere ? options.export_contact_to : (std::filesystem::path(options.output_directory) / "contact").string();
}

/// Fails early: a run of hours should not end because its last step cannot be written.
void check_export(const Case& input, const RunOptions& options, long steps) {
  if (options.export_contact.empty()) return;
  for (std::size_t i = 0; i < input.contacts.size(); ++i) {
    if (!(input.contacts[i].friction_bound > 0.0)) continue;
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: contact problems with a friction_bound cannot be exported: FCLib's files state "
                            "Coulomb's law only",
                            input.where(fmt::format("contact.{}.friction_bound", i)).text()));
  }
  const auto& asked = options.export_contact;
  const bool some = std::any_of(asked.begin(), asked.end(), [&](const StepRange& r) { return r.first <= steps; });
  const bool all = std::all_of(asked.begin(), asked.end(), [&](const StepRange& r) { return r.last <= steps; });
  if (!some) throw Error(ErrorKind::usage, fmt::format("--export-contact: the run has {} steps only", steps));
  if (!all) log::warning(fmt::format("--export-contact: the run has {} steps; those after it are left out", steps));
}

void refuse_old_run(const RunDirectory& directory, const RunOptions& options) {
  std::vector<std::string> results = directory.results();
  if (results.empty()) results = directory.left_behind(-1);
  if (!results.empty()) {
    throw Error(ErrorKind::file_access,
                fmt::format("{}: holds a run already ({}); choose another directory with -o, go on with that run with "
                            "--resume, or overwrite it with --force",
                            options.output_directory, std::filesystem::path(results.front()).filename().string()));
  }
  const std::string contact = export_directory(options);
  if (exported_contact_problems(contact).empty()) return;
  throw Error(ErrorKind::file_access,
              fmt::format("{}: holds contact problems of a run already; choose another directory, or overwrite them "
                          "with --force",
                          contact));
}

/// Takes away what an earlier run left (this one may write no fields) and says which run is here now. Called when the
/// new run is ready to start, so that a case that is refused costs nothing. Whenever it is interrupted, summary.json
/// describes a run that --resume may start from its beginning, or one that is there to its end.
void replace_old_run(const RunDirectory& directory, const RunOptions& options, RunSummary summary) {
  const std::string contact = export_directory(options);
  const std::vector<std::string> problems = exported_contact_problems(contact);
  const std::string summary_path = directory.file("summary.json");
  remove_files(directory.left_behind(-1));
  summary.status = "running";
  write_durably(summary_path, to_json(summary));
  std::vector<std::string> results = directory.results();
  std::erase(results, summary_path);
  remove_files(results);
  remove_files(problems);
  std::error_code problem;
  if (!problems.empty() && std::filesystem::is_empty(contact, problem)) std::filesystem::remove(contact, problem);
}

/// A run from its directory to its summary.
class Run {
 public:
  Run(const Case& input, const RunOptions& options)
      : input_(input), options_(options), directory_(options.output_directory), steps_(step_count(input.time)) {}

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

RunSummary Run::go() {
  if (options_.resume) {
    if (is_complete()) return summary_;
    find_checkpoint();
  } else if (!options_.force) {
    refuse_old_run(directory_, options_);
  }
  begin();
  open_files();
  take_steps();
  finish();
  if (failure_) throw Error(*failure_);
  return summary_;
}

/// The run in the directory has come to its end: nothing to do.
bool Run::is_complete() {
  if (!std::filesystem::exists(summary_path())) return false;
  try {
    summary_ = read_summary(summary_path());
  } catch (const Error&) {
    return false;  // a summary is not waited for until it is on the disk: checkpoints are
  }
  if (summary_.parameters.empty()) return false;
  knows_what_ran_ = true;
  require_same_case(input_, summary_.version, summary_.parameters, options_.output_directory);
  if (summary_.status != "done") return false;
  log::info(fmt::format("{}: this run is complete, there is nothing to resume", options_.output_directory));
  if (!options_.export_contact.empty())
    log::warning("--export-contact: the run is complete, nothing more is exported; make it again with --force");
  summary_.expectations = check_expectations(input_, options_.output_directory, to_json(summary_));
  return true;
}

void Run::find_checkpoint() {
  snapshot_ = newest_checkpoint(options_.output_directory);
  if (snapshot_) {
    require_same_case(input_, *snapshot_, options_.output_directory);
  } else if (!checkpoint_files(options_.output_directory).empty()) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: cannot be resumed: no checkpoint can be read; start anew with --force",
                            options_.output_directory));
  } else if (const std::vector<std::string> results = directory_.results(); !knows_what_ran_ && !results.empty()) {
    throw Error(
        ErrorKind::file_access,
        fmt::format("{}: cannot be resumed: there are results ({}), but neither a checkpoint nor a summary.json "
                    "that says what ran; choose another directory with -o, or start anew with --force",
                    options_.output_directory, std::filesystem::path(results.front()).filename().string()));
  } else {
    log::info(fmt::format("{}: there is no checkpoint, the run starts from the beginning", options_.output_directory));
  }
}

void Run::begin() {
  const std::vector<std::string> resume_warnings = log::warnings();
  BuildTimes build;
  model_ = build_model(input_, &build);
  times_.add_build(build);
  check_expected_columns(input_, *model_);
  if (model_->problem.dof_count() >= large_body) {
    log::info(fmt::format("{} dofs, {} contact points; preparing the steps", model_->problem.dof_count(),
                          model_->problem.contact.size()));
  }
  std::string difference;
  if (snapshot_) difference = compare_model(input_, *model_, *snapshot_);
  Timer timer;
  scheme_ = make_scheme(input_.time);
  begin_simulation();
  times_.add_start(timer.seconds(), simulation_->methods());
  if (std::abs(static_cast<double>(steps_) * input_.time.step - input_.time.end) > 1e-9 * input_.time.end) {
    log::info(fmt::format("time.end is not a whole number of steps: the run ends at t = {:.9g}",
                          static_cast<double>(steps_) * input_.time.step));
  }
  summary_ = describe_run(input_, *model_, *scheme_, *simulation_);
  if (snapshot_) {
    // Those of the model have been said and remembered already.
    std::vector<std::string> warnings = snapshot_->texts("run.warnings");
    warnings.insert(warnings.end(), resume_warnings.begin(), resume_warnings.end());
    log::set_warnings(std::move(warnings));
    if (!difference.empty()) log::warning(difference);
    const Snapshot::Integers& resumed_at = snapshot_->integers("run.resumed_at");
    summary_.resumed_at.assign(resumed_at.begin(), resumed_at.end());
    summary_.resumed_at.push_back(simulation_->state().step);
    summary_.checkpoint_step = simulation_->state().step;
    times_.load(*snapshot_, "run.times");
    remove_files(directory_.left_behind(simulation_->state().step));
    log::info(fmt::format("resumed after step {} of {}", simulation_->state().step, steps_));
  } else {
    replace_old_run(directory_, options_, summary_);
  }
}

/// An error here is told in the summary, as one of a step is.
void Run::open_files() {
  try {
    start_recording();
  } catch (const Error& problem) {
    summary_.status = "failed";
    summary_.message = problem.what();
    summary_.steps = simulation_->state().step;
    try {
      write_summary(summary_path(), summary_);
    } catch (const Error&) {  // what has failed first is what a user must hear
    }
    throw;
  }
}

void Run::start_recording() {
  const ContactProvenance provenance = describe_provenance(input_, summary_);
  if (!options_.export_contact.empty())
    contact_export_.emplace(options_.export_contact, export_directory(options_), provenance);
  failure_bundle_.emplace(options_.output_directory, provenance);
  simulation_->observe_contact([this](const ContactProblem& problem, const ContactSolution& solution) {
    if (!solution.solved()) failure_bundle_->take_problem(problem, solution, simulation_->state().step + 1);
    if (contact_export_) contact_export_->write(problem, solution);
  });
  recording_.emplace(input_, *model_, *scheme_, simulation_->state(), options_.output_directory, steps_,
                     snapshot_ ? &*snapshot_ : nullptr);
  if (!snapshot_) recording_->record(simulation_->state(), simulation_->account());
  snapshot_.reset();
  contact_before_ = simulation_->contact_seconds();
  report_progress();
}

void Run::begin_simulation() {
  if (snapshot_) {
    simulation_.emplace(model_->problem, *scheme_, *snapshot_, step_solver_options(input_));
  } else {
    simulation_.emplace(model_->problem, *scheme_, model_->initial, step_solver_options(input_));
  }
}

/// All steps, recorded, until the end, an error or a signal.
void Run::take_steps() {
  Simulation& simulation = *simulation_;
  Progress progress(steps_, options_.quiet, simulation.state().step);
  since_checkpoint_.restart();
  const auto checkpoint_is_due = [&] {
    const OutputSection& output = input_.output;
    return (output.checkpoint_every > 0 && simulation.state().step % output.checkpoint_every == 0) ||
           (output.checkpoint_seconds > 0.0 && since_checkpoint_.seconds() >= output.checkpoint_seconds);
  };
  long step = simulation.state().step;
  try {
    while (simulation.state().step < steps_) {
      if (const int signal = options_.stop_signal ? options_.stop_signal() : 0; signal != 0) return stop(signal);
      const Timer timer;
      ++step;
      if (log::enabled(log::Level::debug))
        log::debug(fmt::format("step {}, t = {:.9g}", step, static_cast<double>(step) * scheme_->step()));
      if (contact_export_) contact_export_->begin_step(step);
      simulation.advance();
      times_.steps += timer.seconds();
      recording_->record(simulation.state(), simulation.account());
      progress.update(simulation.state().step, simulation.state().time);
      if (simulation.state().step < steps_ && checkpoint_is_due()) write_checkpoint();
      if (since_report_.seconds() >= report_interval) report_progress();
    }
    recording_->flush();
  } catch (const Error& problem) {
    failure_ = problem;
    if (problem.kind() == ErrorKind::not_converged) write_failure_bundle(step);
  }
}

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

}  // namespace

StepSolverOptions step_solver_options(const Case& input) {
  StepSolverOptions options;
  if (input.solver.method == "direct") options.method = SolverMethod::direct;
  if (input.solver.method == "iterative") options.method = SolverMethod::iterative;
  options.tolerance = input.solver.tolerance;
  options.memory = 1e9 * input.solver.memory.value_or(0.0);
  options.all_points = input.solver.contact_points == "all";
  return options;
}

long step_count(const TimeSection& time) {
  // An end that is a whole number of steps to rounding is that number of steps.
  return std::max(1L, static_cast<long>(std::ceil(time.end / time.step * (1.0 - 1e-12))));
}

RunSummary run_case(const Case& input, const RunOptions& options) {
  log::clear_warnings();
  check_export(input, options, step_count(input.time));
  return Run(input, options).go();
}

}  // namespace ricochet
