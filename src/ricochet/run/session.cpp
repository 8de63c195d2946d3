#include "ricochet/run/session.hpp"

#include <fmt/format.h>

#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/run/run.hpp"
#include "ricochet/run/run_identity.hpp"

namespace ricochet {

namespace {

void refuse_use(const std::string& why) { throw Error(ErrorKind::usage, "session: " + why); }

/// Returns the options of the solver, with the preconditioners of the model.
StepSolverOptions solver_options(const Case& input, const Model& model) {
  StepSolverOptions options = step_solver_options(input);
  options.preconditioners = model.preconditioners;
  const std::string& name = options.preconditioner;
  if (model.preconditioners != nullptr || name == "auto" ||
      preconditioner_registry().find(name).type.petsc_options.empty())
    return options;
  throw Error(
      ErrorKind::invalid_input,
      fmt::format(
          "{}: \"{}\" is available in `ricochet-mpi` only, which also runs with one process (docs/distributed.md); "
          "in this program set solver.preconditioner = \"block-jacobi\", or \"auto\" with solver.method = \"direct\"",
          input.where("solver.preconditioner").text(), name));
}

}  // namespace

Session::Session(const std::string& path, const std::vector<std::string>& changes) : changes_(changes) {
  const log::CollectWarnings collect(warnings_);
  input_ = read_case(path, changes);
}

Session::Session(Case input, std::vector<std::string> remarks)
    : input_(std::move(input)), warnings_(std::move(remarks)) {}

Session::~Session() = default;

void Session::build(BuildTimes* times) {
  if (model_ != nullptr) return;
  const log::CollectWarnings collect(warnings_);
  model_ = builder_ ? builder_(input_, times) : build_model(input_, times);
}

Model& Session::model() {
  build();
  return *model_;
}

Scheme& Session::scheme() {
  if (scheme_ == nullptr) scheme_ = make_scheme(input_.time);
  return *scheme_;
}

void Session::start() {
  if (simulation_ != nullptr) return;
  const log::CollectWarnings collect(warnings_);
  Model& built = model();
  simulation_ = std::make_unique<Simulation>(built.problem, scheme(), built.initial, solver_options(input_, built),
                                             step_control_options(input_.time));
}

void Session::resume(const Snapshot& snapshot) {
  if (simulation_ != nullptr) refuse_use("it has started and cannot resume another state");
  const log::CollectWarnings collect(warnings_);
  require_same_case(input_, snapshot, "this state");
  if (snapshot.has(steered_name)) {
    for (const std::string& name : snapshot.texts(steered_name)) steer_from_start(section_of_obstacle(name));
  }
  if (const std::string difference = compare_model(input_, model(), snapshot); !difference.empty())
    log::warning(difference);
  if (snapshot.has(load_name)) set_load(snapshot.reals(load_name));
  if (snapshot.has(steered_name)) {
    for (const std::string& name : snapshot.texts(steered_name))
      steered_path(name).persist(snapshot.loader("session.motion." + name));
  }
  simulation_ = std::make_unique<Simulation>(model().problem, scheme(), snapshot, solver_options(input_, model()),
                                             step_control_options(input_.time));
}

void Session::save(Snapshot& snapshot) {
  simulation().save(snapshot);
  save_identity(input_, model(), snapshot);
  if (load_ != nullptr) snapshot.save(load_name, *load_);
  Snapshot::Texts steered;
  for (const ObstacleSection& obstacle : input_.obstacles) {
    if (!obstacle.is_steered) continue;
    steered.push_back(obstacle.name);
    steered_path(obstacle.name).persist(snapshot.saver("session.motion." + obstacle.name));
  }
  if (!steered.empty()) snapshot.save(steered_name, std::move(steered));
}

bool Session::is_steered() const {
  return load_ != nullptr ||
         std::ranges::any_of(input_.obstacles, [](const ObstacleSection& obstacle) { return obstacle.is_steered; });
}

bool Session::is_complete_already() const { return run_ != nullptr && run_->is_complete_already(); }

Simulation& Session::simulation() {
  if (is_complete_already()) refuse_use("the run is complete: there is no state to access");
  start();
  return *simulation_;
}

namespace {

void check_values(const SemidiscreteProblem& problem, const Vector& values, const char* what) {
  if (values.size() != problem.dof_count()) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("session: a {} must have a number for each of the {} dofs of the problem, not {}", what,
                            problem.dof_count(), values.size()));
  }
  if (!values.allFinite())
    throw Error(ErrorKind::invalid_input, fmt::format("session: a {} has numbers that are not finite", what));
}

}  // namespace

void Session::set_load(const Vector& force) {
  Model& built = model();
  check_values(built.problem, force, "load");
  if (load_ == nullptr) {
    load_ = std::make_shared<Vector>();
    built.problem.loads.add_general([load = load_](double, Vector& sum) { sum += *load; });
  }
  *load_ = force;
  // Tied nodes have no equations: loads on them act on the nodes that they follow.
  if (built.problem.tied != nullptr) built.problem.tied->condense_load(*load_, int(built.problem.dimension));
}

void Session::set_velocity(const Vector& velocity) {
  const log::CollectWarnings collect(warnings_);
  Simulation& running = simulation();
  check_values(problem(), velocity, "velocity");
  if (!std::isfinite(problem().mass.quadratic_form(velocity)))
    throw Error(ErrorKind::invalid_input, "session: the velocity is so large that its energy is not finite");
  const Vector impulse = running.set_velocity(velocity);
  if (run_ == nullptr) return;
  run_->enter_impulse(impulse);
  if (state().forces.acting_normal().size() > 0 && state().forces.acting_normal().maxCoeff() > 0.0) {
    log::warning(
        fmt::format("t = {:.9g}: the velocity was set while contact forces acted: the restitution of this impact "
                    "includes this change",
                    time()));
  }
}

ObstacleSection& Session::section_of_obstacle(const std::string& obstacle) {
  std::string names;
  for (ObstacleSection& section : input_.obstacles) {
    if (section.name == obstacle) return section;
    names += (names.empty() ? "" : ", ") + section.name;
  }
  throw Error(ErrorKind::invalid_input,
              fmt::format("session: there is no obstacle \"{}\" in this case; its obstacles: {}", obstacle,
                          names.empty() ? "none" : names));
}

/// Marks an obstacle as steered. The motion of an obstacle affects how the problem is built, so that an existing model
/// is discarded.
void Session::steer_from_start(ObstacleSection& section) {
  if (section.is_steered) return;
  if (section.is_free()) {
    throw Error(ErrorKind::invalid_input, fmt::format("session: obstacle \"{}\" moves freely under the forces on it: "
                                                      "set a force on it in the case, or a load on its nodes",
                                                      section.name));
  }
  if (run_ != nullptr || simulation_ != nullptr)
    refuse_use(
        fmt::format("the velocity of obstacle \"{}\" must be set for the first time before the session starts: before "
                    "start(), write_to() and any access to its state; zero is sufficient",
                    section.name));
  section.is_steered = true;
  model_.reset();
  if (const std::shared_ptr<Vector> load = std::move(load_)) set_load(*load);
}

SteeredPath& Session::steered_path(const std::string& obstacle) {
  const auto index = std::size_t(&section_of_obstacle(obstacle) - input_.obstacles.data());
  return *model().obstacles[index]->steered_path();
}

void Session::set_obstacle_velocity(const std::string& obstacle, const Vector& velocity, const Vector& rotation_rate) {
  const log::CollectWarnings collect(warnings_);
  steer_from_start(section_of_obstacle(obstacle));
  if (is_complete_already()) refuse_use("the run is complete: there are no further steps");
  try {
    SteeredPath& path = steered_path(obstacle);
    const double now = simulation_ != nullptr ? time() : 0.0;
    const bool is_rotating = path.rotates() && path.rotation(now + input_.time.step) != path.rotation(now);
    path.steer(now, velocity, rotation_rate);
    if (is_rotating && rotation_rate.size() == 0) {
      log::warning(
          fmt::format("session: obstacle \"{}\" was rotating and stops rotating, since its velocity is set without a "
                      "rotation rate: set that, too (zero if it should stop)",
                      obstacle));
    }
  } catch (const Error& problem) {
    throw Error(problem.kind(), fmt::format("session: obstacle \"{}\": {}", obstacle, problem.what()));
  }
}

bool Session::at_end() {
  const StepControl* const control = simulation().control();
  return control != nullptr ? control->at_end() : state().step >= steps();
}

bool Session::step() {
  const log::CollectWarnings collect(warnings_);
  if (take_step()) return true;
  // A loop learns of the end by the first such call.
  if (++calls_at_end_ == 2)
    log::warning("session: the run has ended: this call of step(), and every further one, does nothing");
  return false;
}

bool Session::take_step() {
  if (has_finished_) refuse_use("it has finished, and nothing more would be written");
  if (run_ != nullptr) return run_->take_step();
  if (at_end()) return false;
  simulation().advance();
  return true;
}

void Session::run(const std::function<void()>& each) {
  while (step()) {
    if (each) each();
  }
}

void Session::write_to(RunOptions options) {
  if (run_ != nullptr || has_finished_) refuse_use("it already writes results");
  if (simulation_ != nullptr && state().step > 0) refuse_use("writing must begin before the first step");
  const log::CollectWarnings collect(warnings_);
  options_ = std::move(options);
  if (options_.settings.empty()) options_.settings = changes_;
  auto run = std::make_unique<Run>(*this, options_);
  run->begin();
  run_ = std::move(run);
}

void Session::write_checkpoint_now() {
  if (run_ == nullptr) refuse_use("it writes nothing: there is no run that a checkpoint could continue");
  const log::CollectWarnings collect(warnings_);
  run_->write_checkpoint_now();
}

RunSummary Session::finish() {
  if (run_ == nullptr) refuse_use("it writes nothing: there is no summary");
  const log::CollectWarnings collect(warnings_);
  has_finished_ = true;
  const std::unique_ptr<Run> run = std::move(run_);
  return run->finish();
}

}  // namespace ricochet
