#include "ricochet/run/run_times.hpp"

namespace ricochet {

void RunTimes::add_build(const BuildTimes& build) {
  read_mesh += build.read_mesh;
  model += build.model;
  assembly += build.assembly;
}

void RunTimes::add_start(double seconds, const std::vector<ChosenMethod>& methods) {
  start += seconds;
  for (const ChosenMethod& chosen : methods) {
    ordering += chosen.ordering_seconds;
    factorization += chosen.factorization_seconds;
    start -= chosen.ordering_seconds + chosen.factorization_seconds;
  }
}

namespace {

/// Phases in the order of a run.
constexpr std::pair<const char*, double RunTimes::*> phase_times[] = {{"read_mesh", &RunTimes::read_mesh},
                                                                      {"model", &RunTimes::model},
                                                                      {"assembly", &RunTimes::assembly},
                                                                      {"ordering", &RunTimes::ordering},
                                                                      {"factorization", &RunTimes::factorization},
                                                                      {"start", &RunTimes::start},
                                                                      {"steps", &RunTimes::steps},
                                                                      {"contact_solver", &RunTimes::contact},
                                                                      {"output", &RunTimes::output},
                                                                      {"penetration_watch", &RunTimes::watch},
                                                                      {"checkpoints", &RunTimes::checkpoints}};

}  // namespace

std::vector<std::pair<std::string, double>> RunTimes::phases() const {
  std::vector<std::pair<std::string, double>> result;
  for (const auto& [phase, seconds] : phase_times) result.emplace_back(phase, this->*seconds);
  result.emplace_back("total", earlier_total_ + session_.seconds());
  return result;
}

void RunTimes::persist(const SnapshotVisitor& visit) {
  const auto add = [&](const char* phase, double until_now, double& seconds) {
    visit(phase, until_now);
    if (visit.loads()) seconds += until_now;
  };
  for (const auto& [phase, seconds] : phase_times) add(phase, this->*seconds, this->*seconds);
  add("total", earlier_total_ + session_.seconds(), earlier_total_);
  add("processor", processor(), earlier_processor_);
}

}  // namespace ricochet
