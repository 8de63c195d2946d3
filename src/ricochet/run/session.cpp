#include "ricochet/run/session.hpp"

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/run/run.hpp"
#include "ricochet/run/run_identity.hpp"

namespace ricochet {

namespace {

void refuse_use(const std::string& why) {
  throw Error(ErrorKind::usage, "session: " + why);
}

}  // namespace

Session::Session(const std::string& path, const std::vector<std::string>& changes) : changes_(changes) {
  const log::CollectWarnings collect(warnings_);
  input_ = read_case(path, changes);
}

Session::Session(Case input) : input_(std::move(input)) {}

Session::~Session() = default;

void Session::build(BuildTimes* times) {
  if (model_ != nullptr) return;
  const log::CollectWarnings collect(warnings_);
  model_ = build_model(input_, times);
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
  simulation_ = std::make_unique<Simulation>(built.problem, scheme(), built.initial, step_solver_options(input_),
                                             step_control_options(input_.time));
}

void Session::resume(const Snapshot& snapshot) {
  if (simulation_ != nullptr) refuse_use("it has started and cannot take up another state");
  const log::CollectWarnings collect(warnings_);
  require_same_case(input_, snapshot, "this state");
  if (const std::string difference = compare_model(input_, model(), snapshot); !difference.empty())
    log::warning(difference);
  if (snapshot.has(load_name)) set_load(snapshot.reals(load_name));
  simulation_ = std::make_unique<Simulation>(model().problem, scheme(), snapshot, step_solver_options(input_),
                                             step_control_options(input_.time));
}

void Session::save(Snapshot& snapshot) {
  simulation().save(snapshot);
  save_identity(input_, model(), snapshot);
  if (load_ != nullptr) snapshot.save(load_name, *load_);
}

Simulation& Session::simulation() {
  if (run_ != nullptr && run_->is_complete_already()) refuse_use("the run is complete: there is no state to look at");
  start();
  return *simulation_;
}

void Session::set_load(const Vector& force) {
  Model& built = model();
  if (force.size() != built.problem.dof_count())
    throw Error(ErrorKind::invalid_input, "session: a load needs a force for each dof of the problem");
  if (!force.allFinite()) throw Error(ErrorKind::invalid_input, "session: a load has forces that are not finite");
  if (load_ == nullptr) {
    load_ = std::make_shared<Vector>();
    built.problem.loads.add_general([load = load_](double, Vector& sum) { sum += *load; });
  }
  *load_ = force;
}

bool Session::at_end() {
  const StepControl* const control = simulation().control();
  return control != nullptr ? control->at_end() : state().step >= steps();
}

bool Session::step() {
  const log::CollectWarnings collect(warnings_);
  if (has_finished_) refuse_use("it has finished, and nothing would be written any more");
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
  if (run_ != nullptr || has_finished_) refuse_use("it writes already");
  if (simulation_ != nullptr && state().step > 0) refuse_use("what it writes must begin before the first step");
  const log::CollectWarnings collect(warnings_);
  options_ = std::move(options);
  if (options_.settings.empty()) options_.settings = changes_;
  auto run = std::make_unique<Run>(*this, options_);
  run->begin();
  run_ = std::move(run);
}

RunSummary Session::finish() {
  if (run_ == nullptr) refuse_use("it writes nothing: there is no summary");
  const log::CollectWarnings collect(warnings_);
  has_finished_ = true;
  const std::unique_ptr<Run> run = std::move(run_);
  return run->finish();
}

}  // namespace ricochet
