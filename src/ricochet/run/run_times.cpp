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

std::vector<std::pair<std::string, double>> RunTimes::phases() const {
  return {{"read_mesh", read_mesh},
          {"model", model},
          {"assembly", assembly},
          {"ordering", ordering},
          {"factorization", factorization},
          {"start", start},
          {"steps", steps},
          {"contact_solver", contact},
          {"output", output},
          {"penetration_watch", watch},
          {"checkpoints", checkpoints},
          {"total", earlier_total_ + session_.seconds()}};
}

void RunTimes::save(Snapshot& snapshot, const std::string& name) const {
  for (const auto& [phase, seconds] : phases()) snapshot.save(name + "." + phase, seconds);
  snapshot.save(name + ".processor", processor());
}

void RunTimes::load(const Snapshot& snapshot, const std::string& name) {
  const auto add = [&](const char* phase, double& seconds) { seconds += snapshot.real(name + "." + phase); };
  add("read_mesh", read_mesh);
  add("model", model);
  add("assembly", assembly);
  add("ordering", ordering);
  add("factorization", factorization);
  add("start", start);
  add("steps", steps);
  add("contact_solver", contact);
  add("output", output);
  add("penetration_watch", watch);
  add("checkpoints", checkpoints);
  add("total", earlier_total_);
  add("processor", earlier_processor_);
}

}  // namespace ricochet
