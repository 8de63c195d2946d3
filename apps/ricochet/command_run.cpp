#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>

#include "commands.hpp"
#include "ricochet/base/checksum.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/run_name.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/io/checkpoint.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/progress.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/run/old_run.hpp"
#include "ricochet/run/session.hpp"
#include "stop_signal.hpp"
#include "texts.hpp"

namespace ricochet::program {

namespace {

constexpr std::size_t most_impacts_shown = 5;

void print_summary(const RunSummary& s, const std::string& directory) {
  fmt::print("{}\n", s.title.empty() ? s.case_file : s.title);
  fmt::print("  scheme {}, mass {}, {}, {}, {}\n", s.scheme, s.mass_text(), counted(s.nodes, "node"),
             counted(s.contact_points, "contact point"), steps_text(s));
  fmt::print("  {}\n", energies_text(s));
  fmt::print("  {}\n", energy_account_text(s));
  print_method(s);
  print_friction(s);
  print_impacts(s, most_impacts_shown);
  print_peak_stress(s);
  fmt::print("{}\n", deformation_text(s));
  print_solver(s);
  print_cost(s);
  print_expectations(s.expectations);
  for (const std::string& warning : s.warnings) fmt::print("  warning: {}\n", warning);
  if (!s.message.empty()) fmt::print("  {}\n", s.message);
  fmt::print("  results in {}\n", directory);
  if (!s.contact_export.empty()) fmt::print("  {}\n", s.contact_export);
}

/// Replaces `--resume DIR` by the case and the settings with which the run in DIR began.
RunArguments with_origin(RunArguments arguments) {
  if (!arguments.resume) {
    if (holds_run(arguments.case_file)) {
      throw Error(ErrorKind::usage, fmt::format("run: {0} is a directory of results, not a case file; `ricochet run "
                                                "--resume {0}` continues the run in it",
                                                arguments.case_file));
    }
    if (!arguments.case_file.empty()) return arguments;
    throw Error(ErrorKind::usage, "run: a case file is required (or --resume and the directory of a run)");
  }
  std::error_code ignored;
  if (!arguments.case_file.empty() && !std::filesystem::is_directory(arguments.case_file, ignored)) {
    if (std::filesystem::exists(arguments.case_file, ignored)) return arguments;
    throw Error(ErrorKind::file_access,
                fmt::format("{}: cannot be resumed: no such file or directory", arguments.case_file));
  }
  if (arguments.case_file.empty() == arguments.output_directory.empty())
    throw Error(ErrorKind::usage, "run --resume: either a case file or the directory of one run is required");
  if (arguments.output_directory.empty()) arguments.output_directory = arguments.case_file;
  RunOrigin origin = find_origin(arguments.output_directory);
  arguments.case_file = origin.case_path;
  origin.settings.insert(origin.settings.end(), arguments.overrides.begin(), arguments.overrides.end());
  arguments.overrides = origin.settings;
  return arguments;
}

/// Requires that each process reads the same case. Throws Error(file_access) on all processes if some cannot read it or
/// read another text.
void require_same_case_file(const Ranks& ranks, const std::string& path) {
  constexpr double unreadable = -1.0;
  double own = unreadable;
  try {
    const std::string text = read_file(path);
    own = double(Checksum().add_bytes(text.data(), text.size()).value());
  } catch (const Error&) {  // reading the case reports the reason if no process can
  }
  const Ranks::ForEach<double> all = ranks.all_gather({own});
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (all[i] == all[0]) continue;
    const bool is_missing = all[i][0] == unreadable || all[0][0] == unreadable;
    throw Error(
        ErrorKind::file_access,
        fmt::format(
            "{}: {}: make the case available under this name on all machines, for example in a shared folder", path,
            is_missing
                ? fmt::format("process {} of {} cannot read it", all[0][0] == unreadable ? 0 : i, all.size())
                : fmt::format("process {} of {} reads a text that differs from that of process 0", i, all.size())));
  }
}

/// Warns of processes started by mpirun, each of which would run the whole case.
void warn_of_launcher(const Ranks& ranks) {
  const char* const size = std::getenv("OMPI_COMM_WORLD_SIZE");
  const char* const rank = std::getenv("OMPI_COMM_WORLD_RANK");
  if (ranks.are_several() || size == nullptr || rank == nullptr) return;
  if (number_in(size).value_or(1.0) <= 1.0 || number_in(rank).value_or(1.0) != 0.0) return;
  log::warning(
      fmt::format("mpirun has started {0} processes, each of which runs the whole case: to divide a body among them, "
                  "use mpirun -n {0} ricochet-mpi run (docs/distributed.md)",
                  size));
}

}  // namespace

int run(const RunArguments& given) {
  warn_of_launcher(*given.ranks);
  RunArguments arguments;
  given.ranks->run_collectively([&] { arguments = with_origin(given); });
  if (given.ranks->are_several()) require_same_case_file(*given.ranks, arguments.case_file);
  RunOptions options;
  options.output_directory = arguments.output_directory;
  options.settings = arguments.overrides;
  options.force = arguments.force;
  options.quiet = arguments.quiet;
  options.resume = arguments.resume;
  options.stop_signal = stop_signal;
  if (arguments.export_contact) options.export_contact = parse_steps(*arguments.export_contact);
  options.export_contact_to = arguments.export_contact_to;
  if (options.output_directory.empty()) {
    options.output_directory =
        (std::filesystem::path("out") / std::filesystem::path(arguments.case_file).stem()).string();
  }
  // Messages refer to the case until the run has created its directory.
  if (options.quiet) log::set_run_name(arguments.case_file);
  options.ranks = arguments.ranks;
  Session session(arguments.case_file, arguments.overrides);
  session.set_model_builder(arguments.builder);
  const RunSummary summary = run_case(session, options);
  if (arguments.ranks->is_first()) print_summary(summary, options.output_directory);
  // Any process may have received the signal.
  if (summary.status == "interrupted") return 128 + int(arguments.ranks->maximum(stop_signal()));
  // Expectations have positions in the case, but hold in some of its runs only.
  if (options.quiet) log::set_run_name(options.output_directory);
  // The first process evaluates the expectations, and all end accordingly.
  arguments.ranks->run_collectively([&summary] {
    for (const ExpectationResult& e : summary.expectations) {
      if (e.checked && !e.holds) {
        throw Error(ErrorKind::expectation,
                    fmt::format("{}: expected {} to be {}, {}", e.location, e.label(), e.expected, found_text(e)));
      }
    }
  });
  return 0;
}

}  // namespace ricochet::program
