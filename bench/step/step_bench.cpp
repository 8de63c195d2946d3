#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "limits.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/contact/construction/make_contact_boundary.hpp"
#include "ricochet/contact/mortar/choose_side.hpp"
#include "ricochet/contact/mortar/tied_surfaces.hpp"
#include "ricochet/linear_algebra/library_versions.hpp"
#include "ricochet/run/session.hpp"
#include "ricochet/simulation/history/history.hpp"

// Measures the time steps of a case, next to the limits that a step with contact should approach (limits.hpp). Steps
// and limits take turns, so that both see the same machine. Prints one JSON object.

namespace {

using namespace ricochet;
using namespace ricochet::bench;

struct Options {
  std::string path;
  int steps = 200;
  int threads = 1;
  bool compare = true;       ///< with the limits
  bool forces = false;       ///< print the contact force and the time of every step
  double largest_ratio = 0;  ///< largest ratio of a step to the plain solve; above it the program fails
};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Returns the peak memory of the process so far, in MB.
double peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return double(usage.ru_maxrss) * 1024e-6;
}

double megabytes(const SparseMatrix& matrix) {
  return 1e-6 * (double(matrix.nonZeros()) * (sizeof(double) + sizeof(int)) + double(matrix.cols()) * sizeof(int));
}

std::unique_ptr<Limits> make_limits(const SemidiscreteProblem& problem, const Scheme& scheme,
                                    std::size_t factor_entries) {
  if (std::isfinite(scheme.critical_step())) return std::make_unique<ExplicitLimits>(problem, factor_entries);
  const OperatorCoefficients a = scheme.operators(problem).back();
  return std::make_unique<DirectLimits>(a.stiffness * problem.internal_force->tangent() +
                                        a.mass * problem.mass.to_sparse());
}

/// Returns the processor time of the surface operations in building a model: choice of sides, ties, and contact points
/// with their rows. They are repeated for this measurement alone.
double pairing_seconds(const Model& model) {
  const int d = model.mesh.dimension;
  const auto is_free = [&](Index node, int component) {
    return !model.problem.supports.contains(node * d + component);
  };
  const ProcessorTimer timer;
  for (const ContactPair& pair : model.contact_pairs) {
    if (!pair.between_bodies()) continue;
    static_cast<void>(choose_side(model.body, pair));
    if (pair.tied) static_cast<void>(tie_surfaces(model.body, pair));
  }
  static_cast<void>(make_contact_boundary(model.body, model.contact_pairs, is_free));
  return timer.seconds();
}

struct Phase {
  std::vector<double> step, row;
  LimitTimes limits;
  long iterations = 0, most_active = 0;
};

const char* phase_name(long active, long before) {
  if (active == 0 && before == 0) return "open";
  return active == before ? "closed" : "changing";
}

void print_phase(const std::string& name, const Phase& phase) {
  const double step = median(phase.step), library = median(phase.limits.library);
  fmt::print(R"(, "{}": {{"steps": {}, "active": {}, "step_ms": {:.5g}, "row_ms": {:.5g}, "iterations": {:.3g})", name,
             phase.step.size(), phase.most_active, 1e3 * step, 1e3 * median(phase.row),
             double(phase.iterations) / double(phase.step.size()));
  if (!phase.limits.memory.empty()) fmt::print(R"(, "memory_limit_ms": {:.5g})", 1e3 * median(phase.limits.memory));
  if (library > 0.0) {
    fmt::print(R"(, "library_solve_ms": {:.5g}, "own_solve_ms": {:.5g}, "ratio": {:.4g})", 1e3 * library,
               1e3 * median(phase.limits.own), step / library);
  }
  fmt::print("}}");
}

/// Runs steps in groups, each followed by the limits.
double run(const Options& options) {
  Session session(options.path);
  BuildTimes build;
  session.build(&build);
  const Model& model = session.model();
  const double pairing = pairing_seconds(model);
  const Timer timer;
  session.start();
  const double start = timer.seconds();
  Simulation& simulation = session.simulation();
  HistoryRecorder recorder(model.problem, *model.rotation, model.sensors);
  simulation.advance();
  const double peak_alone = peak_memory();
  std::unique_ptr<Limits> limits;
  if (options.compare) limits = make_limits(model.problem, session.scheme(), std::size_t(simulation.factor_entries()));

  std::map<std::string, Phase> phases;
  long before = 0;
  std::vector<double> force, milliseconds;
  for (int k = 1; k < options.steps; ++k) {
    const StepTimer step_timer;
    simulation.advance();
    const double step = step_timer.seconds();
    const StepTimer row_timer;
    const std::vector<double>& row = recorder.row(simulation.state(), simulation.account());
    const double row_seconds = row_timer.seconds();
    const auto active = long((simulation.state().forces.normal_reaction.array() > 0.0).count());
    force.push_back(simulation.state().forces.normal_reaction.sum());
    milliseconds.push_back(1e3 * step);
    Phase& phase = phases[phase_name(active, before)];
    before = active;
    // The first step after the limits, which have flushed the caches, would not be typical.
    if (limits && k % 6 == 0) limits->measure(phase.limits);
    if (limits && k % 6 == 1) continue;
    phase.step.push_back(step);
    phase.row.push_back(row_seconds);
    phase.iterations += simulation.state().iterations;
    phase.most_active = std::max(phase.most_active, active);
    static_cast<void>(row);
  }

  const double peak = limits ? peak_alone : peak_memory();
  const SemidiscreteProblem& problem = model.problem;
  const double matrices = megabytes(problem.internal_force->tangent()) + megabytes(problem.mass.to_sparse());
  fmt::print(R"({{"case": "{}", "libraries": "{}", "dimension": {}, "dofs": {}, "contact_points": {}, "threads": {}, )",
             options.path, library_versions(), problem.dimension, problem.dof_count(), problem.contact.size(),
             thread_count());
  fmt::print(
      R"("read_s": {:.4g}, "assembly_s": {:.4g}, "start_s": {:.4g}, "factor_entries": {}, "matrices_mb": {:.4g}, )",
      build.read_mesh, build.assembly, start, simulation.factor_entries(), matrices);
  fmt::print(R"("pairing_s": {:.4g}, "peak_mb": {:.5g})", pairing, peak);
  if (limits) fmt::print(R"(, "limit_mb": {:.5g})", 1e-6 * double(limits->bytes()));
  double worst = 0.0;
  for (const auto& [name, phase] : phases) {
    if (phase.step.empty()) continue;
    print_phase(name, phase);
    if (!phase.limits.library.empty()) worst = std::max(worst, median(phase.step) / median(phase.limits.library));
  }
  if (options.forces)
    fmt::print(R"(, "force": [{:.12g}], "steps_ms": [{:.5g}])", fmt::join(force, ", "), fmt::join(milliseconds, ", "));
  fmt::print("}}\n");
  return worst;
}

Options parse(int count, char** arguments) {
  Options options;
  for (int i = 1; i < count; ++i) {
    const std::string word = arguments[i];
    const auto value = [&] {
      return i + 1 < count ? arguments[++i] : throw Error(ErrorKind::usage, word + ": a value is missing");
    };
    if (word == "--steps") {
      options.steps = std::stoi(value());
    } else if (word == "--threads") {
      options.threads = std::stoi(value());
    } else if (word == "--alone") {
      options.compare = false;
    } else if (word == "--forces") {
      options.forces = true;
    } else if (word == "--at-most") {
      options.largest_ratio = std::stod(value());
    } else {
      options.path = word;
    }
  }
  if (options.path.empty())
    throw Error(ErrorKind::usage,
                "usage: ricochet_step_bench CASE.toml [--steps N] [--threads N] [--alone] [--forces] "
                "[--at-most RATIO]");
  return options;
}

}  // namespace

int main(int count, char** arguments) {
  log::set_level(log::Level::error);
  try {
    const Options options = parse(count, arguments);
    set_thread_count(options.threads);
    const double worst = run(options);
    if (options.largest_ratio > 0.0 && !(worst <= options.largest_ratio)) {
      fmt::print(stderr, "a step takes {:.3g} times the plain triangular solve; at most {:g} is allowed\n", worst,
                 options.largest_ratio);
      return 1;
    }
  } catch (const std::exception& problem) {
    fmt::print(stderr, "{}\n", problem.what());
    return 2;
  }
  return 0;
}
