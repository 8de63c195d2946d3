#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/text.hpp"
#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/failure_bundle.hpp"
#include "ricochet/io/history_file.hpp"
#include "ricochet/io/progress.hpp"
#include "ricochet/io/rank_checkpoints.hpp"
#include "ricochet/io/run_directory.hpp"
#include "texts.hpp"

namespace ricochet::program {

namespace {

bool is_running(const std::string& directory, const RunSummary& summary) {
  return summary.status == "running" && RunDirectory::is_in_use(directory);
}

double seconds_of(const RunSummary& summary, const std::string& phase) {
  const auto found = std::ranges::find_if(summary.timings, [&](const auto& timing) { return timing.first == phase; });
  return found != summary.timings.end() ? found->second : 0.0;
}

}  // namespace

std::string status_text(const std::string& directory, const RunSummary& summary) {
  if (summary.status == "done") return "";
  if (summary.status == "failed") return " (FAILED)";
  // A run that has not ended and is not running was killed.
  return is_running(directory, summary) ? " (running)" : " (interrupted)";
}

std::string energies_text(const RunSummary& summary) {
  const ColumnDigest energy = summary.digest("total_energy");
  return fmt::format("energy {:.6g} at the start, {:.6g} at the end; largest total, kinetic or elastic energy {:.6g}",
                     energy.first, energy.last, summary.energy_scale());
}

std::string energy_account_text(const RunSummary& summary) {
  const ColumnDigest residual = summary.digest("energy_residual");
  const double largest = std::max(std::abs(residual.minimum), std::abs(residual.maximum));
  const double energy = summary.energy_scale(), work = summary.work_scale();
  std::string text =
      fmt::format("energy account closes to {:.1e} of the largest energy", energy > 0.0 ? largest / energy : largest);
  if (work > 1e3 * energy) text += fmt::format(", {:.1e} of the largest work", largest / work);
  return text;
}

namespace {

void print_checkpoints(const std::string& directory, const RunSummary& summary) {
  const std::vector<CheckpointFile> checkpoints = checkpoint_files(directory);
  const std::optional<CheckpointFile> last = checkpoints.empty() ? newest_manifest(directory) : checkpoints.back();
  if (last) {
    fmt::print("  checkpoint of step {}: {}\n", last->step, last->path);
  } else {
    fmt::print("  no checkpoint yet\n");
  }
  if (!is_running(directory, summary)) {
    const std::string command = run_command(summary.processes ? summary.processes->count : 1);
    fmt::print("  {} {}\n",
               summary.steered ? "the program that steers the run" : fmt::format("`{}` with --resume", command),
               last ? "continues it" : "restarts it");
  }
  for (const std::string& file : failure_files(directory)) fmt::print("  file of the failed step: {}\n", file);
}

}  // namespace

void print_progress(const std::string& directory, const RunSummary& summary) {
  if (summary.status == "done") return;
  // The summary is seconds old, and older than the history if the run was killed.
  const long step = std::max(summary.steps, last_history_step(directory + "/history.csv"));
  if (summary.adaptive) {
    fmt::print("  step {}, t = {:.6g} of {:.6g} ({:.3g} %)\n", summary.steps, summary.adaptive->time, summary.end_time,
               100.0 * summary.adaptive->time / summary.end_time);
    return print_checkpoints(directory, summary);
  }
  const auto done = double(summary.steps), all = double(summary.all_steps);
  fmt::print("  step {} of {} ({:.3g} %), t = {:.6g}", step, summary.all_steps, 100.0 * double(step) / all,
             double(step) * summary.step);
  const double seconds =
      seconds_of(summary, "steps") + seconds_of(summary, "output") + seconds_of(summary, "checkpoints");
  if (done > 0.0 && seconds > 0.0) {
    fmt::print(", {:.3g} steps per second", done / seconds);
    if (is_running(directory, summary)) fmt::print(", {} left", duration_text(seconds / done * (all - double(step))));
  }
  fmt::print("\n");
  print_checkpoints(directory, summary);
}

void describe_checkpoint(const std::string& path) {
  const Snapshot snapshot = read_checkpoint(path);
  const bool failed = snapshot.has("failure.message");
  fmt::print("{}: {} step {}, t = {:.9g}, of a run with Ricochet {}\n", path,
             failed ? "left by a failed run: the state of" : "checkpoint of", snapshot.integer("state.step"),
             snapshot.real("state.time"), snapshot.text("identity.version"));
  if (failed) fmt::print("  {}\n", snapshot.text("failure.message"));
  const Vector& displacement = snapshot.reals("state.displacement");
  const Vector& velocity = snapshot.reals("state.velocity");
  const Vector& reaction = snapshot.reals("state.normal_reaction");
  const auto largest = [](const Vector& values) { return values.size() > 0 ? values.cwiseAbs().maxCoeff() : 0.0; };
  fmt::print("  {}, largest displacement {:.6g}, largest velocity {:.6g}\n", counted(displacement.size(), "dof"),
             largest(displacement), largest(velocity));
  fmt::print("  {}, {} closed, largest normal reaction {:.6g}\n", counted(reaction.size(), "contact point"),
             (reaction.array() > 0.0).count(), largest(reaction));
  const Snapshot::Texts& keys = snapshot.texts("identity.case.keys");
  const Snapshot::Texts& values = snapshot.texts("identity.case.values");
  for (const char* key : {"time.scheme", "mass.type", "time.step", "time.end"}) {
    const auto at = std::size_t(std::ranges::find(keys, key) - keys.begin());
    if (at < std::min(keys.size(), values.size())) fmt::print("  {} = {}\n", key, values[at]);
  }
}

void print_cost(const RunSummary& s) {
  const std::string all = s.timings.empty() ? "" : fmt::format(", {} in all", duration_text(s.timings.back().second));
  // With several processes, print_solver reports it.
  const std::string memory =
      s.peak_memory > 0.0 && !s.processes
          ? fmt::format(", {:.3g} {} of memory at most", (s.peak_memory < 1e9 ? 1e-6 : 1e-9) * s.peak_memory,
                        s.peak_memory < 1e9 ? "MB" : "GB")
          : "";
  fmt::print("  {:.3g} ms per step{}{}\n", 1e3 * s.time_per_step, all, memory);
}

void print_solver(const RunSummary& s) {
  if (s.iterations) {
    fmt::print("  solved iteratively: {:.3g} contact iterations and {:.3g} conjugate gradient iterations per step\n",
               s.iterations->schwarz_iterations_per_step, s.iterations->gradients_per_step);
  }
  if (!s.processes) return;
  const ProcessReport& p = *s.processes;
  fmt::print(
      "  {} processes with {} to {} dofs; each uses at most {:.3g} GB and sends at most {:.3g} messages and {:.3g} MB "
      "per step\n",
      p.count, p.least_dofs, p.most_dofs, 1e-9 * s.peak_memory, p.messages_per_step, 1e-6 * p.bytes_per_step);
}

}  // namespace ricochet::program
