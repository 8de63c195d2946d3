#include "ricochet/run/session.hpp"

#include <stdexcept>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/run/run.hpp"

namespace ricochet {

Session::Session(const std::string& path, const std::vector<std::string>& changes) {
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
  simulation_ = std::make_unique<Simulation>(built.problem, scheme(), built.initial, step_solver_options(input_));
}

void Session::resume(const Snapshot& snapshot) {
  if (simulation_ != nullptr) throw std::logic_error("a session that has started cannot take up another state");
  const log::CollectWarnings collect(warnings_);
  simulation_ = std::make_unique<Simulation>(model().problem, scheme(), snapshot, step_solver_options(input_));
}

void Session::save(Snapshot& snapshot) {
  simulation().save(snapshot);
}

Simulation& Session::simulation() {
  start();
  return *simulation_;
}

void Session::set_load(const Vector& force) {
  Model& built = model();
  if (force.size() != built.problem.dof_count())
    throw Error(ErrorKind::invalid_input, "a load needs a force for each dof of the problem");
  if (load_ == nullptr) {
    load_ = std::make_shared<Vector>();
    built.problem.loads.add_general([load = load_](double, Vector& sum) { sum += *load; });
  }
  *load_ = force;
}

bool Session::step() {
  const log::CollectWarnings collect(warnings_);
  if (run_ != nullptr) return run_->take_step();
  if (state().step >= steps()) return false;
  simulation().advance();
  return true;
}

void Session::run(const std::function<void()>& each) {
  while (step()) {
    if (each) each();
  }
}

void Session::write_to(RunOptions options) {
  if (run_ != nullptr) throw std::logic_error("the session writes already");
  const log::CollectWarnings collect(warnings_);
  options_ = std::move(options);
  run_ = std::make_unique<Run>(*this, options_);
  run_->begin();
}

RunSummary Session::finish() {
  if (run_ == nullptr) throw std::logic_error("the session writes nothing: there is no summary");
  const log::CollectWarnings collect(warnings_);
  const std::unique_ptr<Run> run = std::move(run_);
  return run->finish();
}

}  // namespace ricochet
