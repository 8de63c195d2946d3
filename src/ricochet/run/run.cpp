#include "ricochet/run/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

#include "ricochet/base/log.hpp"
#include "ricochet/base/run_name.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/line_checksums.hpp"
#include "ricochet/io/rank_checkpoints.hpp"
#include "ricochet/run/old_run.hpp"
#include "ricochet/run/run_description.hpp"
#include "ricochet/run/run_identity.hpp"
#include "ricochet/solver/stage/memory_estimate.hpp"

namespace ricochet {

namespace {

/// Interval, in seconds, at which summary.json reports the progress of a run.
constexpr double report_interval = 2.0;
/// Number of dofs from which the start of a run takes seconds and is reported.
constexpr Index large_body = 20000;

/// Checks early that contact problems can be exported: a run of hours must not end because its last step cannot be
/// written.
void check_export(const Case& input, const RunOptions& options, long steps) {
  if (options.export_contact.empty()) return;
  if (input.time.adaptive)
    throw Error(ErrorKind::usage,
                "--export-contact: adaptive steps are not supported, since some of them are repeated; set time.step to "
                "a number");
  for (std::size_t i = 0; i < input.contacts.size(); ++i) {
    if (!(input.contacts[i].friction_bound > 0.0)) continue;
    throw Error(
        ErrorKind::invalid_input,
        fmt::format(
            "{}: contact problems with a friction_bound cannot be exported: FCLib files support Coulomb's law only",
            input.where(fmt::format("contact.{}.friction_bound", i)).text()));
  }
  const auto& requested = options.export_contact;
  const bool some = std::ranges::any_of(requested, [&](const StepRange& r) { return r.first <= steps; });
  const bool all = std::ranges::all_of(requested, [&](const StepRange& r) { return r.last <= steps; });
  if (!some)
    throw Error(ErrorKind::usage, fmt::format("--export-contact: the run has only {}", counted(steps, "step")));
  if (!all)
    log::warning(fmt::format("--export-contact: the run has {}; later ones are ignored", counted(steps, "step")));
}

}  // namespace

Run::Run(Session& session, const RunOptions& options)
    : session_(session),
      input_(session.input()),
      options_(options),
      ranks_(*options.ranks),
      directory_(options.output_directory, *options.ranks),
      steps_(session.steps()),
      reading_warning_count_(std::ptrdiff_t(session.warnings().size())),
      at_interruption_([this] { end_on_interruption(); }) {}

void Run::begin() {
  // Many quiet runs may execute at once; their warnings need a name.
  log::set_run_name(options_.quiet ? options_.output_directory : "", input_.path);
  check_export(input_, options_, steps_);
  ranks_.run_collectively([&] {
    if (ranks_.is_first()) refuse_overwriting_inputs(directory_, options_, input_);
  });
  if (options_.resume) {
    ranks_.run_collectively([&] { is_already_complete_ = is_complete(); });
    if (is_already_complete_) return;
    find_checkpoint();
  } else if (!options_.force) {
    ranks_.run_collectively([&] {
      if (ranks_.is_first()) refuse_old_run(directory_, options_);
    });
  }
  begin_session();
  open_files();
  progress_.emplace(input_.time.adaptive ? 0 : steps_, input_.time.end, options_.quiet || !ranks_.is_first(),
                    session_.state().step, session_.state().time);
  since_checkpoint_.restart();
}

RunSummary Run::finish() {
  if (is_already_complete_) return summary_;
  if (!has_ended_) {  // a program has stopped stepping
    if (!session_.at_end()) {
      interrupt("ended by the program");
    } else {
      end_steps();
    }
  }
  write_end();
  if (failure_) throw Error(*failure_);
  return summary_;
}

/// Returns true if the run in the directory is complete, so that nothing is left to do.
bool Run::is_complete() {
  std::optional<RunSummary> before = find_intact_summary(options_.output_directory);
  if (!before) return false;
  summary_ = std::move(*before);
  has_matching_summary_ = true;
  require_same_case(input_, summary_.version, summary_.parameters, options_.output_directory);
  if (input_.time.adaptive) {
    if (input_.time.end < summary_.end_time) refuse_earlier_end(summary_.end_time);
  } else if (steps_ < summary_.steps) {
    refuse_earlier_end(double(summary_.steps) * input_.time.step);
  }
  if (summary_.status != "done") return false;
  was_complete_ = true;
  if (input_.time.adaptive ? input_.time.end > summary_.end_time : steps_ > summary_.all_steps) return false;
  log::info(fmt::format("{}: this run is complete; there is nothing to resume", options_.output_directory));
  if (!options_.export_contact.empty())
    log::warning("--export-contact: the run is complete, so nothing more is exported; repeat it with --force");
  if (ranks_.is_first())
    summary_.expectations = check_expectations(input_, options_.output_directory, to_json(summary_));
  return true;
}

void Run::find_checkpoint() {
  const std::string& directory = options_.output_directory;
  ranks_.run_collectively([&] { require_ranks_of_checkpoints(directory, ranks_.size()); });
  snapshot_ = ranks_.are_several() ? newest_rank_checkpoint(ranks_, directory) : newest_checkpoint(directory);
  ranks_.run_collectively([&] { check_snapshot(); });
}

void Run::check_snapshot() {
  if (snapshot_) {
    require_same_case(input_, *snapshot_, options_.output_directory);
    const double reached = snapshot_->real("state.time");
    if (input_.time.adaptive ? input_.time.end < reached - input_.time.smallest
                             : steps_ < long(snapshot_->integer("state.step")))
      refuse_earlier_end(reached);
    if (ranks_.is_first()) require_same_files(options_.output_directory, *snapshot_);
    if (!options_.resume_load && Session::is_steered(*snapshot_)) {
      throw Error(ErrorKind::invalid_input,
                  fmt::format("{}: cannot be resumed here: a program sets loads or moves obstacles during this run "
                              "(Session::set_load, set_obstacle_velocity), and without it the last load and motion "
                              "would persist; resume it with that program",
                              options_.output_directory));
    }
  } else if (!checkpoint_files(options_.output_directory).empty() || has_rank_checkpoints(options_.output_directory)) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: cannot be resumed: no checkpoint can be read; start anew with --force",
                            options_.output_directory));
  } else if (was_complete_) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: this run is complete and cannot continue to a later time.end: the checkpoint of its "
                            "end is missing; start anew with --force",
                            options_.output_directory));
  } else if (const auto results = directory_.results(); !has_matching_summary_ && !results.empty()) {
    throw Error(
        ErrorKind::file_access,
        fmt::format("{}: cannot be resumed: there are results ({}), but neither a checkpoint nor a summary.json that "
                    "describes the run; choose another directory with -o, or start anew with --force",
                    options_.output_directory, std::filesystem::path(results.front()).filename().string()));
  } else {
    log::info(fmt::format("{}: there is no checkpoint; the run starts from the beginning", options_.output_directory));
  }
}

void Run::refuse_earlier_end(double reached) const {
  throw Error(ErrorKind::invalid_input,
              fmt::format("{}: time.end = {:.9g} is before t = {:.9g}, which the run in {} has already reached; set a "
                          "later end, start anew in another directory (-o), or overwrite that run (--force)",
                          input_.where("time.end").text(), input_.time.end, reached, options_.output_directory));
}

void Run::begin_session() {
  // The snapshot already holds the warnings of reading the case.
  const auto& all = session_.warnings();
  const std::vector<std::string> resume_warnings(all.begin() + reading_warning_count_, all.end());
  BuildTimes build;
  session_.build(&build);
  times_.add_build(build);
  check_expected_quantities(input_, session_.model());
  report_size();
  const auto built = std::ptrdiff_t(session_.warnings().size());
  Timer timer;
  begin_simulation();
  times_.add_start(timer.seconds(), session_.simulation().methods());
  summary_ = describe_run(input_, session_.model(), session_.scheme(), session_.simulation());
  const std::string& saved_path = options_.case_path.empty() ? input_.path : options_.case_path;
  summary_.case_path = std::filesystem::absolute(saved_path).lexically_normal().string();
  summary_.settings = options_.settings;
  stopping_points_.emplace();  // the steps are about to begin
  if (snapshot_) {
    // The snapshot already holds the warnings of building the model.
    std::vector<std::string> warnings = snapshot_->texts("run.warnings");
    warnings.insert(warnings.end(), resume_warnings.begin(), resume_warnings.end());
    // The end may have been moved since.
    std::erase_if(warnings, [](const std::string& warning) { return warning.starts_with(end_warning); });
    for (auto warning = session_.warnings().begin() + built; warning != session_.warnings().end(); ++warning) {
      if (std::ranges::find(warnings, *warning) == warnings.end()) warnings.push_back(*warning);
    }
    session_.warnings_ = std::move(warnings);
    const Snapshot::Integers& resumed_at = snapshot_->integers("run.resumed_at");
    summary_.resumed_at.assign(resumed_at.begin(), resumed_at.end());
    summary_.resumed_at.push_back(session_.simulation().state().step);
    summary_.checkpoint_step = session_.simulation().state().step;
    times_.persist(snapshot_->loader("run.times"));
    newton_.persist(snapshot_->loader("run.newton"));
    log::info("resumed after " + step_in_words());
  } else {
    const std::lock_guard files(files_);
    ranks_.run_collectively([&] {
      if (ranks_.is_first()) replace_old_run(directory_, options_, summary_);
    });
    reported_ = summary_;
  }
  warn_of_end(input_.time);
}

/// Opens the files. Like an error of a step, an error here is reported in the summary.
void Run::open_files() {
  const std::lock_guard files(files_);
  try {
    start_recording();
  } catch (const Error& problem) {
    if (snapshot_) throw;  // the run in the directory is unchanged
    summary_.status = "failed";
    summary_.message = problem.what();
    summary_.steps = session_.simulation().state().step;
    try {
      write_own_summary(summary_);
    } catch (const Error&) {  // the first error is the one to report
    }
    throw;
  }
}

/// Returns the number of factor entries of the whole body, excluding subdomains, which come and go and differ between
/// processes: the choice of states that are searched for the largest stress depends on this number.
std::size_t Run::entries_of_whole_body() const {
  const std::vector<ChosenMethod>& methods = session_.simulation().methods();
  const bool is_factored =
      std::ranges::all_of(methods, [](const ChosenMethod& chosen) { return chosen.method == SolverMethod::direct; });
  return is_factored && !ranks_.are_several() ? session_.simulation().factor_entries() : 0;
}

void Run::start_recording() {
  const ContactProvenance provenance = describe_provenance(input_, summary_);
  if (!options_.export_contact.empty())
    contact_export_.emplace(options_.export_contact, export_directory(options_), provenance);
  failure_bundle_.emplace(options_.output_directory, provenance);
  session_.simulation().observe_contact([this](const ContactProblem& problem, const ContactSolution& solution) {
    if (!solution.solved()) failure_bundle_->write_problem(problem, solution, session_.simulation().state().step + 1);
    if (contact_export_) contact_export_->write(problem, solution);
  });
  recording_.emplace(input_, session_.model(), session_.scheme(), session_.simulation().state(),
                     options_.output_directory, steps_, entries_of_whole_body(), snapshot_ ? &*snapshot_ : nullptr);
  if (!snapshot_) recording_->record(session_.simulation().state(), session_.simulation().account());
  // Only now is it certain that the files of the run are as it left them.
  ranks_.run_collectively([&] {
    if (snapshot_ && ranks_.is_first()) remove_files(directory_.leftover_files(session_.simulation().state().step));
  });
  snapshot_.reset();
  contact_before_ = session_.simulation().contact_seconds();
  traffic_before_ = traffic();
  first_step_ = session_.simulation().state().step;
  report_progress();
}

void Run::begin_simulation() {
  if (snapshot_) {
    session_.resume(*snapshot_);
  } else {
    refuse_bodies_inside_obstacles(session_.input(), session_.model());
    session_.start();
  }
}

void Run::enter_impulse(const Vector& impulse) { recording_->enter_impulse(session_.state(), impulse); }

void Run::write_checkpoint_now() {
  if (is_already_complete_ || has_ended_) return;
  const std::lock_guard files(files_);
  write_checkpoint();
  report_progress();
}

bool Run::take_step() {
  if (is_already_complete_ || has_ended_) return false;
  try {
    if (!session_.at_end() && advance()) return true;
    end_steps();
  } catch (const Error& problem) {
    // An error on one rank alone ends all ranks at once: the others are still in the step and do not respond.
    constexpr double patience = 1.5;
    if (ranks_.are_several() && !ranks_.all_arrive(patience)) throw;
    failure_ = problem;
    if (problem.kind() == ErrorKind::not_converged && !ranks_.are_several()) write_failure_bundle(step_);
  }
  has_ended_ = true;
  return false;
}

/// Computes and records a step. Returns false if a signal requests the end.
bool Run::advance() {
  // A signal that any rank has received counts.
  const int own_signal = options_.stop_signal ? options_.stop_signal() : 0;
  if (const int signal = int(ranks_.maximum(own_signal)); signal != 0) {
    stop(signal);
    return false;
  }
  Simulation& simulation = session_.simulation();
  if (is_near_end()) write_end_checkpoint();
  keep_state_before_step();
  const Timer timer;
  step_ = simulation.state().step + 1;
  if (log::enabled(log::Level::debug))
    log::debug(fmt::format("step {}, t = {:.9g}", step_, simulation.state().time + session_.scheme().step()));
  if (contact_export_) contact_export_->begin_step(step_);
  simulation.advance([&](const State& state) { recording_->enter_part(state, simulation.account()); });
  step_seconds_ = timer.seconds();
  times_.steps += step_seconds_;
  failure_bundle_->remove_problem();
  if (newton_.enter_step(simulation.state().newton_iterations, step_seconds_)) warn_of_many_iterations();
  const std::lock_guard files(files_);
  recording_->record(simulation.state(), simulation.account());
  progress_->update(simulation.state().step, simulation.state().time);
  const OutputSection& output = input_.output;
  const bool checkpoint_is_due =
      !is_near_end() && ((output.checkpoint_every > 0 && simulation.state().step % output.checkpoint_every == 0) ||
                         (output.checkpoint_seconds > 0.0 && since_checkpoint_.seconds() >= output.checkpoint_seconds));
  // The clock of the first rank decides.
  std::array<double, 2> due{ranks_.is_first() && checkpoint_is_due ? 1.0 : 0.0,
                            ranks_.is_first() && since_report_.seconds() >= report_interval ? 1.0 : 0.0};
  ranks_.sum(due);
  if (!session_.at_end() && due[0] > 0.0) write_checkpoint();
  if (due[1] > 0.0) report_progress();
  return true;
}

/// Returns true if the end of the run has shortened the next adaptive step.
bool Run::is_near_end() {
  const StepControl* const control = session_.simulation().control();
  return control != nullptr && control->is_shortened_by_end();
}

/// Writes the checkpoint from which the run can go on to a later end: the steps up to it do not depend on the end.
void Run::write_end_checkpoint() {
  const bool is_required = input_.output.checkpoint_every > 0 || input_.output.checkpoint_seconds > 0.0;
  if (!is_required || has_end_checkpoint_) return;
  const std::lock_guard files(files_);
  if (summary_.checkpoint_step != session_.state().step) write_checkpoint();
  has_end_checkpoint_ = true;
}

/// Warns once per run. (With a divided body the first process would have to build the whole body anew.)
void Run::warn_of_many_iterations() {
  if (ranks_.are_several()) return;
  const double now = session_.simulation().state().time;
  log::warning(many_iterations_text(newton_, try_explicit(input_), now, std::max(0.0, input_.time.end - now),
                                    session_.scheme().step()));
}

/// Announces long preparations and large files in advance.
void Run::report_size() const {
  constexpr double large_files = 100e6;
  const Model& model = session_.model();
  const bool is_large = model.sizes.dofs >= large_body;
  if (is_large) {
    const double rows =
        (model.problem.contact.has_friction() ? model.mesh.dimension : 1) * double(model.sizes.contact_points);
    log::info(
        fmt::format("{}, {}; preparing the steps, which need about {} of memory with iterations and more with a "
                    "factorization, and {} if all contact points are pressed",
                    counted(model.sizes.dofs, "dof"), counted(model.sizes.contact_points, "contact point"),
                    size_text(memory_of_iterations(model.sizes.dofs)), size_text(memory_of_contact(rows))));
  }
  if (snapshot_) return;  // a resumed run writes as it began
  const OutputEstimate files = estimate_output(input_, model);
  if (is_large || files.results_bytes + files.history_bytes >= large_files) log::info(output_text(files));
}

/// Writes the final results once all steps are computed.
void Run::end_steps() {
  if (!session_.at_end()) return;
  write_end_checkpoint();  // before anything that only the end of a run writes
  const std::lock_guard files(files_);
  before_step_.reset();
  recording_->record_end(session_.state(), session_.simulation().account());
}

}  // namespace ricochet
