#include "ricochet/case/run_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/case/model.hpp"
#include "ricochet/io/history_file.hpp"
#include "ricochet/io/progress.hpp"
#include "ricochet/io/results_file.hpp"
#include "ricochet/simulation/simulation.hpp"
#include "ricochet/version.hpp"

namespace ricochet {

namespace {

/// Above this rotation, in rad, small strain no longer holds.
constexpr double rotation_limit = 0.1;
/// Above this one, results no longer resemble anything.
constexpr double large_rotation = 1.0;

/// What a run leaves in its directory.
constexpr const char* result_files[] = {"history.csv", "summary.json", "results.h5", "results.xdmf"};

std::string export_directory(const RunOptions& options) {
  const bool elsewhere = !options.export_contact.empty() && !options.export_contact_to.empty();
  return elsewhere ? options.export_contact_to : (std::filesystem::path(options.output_directory) / "contact").string();
}

void prepare_directory(const RunOptions& options) {
  namespace fs = std::filesystem;
  std::error_code problem;
  fs::create_directories(options.output_directory, problem);
  if (problem || !fs::is_directory(options.output_directory)) {
    throw Error(ErrorKind::file_access, fmt::format("{}: cannot make this directory: {}", options.output_directory,
                                                    problem ? problem.message() : "a file of that name is there"));
  }
  for (const char* name : result_files) {
    if (!options.force && fs::exists(fs::path(options.output_directory) / name)) {
      throw Error(ErrorKind::file_access,
                  fmt::format("{}: holds a run already ({}); choose another directory with -o, or "
                              "overwrite it with --force",
                              options.output_directory, name));
    }
  }
  const std::string contact = export_directory(options);
  if (!options.force && !exported_contact_problems(contact).empty()) {
    throw Error(ErrorKind::file_access,
                fmt::format("{}: holds contact problems of a run already; choose another directory, or overwrite them "
                            "with --force",
                            contact));
  }
}

/// Takes away what an earlier run left (this one may write no fields). Called when the new run is ready to start, so
/// that a case that is refused costs nothing.
void remove_old_run(const RunOptions& options) {
  namespace fs = std::filesystem;
  const std::string contact = export_directory(options);
  std::vector<std::string> files = exported_contact_problems(contact);
  const bool had_contact = !files.empty();
  for (const char* name : result_files) files.push_back((fs::path(options.output_directory) / name).string());
  std::error_code problem;
  for (const std::string& file : files) {
    fs::remove(file, problem);
    if (problem) throw Error(ErrorKind::file_access, fmt::format("{}: cannot be removed: {}", file, problem.message()));
  }
  if (had_contact && fs::is_empty(contact, problem)) fs::remove(contact, problem);
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

ContactProvenance provenance(const Case& input, const RunSummary& summary) {
  ContactProvenance result;
  result.title = input.title.empty() ? std::filesystem::path(input.path).stem().string() : input.title;
  result.dimension = summary.dimension;
  result.step_size = summary.step;
  std::string overrides;
  for (const std::string& key : summary.overrides) {
    const auto value = input.values.find(key);
    overrides += fmt::format(" {}{}", key, value != input.values.end() ? "=" + value->second : "");
  }
  result.origin = fmt::format("Ricochet {}, case {}{}{}; scheme {}", summary.version, input.path,
                              overrides.empty() ? "" : " with --set", overrides, summary.scheme);
  if (summary.scheme == "newmark")
    result.origin += fmt::format(" (beta {:g}, gamma {:g})", input.time.beta, input.time.gamma);
  result.origin += fmt::format(", step size {:g}, mass {}, multipliers", summary.step, summary.mass);
  std::vector<std::string> spaces;
  for (const ContactSection& contact : input.contacts) {
    if (std::find(spaces.begin(), spaces.end(), contact.multipliers) == spaces.end())
      spaces.push_back(contact.multipliers);
  }
  for (const std::string& space : spaces) result.origin += " " + space;
  result.origin += fmt::format(", displacement of degree {}, {} dofs.", summary.degree, summary.dofs);
  return result;
}

RunSummary describe(const Case& input, const Model& model, const Scheme& scheme, const Simulation& simulation) {
  RunSummary summary;
  summary.case_file = input.path;
  summary.title = input.title;
  summary.version = version;
  summary.scheme = input.time.scheme;
  summary.mass = input.mass.type;
  summary.overrides = input.overridden;
  summary.dimension = model.mesh.dimension;
  summary.degree = model.space.degree;
  summary.nodes = model.space.node_count();
  summary.cells = model.mesh.cell_count();
  summary.dofs = model.space.dof_count();
  summary.contact_points = model.problem.contact.size();
  summary.supported_dofs = model.problem.supports.size();
  summary.factor_entries = simulation.factor_entries();
  const std::vector<ChosenMethod>& methods = simulation.methods();
  const bool iterative = std::any_of(methods.begin(), methods.end(), [](const ChosenMethod& chosen) {
    return chosen.method == SolverMethod::iterative;
  });
  summary.solver = iterative ? "iterative" : "direct";
  summary.step = scheme.step();
  summary.end_time = input.time.end;
  summary.critical_step = scheme.critical_step();
  summary.energy_instant = scheme.energy_instant();
  summary.force_instant = scheme.force_instant();
  summary.contacts = describe_contacts(input);
  summary.probes = model.probes;
  for (Probe& probe : summary.probes) {
    const Vector at = model.space.nodes.col(probe.node);
    summary.probe_positions.emplace_back(at.data(), at.data() + at.size());
    probe.node = model.space.number[static_cast<std::size_t>(probe.node)];
  }
  return summary;
}

/// Everything that is written while a run goes on.
class Recording {
 public:
  Recording(const Case& input, const Model& model, const std::string& directory, long steps)
      : recorder_(model.problem, *model.rotation, model.probes),
        history_(directory + "/history.csv", recorder_.columns()),
        history_every_(input.output.history_every),
        fields_every_(input.output.fields_every.value_or(std::max(1L, (steps + 99) / 100))),
        steps_(steps) {
    if (fields_every_ > 0) results_.emplace(directory, model.space, model.problem);
  }

  void record(const State& state, EnergyAccount& account) {
    Timer timer;
    if (state.step % history_every_ == 0 || state.step == steps_) {
      const std::vector<double>& row = recorder_.row(state, account);
      check_finite(row);
      history_.write(row);
      digest_.add(row);
      watch_rotation(row);
    }
    if (results_ && (state.step % fields_every_ == 0 || state.step == steps_)) results_->write(state);
    if (since_flush_.seconds() > 1.0) {
      history_.flush();
      since_flush_.restart();
    }
    seconds_ += timer.seconds();
  }

  /// Completes the files and the summary.
  void close(RunSummary& summary) {
    history_.flush();
    if (results_) {
      results_->close();
      summary.frames = results_->frames();
    }
    summary.columns = recorder_.columns();
    summary.digests = digest_.columns();
  }

  [[nodiscard]] double seconds() const { return seconds_; }

 private:
  /// Energies are squares: they leave the range of numbers long before the displacement does.
  void check_finite(const std::vector<double>& row) const {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (std::isfinite(row[i])) continue;
      throw Error(ErrorKind::not_converged,
                  fmt::format("step {:.0f} (t = {:.9g}): {} is no longer finite, so the motion has grown beyond all "
                              "bounds; use a stable scheme or mass (newmark with mass \"equivalent\"), or a smaller "
                              "time.step",
                              row[0], row[1], recorder_.columns()[i]));
    }
  }

  void watch_rotation(const std::vector<double>& row) {
    if (rotation_warned_) return;
    const auto column =
        static_cast<std::size_t>(std::find(recorder_.columns().begin(), recorder_.columns().end(), "max_rotation") -
                                 recorder_.columns().begin());
    if (!(row[column] > rotation_limit)) return;
    rotation_warned_ = true;
    log::warning(
        fmt::format("at t = {:.6g} a cell has rotated by {:.3g} rad: above {} rad small strain no longer holds "
                    "(a turning body inflates); read what follows with care",
                    row[1], row[column], rotation_limit));
  }

  HistoryRecorder recorder_;
  HistoryWriter history_;
  std::optional<ResultsWriter> results_;
  HistoryDigest digest_;
  long history_every_;
  long fields_every_;
  long steps_;
  bool rotation_warned_ = false;
  Timer since_flush_;
  double seconds_ = 0.0;
};

/// What the account of energy says that a user should hear.
void judge_energy(const RunSummary& summary, const SemidiscreteProblem& problem, const State& state) {
  const double scale = summary.energy_scale();
  // A body that is merely displaced has no energy but the rounding of these terms: nothing to judge.
  const Vector magnitude = state.displacement.cwiseAbs();
  const double terms = magnitude.dot(problem.internal_force->tangent().cwiseAbs() * magnitude);
  if (scale <= 1e-14 * terms) return;
  const auto largest = [&](const char* column) {
    const ColumnDigest digest = summary.digest(column);
    return std::max(std::abs(digest.minimum), std::abs(digest.maximum));
  };
  if (largest("energy_residual") > 1e-8 * scale) {
    log::warning(fmt::format(
        "the energy account does not close: its residual reaches {:.2g} of the largest energy, by rounding{}; "
        "stiffnesses or densities that differ by many orders of magnitude, a Poisson's ratio at 1/2 or an "
        "extreme time.step are likely causes; do not trust this run to more digits than that",
        largest("energy_residual") / scale,
        summary.solver == "iterative" ? " or by solver.tolerance (make it smaller, or solver.method = \"direct\")"
                                      : ""));
  }
  if (summary.digest("contact_work").maximum > 0.01 * scale) {
    const bool best = (summary.scheme == "newmark" || summary.scheme == "semi-explicit") && problem.has_singular_mass();
    log::warning(
        fmt::format("contact forces have created energy: contact_work reaches {:.2g} of the largest energy; {}",
                    summary.digest("contact_work").maximum / scale,
                    best ? "take a time.step below the time in which a wave crosses a cell, and see that no body "
                           "starts inside an obstacle"
                         : "it comes from the time scheme: use newmark with mass \"equivalent\""));
  }
  if (summary.digest("friction_work").maximum > 0.01 * scale) {
    log::warning(fmt::format(
        "friction has created energy: friction_work reaches {:.2g} of the largest energy; it comes from the "
        "weights that {} gives to the forces at the two ends of a step: take a smaller time.step",
        summary.digest("friction_work").maximum / scale, summary.scheme));
  }
  if (summary.digest("max_rotation").maximum > large_rotation) {
    log::warning(
        fmt::format("cells rotate by up to {:.3g} rad: this is far outside small strain, and the motion is not that "
                    "of a real body; a body much softer or faster than was meant (units?) or one that spins",
                    summary.digest("max_rotation").maximum));
  }
}

/// All steps, recorded. Returns what ended them early, if anything did; `seconds` receives the time without recording.
std::optional<Error> take_steps(Simulation& simulation, Recording& recording, ContactExport* contact_export, long steps,
                                bool quiet, double& seconds) {
  Progress progress(steps, quiet);
  const double recorded_before = recording.seconds();
  std::optional<Error> failure;
  Timer timer;
  try {
    while (simulation.state().step < steps) {
      if (contact_export) contact_export->begin_step(simulation.state().step + 1);
      simulation.advance();
      recording.record(simulation.state(), simulation.account());
      progress.update(simulation.state().step, simulation.state().time);
    }
  } catch (const Error& problem) {
    failure = problem;
  }
  seconds = timer.seconds() - (recording.seconds() - recorded_before);
  return failure;
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

std::vector<ContactDescription> describe_contacts(const Case& input) {
  std::vector<ContactDescription> result;
  for (const ContactSection& contact : input.contacts) {
    const auto obstacle = std::find_if(input.obstacles.begin(), input.obstacles.end(),
                                       [&](const ObstacleSection& o) { return o.name == contact.obstacle; });
    result.push_back({contact.group, contact.obstacle, contact.multipliers, contact.friction, contact.friction_bound,
                      obstacle->velocity, obstacle->rotation_rate});
  }
  return result;
}

long step_count(const TimeSection& time) {
  // An end that is a whole number of steps to rounding is that number of steps.
  return std::max(1L, static_cast<long>(std::ceil(time.end / time.step * (1.0 - 1e-12))));
}

RunSummary run_case(const Case& input, const RunOptions& options) {
  log::clear_warnings();
  Timer total, timer;
  check_export(input, options, step_count(input.time));
  prepare_directory(options);
  BuildTimes build;
  const std::unique_ptr<Model> model = build_model(input, &build);
  timer.restart();
  const std::unique_ptr<Scheme> scheme = make_scheme(input.time);
  Simulation simulation(model->problem, *scheme, model->initial, step_solver_options(input));
  const double start_seconds = timer.restart();
  const long steps = step_count(input.time);
  if (std::abs(static_cast<double>(steps) * input.time.step - input.time.end) > 1e-9 * input.time.end) {
    log::info(fmt::format("time.end is not a whole number of steps: the run ends at t = {:.9g}",
                          static_cast<double>(steps) * input.time.step));
  }

  RunSummary summary = describe(input, *model, *scheme, simulation);
  remove_old_run(options);
  std::optional<ContactExport> contact_export;
  if (!options.export_contact.empty()) {
    contact_export.emplace(options.export_contact, export_directory(options), provenance(input, summary));
    simulation.observe_contact([&](const ContactProblem& problem, const ContactSolution& solution) {
      contact_export->write(problem, solution);
    });
  }
  Recording recording(input, *model, options.output_directory, steps);
  recording.record(simulation.state(), simulation.account());
  double step_seconds = 0.0;
  const double contact_before = simulation.contact_seconds();
  const std::optional<Error> failure = take_steps(simulation, recording, contact_export ? &*contact_export : nullptr,
                                                  steps, options.quiet, step_seconds);
  recording.close(summary);
  summary.steps = simulation.state().step;
  summary.time_per_step = summary.steps > 0 ? step_seconds / static_cast<double>(summary.steps) : 0.0;
  double ordering = 0.0, factorization = 0.0;
  for (const ChosenMethod& chosen : simulation.methods()) {
    ordering += chosen.ordering_seconds;
    factorization += chosen.factorization_seconds;
  }
  summary.timings = {
      {"read_mesh", build.read_mesh},   {"model", build.model},
      {"assembly", build.assembly},     {"ordering", ordering},
      {"factorization", factorization}, {"start", start_seconds - ordering - factorization},
      {"steps", step_seconds},          {"contact_solver", simulation.contact_seconds() - contact_before},
      {"output", recording.seconds()},  {"total", total.seconds()}};
  if (!failure) judge_energy(summary, model->problem, simulation.state());
  if (contact_export) summary.contact_export = contact_export->report();
  summary.warnings = log::warnings();
  if (failure) {
    summary.status = "failed";
    summary.message = failure->what();
  } else {
    summary.expectations = check_expectations(input, options.output_directory, to_json(summary));
  }
  write_summary(options.output_directory + "/summary.json", summary);
  if (failure) throw Error(*failure);
  return summary;
}

}  // namespace ricochet
