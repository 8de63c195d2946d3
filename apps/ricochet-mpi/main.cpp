#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <sstream>

#include "../ricochet/commands.hpp"
#include "../ricochet/process.hpp"
#include "../ricochet/stop_signal.hpp"
#include "ricochet/base/blas.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/distributed/cut_model.hpp"
#include "ricochet/distributed/mpi_ranks.hpp"
#include "ricochet/linear_algebra/library_versions.hpp"
#include "ricochet/version.hpp"

/// @file ricochet-mpi: `ricochet run` on several processes. Only the first process writes messages.
namespace {

using namespace ricochet;

constexpr int defect_status = 70;
/// Seconds that a process that has failed waits for the others to fail as well; then all are ended.
constexpr double patience = 1.5;

struct Arguments {
  program::RunArguments run;
  std::string log_level = "info";
  int threads = 1;
};

int dispatch(int argc, char** argv, const WorldRanks& ranks, const Communicator& world) {
  CLI::App app{"Ricochet on several processes: mpirun -n N ricochet-mpi run CASE.toml"};
  app.set_version_flag("--version", [] { return fmt::format("ricochet-mpi {}\n{}", version, library_versions()); });
  app.require_subcommand(1);
  app.footer(
      "Exit status as of `ricochet`. Use `ricochet` for everything else: info, report, plot, validate. Features that\n"
      "several processes do not support yet are refused by name; docs/distributed.md says how many processes to use.");
  Arguments arguments;
  CLI::App* run = app.add_subcommand("run", "Run a case, each process with its part of the body");
  run->add_option("case", arguments.run.case_file,
                  "case file; with --resume also the directory of a run, which records its case")
      ->type_name("CASE.toml");
  run->add_option("-o,--output", arguments.run.output_directory,
                  "output directory, the same for all processes (default: out/NAME of the case file)")
      ->type_name("DIR");
  run->add_option("--set", arguments.run.overrides, "override an entry of the case; may be repeated")
      ->type_name("key.path=value")
      ->allow_extra_args(false);
  run->add_option("--threads", arguments.threads, "threads of each process (default: 1)")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  run->add_flag("--quiet", arguments.run.quiet, "show no progress, and of the messages only warnings and errors");
  run->add_flag("--force", arguments.run.force, "overwrite a run that is in the output directory");
  run->add_flag("--resume", arguments.run.resume,
                "continue the run in the output directory, with its number of processes")
      ->excludes("--force");
  run->add_option("--log-level", arguments.log_level, "trace, debug, info, warning, error or off")->type_name("LEVEL");
  program::refuse_empty_values(app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& problem) {
    std::ostringstream text, message;
    const int status = app.exit(problem, text, message);
    if (ranks.is_first()) {
      std::fputs(text.str().c_str(), stdout);
      std::fputs(message.str().c_str(), stderr);
    }
    return status == 0 ? 0 : int(ErrorKind::usage);
  }
  log::set_level(log::parse_level(arguments.log_level));
  if (arguments.run.quiet && log::enabled(log::Level::info) && !log::enabled(log::Level::debug))
    log::set_level(log::Level::warning);
  // The first process issues the warnings of the others.
  if (!ranks.is_first()) log::set_level(log::Level::off);
  set_thread_count(arguments.threads);
  reserve_blas_memory(arguments.threads);
  if (ranks.are_several()) arguments.run.ranks = &ranks;
  arguments.run.builder = [&world](const Case& input, BuildTimes* times) {
    return build_divided_model(input, world, {}, times);
  };
  return program::run(arguments.run);
}

/// Reports an error. If all processes have failed, the first reports it; if only this one has, it reports the error
/// itself and ends the others.
int end(const WorldRanks& ranks, int status, const std::string& message) {
  if (Processes::all_arrive(patience)) {
    if (ranks.is_first()) std::fputs(fmt::format("ricochet-mpi: {}\n", message).c_str(), stderr);
    program::set_signal_program_name(nullptr);  // mpirun stops those that end a little later
    return status;
  }
  std::fputs(fmt::format("ricochet-mpi: process {} of {}: {}\n", ranks.rank(), ranks.size(), message).c_str(), stderr);
  std::fflush(nullptr);
  Processes::end_all(status);
}

}  // namespace

int main(int argc, char** argv) {
  program::restart_without_blas_threads(argv);
  program::keep_memory();
  program::open_closed_streams();
  prepare_blas();  // before there are threads
  program::wait_for_stop_signals(nullptr);
  const Processes processes(argc, argv);
  const Communicator world = Communicator::world();
  const WorldRanks ranks(world);
  if (ranks.is_first()) program::set_signal_program_name("ricochet-mpi");
  if (ranks.are_several()) program::remove_step_time_limit();
  try {
    return dispatch(argc, argv, ranks, world);
  } catch (const Error& problem) {
    return end(ranks, problem.exit_status(), problem.what());
  } catch (const std::bad_alloc&) {
    return end(ranks, int(ErrorKind::invalid_input),
               "out of memory: use more processes on more machines, or a coarser mesh");
  } catch (const std::exception& problem) {
    return end(ranks, defect_status, fmt::format("internal error: {}", problem.what()));
  }
}
