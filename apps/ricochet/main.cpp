#include <fmt/format.h>
#include <malloc.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <sstream>
#include <string_view>

#include "commands.hpp"
#include "completion.hpp"
#include "described_command.hpp"
#include "manual_page.hpp"
#include "process.hpp"
#include "ricochet/base/blas.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/base/run_name.hpp"
#include "ricochet/linear_algebra/library_versions.hpp"
#include "ricochet/version.hpp"
#include "stop_signal.hpp"

namespace {

using namespace ricochet;

struct Arguments {
  program::RunArguments run;
  program::ValidateArguments validate;
  program::ContactArguments contact;
  program::ReportArguments report;
  program::PlotArguments plot;
  program::StudyArguments study;
  program::BenchmarkArguments benchmark;
  program::InfoArguments info;
  std::string shell;
  program::SchemaArguments schema;
  std::string log_level = "info";
  int threads = 1;
};

void add_common(CLI::App& command, std::string& log_level) {
  command.add_option("--log-level", log_level, "trace, debug, info, warning, error or off")->type_name("LEVEL");
}

CLI::Option* add(CLI::App& command, const char* name, auto& value, const char* type, const char* doc) {
  return command.add_option(name, value, doc)->type_name(type);
}

/// Option that may be repeated, each time with one value.
CLI::Option* add_repeated(CLI::App& command, const char* name, std::vector<std::string>& values, const char* type,
                          const char* doc) {
  return add(command, name, values, type, doc)->allow_extra_args(false);
}

void add_set(CLI::App& command, std::vector<std::string>& overrides, const char* doc) {
  add_repeated(command, "--set", overrides, "key.path=value", doc);
}

void add_jobs(CLI::App& command, int& jobs) {
  add(command, "--jobs", jobs, "N", "runs at a time (default: as many as the available cores allow)")
      ->check(CLI::Range(1, 1024));
}

void add_run_flags(CLI::App& command, auto& arguments, const char* quiet, const char* force, const char* resume) {
  command.add_flag("--quiet", arguments.quiet, quiet);
  command.add_flag("--force", arguments.force, force);
  command.add_flag("--resume", arguments.resume, resume)->excludes("--force");
}

void add_study_questions(CLI::App& study, program::StudyArguments& arguments) {
  add_repeated(study, "--quantity", arguments.quantities, "QUANTITY",
               "a column of the table, written as in [[expect]]: history.COLUMN[-1], max(history.COLUMN), "
               "summary.PATH; may be repeated");
  add_repeated(study, "--exact", arguments.exact, "QUANTITY=VALUE",
               "the exact value of a quantity; adds a column with its error");
  add(study, "--reference", arguments.reference, "RUN",
      "the run with which histories are compared: the directory of a run, last:KEY or finest:KEY");
  add_repeated(study, "--compare", arguments.compare, "COLUMN",
               "a column of history.csv, or a vector without its _x, to compare with that of the reference");
  add(study, "--order", arguments.order, "KEY", "the key by whose values observed orders are computed");
}

void add_study(CLI::App& app, program::StudyArguments& arguments, std::string& log_level) {
  CLI::App* study = app.add_subcommand("study", "Run a case with many values of its keys, and tabulate the results");
  add(*study, "case", arguments.case_file, "CASE.toml", "case file; with --resume also the directory of a study");
  add_repeated(*study, "--vary", arguments.vary, "KEY=V1,V2,...",
               "a key of the case and its values; keys that change together: KEY1,KEY2=V1/W1,V2/W2; if repeated, "
               "all combinations are run");
  add_set(*study, arguments.overrides, "override an entry of the case in all runs");
  add(*study, "-o,--output", arguments.output_directory, "DIR", "directory of the study");
  add_jobs(*study, arguments.jobs);
  add(*study, "--threads", arguments.threads, "N", "threads of each run (default: 1)")->check(CLI::Range(1, 1024));
  add_study_questions(*study, arguments);
  add_run_flags(*study, arguments, "show no progress", "overwrite a study that is in the directory",
                "continue the study in the directory, also with more values than before");
  study->footer(
      "Exit status: 0 all runs are done; 128 + N stopped by signal N, --resume continues; otherwise the worst status "
      "of the runs, as of `ricochet run`; 1 if that is 0 and no run has a quantity that --quantity, --exact or "
      "--compare requests.");
  add_common(*study, log_level);
}

void add_benchmark(CLI::App& app, program::BenchmarkArguments& arguments, std::string& log_level) {
  CLI::App* benchmark =
      app.add_subcommand("benchmark", "Run cases with reference values, and tabulate the results against them");
  add(*benchmark, "names", arguments.names, "BENCHMARK", "benchmarks (default: all)");
  add(*benchmark, "-o,--output", arguments.output_directory, "DIR", "directory of the tables and runs")
      ->capture_default_str();
  add(*benchmark, "--scheme", arguments.scheme, "SCHEME,...|all",
      "a scorecard of these schemes, or of all: SCHEME or SCHEME/MASS, separated by commas (default: the "
      "method of each case)");
  add_jobs(*benchmark, arguments.jobs);
  add(*benchmark, "--folder", arguments.folder, "DIR",
      "a folder with a benchmarks.toml (default: the one of the program)");
  benchmark->add_flag("--list", arguments.list, "list the benchmarks and do nothing else");
  add_run_flags(*benchmark, arguments, "show no progress", "overwrite benchmarks that are in the directory",
                "keep the completed runs in the directory");
  benchmark->footer(
      "Exit status: 0 all expected values hold; 5 some do not; 128 + N stopped by signal N; otherwise the worst status "
      "of the runs, as of `ricochet run`. Refusals by a scheme other than that of the case do not count.");
  add_common(*benchmark, log_level);
}

program::DescribedOption described(const CLI::Option& option) {
  program::DescribedOption result;
  for (const std::string& name : option.get_snames()) result.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) result.names.push_back("--" + name);
  result.doc = option.get_description();
  if (!option.get_default_str().empty()) result.doc += " (default: " + option.get_default_str() + ")";
  const int most = option.get_items_expected_max();
  if (most > 0) result.value = option.get_type_name();
  // CLI11 appends the range of a number to its name: "N:INT in [1 - 1024]".
  if (const std::size_t bounds = result.value.find(" in ["); bounds != std::string::npos) {
    result.doc += ", in " + result.value.substr(bounds + 4);
    result.value.resize(result.value.rfind(':', bounds));
  }
  for (const CLI::Option* other : option.get_excludes()) result.doc += "; not with " + other->get_name();
  for (const CLI::Option* other : option.get_needs()) result.doc += "; only with " + other->get_name();
  result.required = option.get_required();
  result.many = most >= CLI::detail::expected_max_vector_size;
  return result;
}

/// Describes a command with exactly those items that `--help` lists.
program::DescribedCommand described(const CLI::App& command) {
  program::DescribedCommand result{command.get_name(), command.get_description(), command.get_footer(), {}, {}};
  for (const CLI::Option* option : command.get_options()) result.options.push_back(described(*option));
  for (const CLI::App* part : command.get_subcommands([](const CLI::App*) { return true; }))
    result.commands.push_back(described(*part));
  return result;
}

/// Handles `ricochet complete -- WORD...`, which completion scripts call, and `ricochet manual-page`, which the build
/// calls: both refer to the command line itself, which must not be parsed for them. Returns false for other commands.
bool handle_internal_command(const CLI::App& app, int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() >= 2 && words[0] == "complete" && words[1] == "--") {
    for (const program::Candidate& candidate : program::complete(described(app), {words.begin() + 2, words.end()}))
      fmt::print("{}\t{}\n", candidate.word, candidate.doc);
    return true;
  }
  if (words != std::vector<std::string>{"manual-page"}) return false;
  std::fputs(program::manual_of_commands(described(app)).c_str(), stdout);
  return true;
}

int dispatch(int argc, char** argv) {
  CLI::App app{
      "Ricochet simulates elastic bodies that strike, rest on, slide along and leave each other and rigid obstacles."};
  app.set_version_flag("--version", [] { return fmt::format("ricochet {}\n{}", version, library_versions()); });
  app.require_subcommand(1);
  app.footer(
      "Exit status: 0 done; 1 wrong use of the command line; 2 invalid case or mesh; 3 a step did not converge;\n"
      "4 cannot read or write a file; 5 done, but an [[expect]] entry of the case does not hold;\n"
      "129, 130 and 143 stopped by SIGHUP, SIGINT or SIGTERM; run --resume continues a run that was stopped;\n"
      "70 a defect of Ricochet itself.");
  Arguments arguments;

  CLI::App* run = app.add_subcommand("run", "Run a case");
  add(*run, "case", arguments.run.case_file, "CASE.toml",
      "case file; with --resume also the directory of a run, which records its case");
  add(*run, "-o,--output", arguments.run.output_directory, "DIR",
      "output directory (default: out/NAME of the case file)");
  add_set(*run, arguments.run.overrides, "override an entry of the case; may be repeated");
  add(*run, "--threads", arguments.threads, "N", "number of threads; results do not depend on it");
  add_run_flags(*run, arguments.run, "show no progress, and of the messages only warnings and errors",
                "overwrite a run that is in the output directory",
                "continue the run in the output directory, also to a later time.end");
  add(*run, "--export-contact", arguments.run.export_contact, "STEPS",
      "write the contact problems of these steps as FCLib files, for example 10,20,50:60");
  add(*run, "--export-contact-to", arguments.run.export_contact_to, "DIR",
      "directory of these files (default: contact in the output directory)")
      ->needs("--export-contact");
  add_common(*run, arguments.log_level);

  CLI::App* validate = app.add_subcommand("validate", "Check everything that can be checked without running");
  add(*validate, "case", arguments.validate.case_file, "CASE.toml", "case file")->required();
  add_set(*validate, arguments.validate.overrides, "override an entry of the case");
  validate->add_flag("--mesh", arguments.validate.mesh,
                     "mesh a .geo or CAD file with the gmsh program, as a run does (this runs shell commands that a "
                     ".geo or .opt file contains)");
  add_common(*validate, arguments.log_level);

  CLI::App* info = app.add_subcommand("info",
                                      "Describe a mesh, a case, a contact problem, a checkpoint, or a run that is "
                                      "running or has ended, in a few lines; several runs are compared in a table");
  add(*info, "path", arguments.info.paths, "FILE_OR_DIR", "mesh, case file, FCLib file, checkpoint or output directory")
      ->required();
  add_set(*info, arguments.info.overrides, "override an entry of a case");
  add_common(*info, arguments.log_level);

  CLI::App* contact = app.add_subcommand("contact", "Solve a contact problem from an FCLib file");
  add(*contact, "problem", arguments.contact.problem, "PROBLEM.hdf5", "FCLib file of a local problem");
  add(*contact, "--solver", arguments.contact.solver, "SOLVER", "name of the solver, see --list (default: automatic)");
  add(*contact, "--tolerance", arguments.contact.tolerance, "T",
      "relative residual to reach, or the rounding error if that is larger (default: 0, down to rounding)");
  add(*contact, "-o,--output", arguments.contact.output, "SOLUTION.hdf5",
      "FCLib file for the problem and its solution");
  contact->add_flag("--record", arguments.contact.record, "print every iteration");
  contact->add_flag("--list", arguments.contact.list, "list the solvers and do nothing else");
  contact->footer(
      "Exit status: 0 solved; 1 wrong use of the command line; 2 the file is malformed; 3 not solved: the best\n"
      "solution found is reported with its residual; 4 cannot read or write a file.");
  add_common(*contact, arguments.log_level);

  CLI::App* report =
      app.add_subcommand("report", "Write one or several runs into a page for the browser, one HTML file");
  add(*report, "directories", arguments.report.directories, "DIR", "output directories of runs")->required();
  add(*report, "-o,--output", arguments.report.output, "FILE.html",
      "HTML file (default: report.html in the directory, or in the folder that contains all of them)");
  add(*report, "--size-limit", arguments.report.most_megabytes, "MB",
      "largest size of the file in megabytes; larger runs are thinned (default: 20)")
      ->check(CLI::Range(1.0, 2000.0));
  add_common(*report, arguments.log_level);

  CLI::App* plot = app.add_subcommand("plot", "Draw a figure for a paper (with Python's matplotlib)");
  add(*plot, "directories", arguments.plot.directories, "DIR", "output directories of runs")->required();
  add_repeated(*plot, "--what", arguments.plot.what, "WHAT",
               "energy, force, momentum, pressure, pressure-map, probe:NAME.COLUMN or a column of history.csv; if "
               "repeated, each has a panel; or animation: the moving body")
      ->required();
  add(*plot, "-o,--output", arguments.plot.output, "FILE",
      "file of the figure: .svg, .pdf or .png; for an animation .gif or .mp4")
      ->required();
  add_repeated(*plot, "--label", arguments.plot.labels, "TEXT", "label of a run, in the order of the runs");
  add(*plot, "--title", arguments.plot.title, "TEXT", "title, a line above the figure");
  add(*plot, "--time", arguments.plot.time, "A:B", "the interval of time to show");
  add(*plot, "--size", arguments.plot.size, "WxH", "width and height in cm");
  plot->add_flag("--log", arguments.plot.logarithmic, "use a logarithmic scale");
  add(*plot, "--field", arguments.plot.field, "FIELD", "the field that colours an animation (default: von_mises)");
  add(*plot, "--at", arguments.plot.at, "T", "draw only the frame of an animation at this time, as .png, .svg or .pdf");
  plot->add_flag("--zoom", arguments.plot.zoom, "show the contact of an animation in close-up");
  plot->add_flag("--half", arguments.plot.half, "draw only the section of an axisymmetric body");
  add_common(*plot, arguments.log_level);

  add_study(app, arguments.study, arguments.log_level);
  add_benchmark(app, arguments.benchmark, arguments.log_level);

  CLI::App* schema = app.add_subcommand("schema", "Print the JSON Schema of the case file, or of summary.json");
  CLI::Option* markdown =
      schema->add_flag("--markdown", arguments.schema.markdown, "print the reference page of the case file instead");
  CLI::Option* columns =
      schema->add_flag("--columns", arguments.schema.columns, "print the tables of the columns of history.csv instead")
          ->excludes(markdown);
  schema->add_flag("--summary", arguments.schema.summary, "print the schema of summary.json instead")
      ->excludes(markdown)
      ->excludes(columns);

  CLI::App* completion =
      app.add_subcommand("completion", "Print the script with which a shell completes the words of a ricochet command");
  add(*completion, "shell", arguments.shell, "SHELL", "bash, zsh or fish")->required();

  if (handle_internal_command(app, argc, argv)) return 0;
  program::refuse_empty_values(app);
  program::refuse_unknown_command(app, argc > 1 ? argv[1] : "");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& problem) {
    if (problem.get_exit_code() == 0) program::require_standard_output();  // --help, --version
    std::ostringstream text;
    const int status = app.exit(problem, text, std::cerr);
    std::fputs(text.str().c_str(), stdout);
    return status == 0 ? 0 : int(ErrorKind::usage);
  }
  if (info->parsed() || validate->parsed() || schema->parsed() || completion->parsed() ||
      (contact->parsed() && arguments.contact.output.empty()))
    program::require_standard_output();
  log::set_level(log::parse_level(arguments.log_level));
  if (arguments.run.quiet && log::enabled(log::Level::info) && !log::enabled(log::Level::debug))
    log::set_level(log::Level::warning);
  set_thread_count(arguments.threads);
  if (run->parsed() || validate->parsed() || info->parsed() || contact->parsed())
    reserve_blas_memory(arguments.threads);
  if (run->parsed()) return program::run(arguments.run);
  if (validate->parsed()) return program::validate(arguments.validate);
  if (info->parsed()) return program::info(arguments.info);
  if (contact->parsed()) return program::contact(arguments.contact);
  if (plot->parsed()) return program::plot(arguments.plot);
  if (app.got_subcommand("study")) return program::study(arguments.study);
  if (app.got_subcommand("benchmark")) return program::benchmark(arguments.benchmark);
  if (report->parsed()) return program::report(arguments.report);
  if (completion->parsed()) {
    std::fputs(program::completion_script(arguments.shell).c_str(), stdout);
    return 0;
  }
  return program::schema(arguments.schema);
}

/// Returns the exit status; reports errors.
int run_program(int argc, char** argv) {
  try {
    prepare_blas();  // before there are threads; and a wrong environment is refused for every command
    program::wait_for_stop_signals("ricochet");
    const int status = dispatch(argc, argv);
    program::flush_standard_output();
    return status;
  } catch (const Error& problem) {
    std::fprintf(stderr, "ricochet: %s\n", log::with_run_name(problem.what()).c_str());
    return problem.exit_status();
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "ricochet: %s\n",
                 log::with_run_name(
                     "out of memory; use a coarser mesh, or ricochet-mpi on several machines (docs/distributed.md)")
                     .c_str());
    return int(ErrorKind::not_converged);
  } catch (const std::filesystem::filesystem_error& problem) {
    std::fprintf(stderr, "ricochet: %s: %s\n", problem.path1().c_str(), problem.code().message().c_str());
    return int(ErrorKind::file_access);
  } catch (const std::exception& problem) {
    if (program::standard_output_failed()) {
      std::fprintf(stderr, "ricochet: standard output: %s\n", problem.what());
      return int(ErrorKind::file_access);
    }
    std::fprintf(stderr, "ricochet: internal error: %s\n", problem.what());
    return 70;
  }
}

}  // namespace

int main(int argc, char** argv) {
  ricochet::program::restart_without_blas_threads(argv);
  ricochet::program::keep_memory();
  ricochet::program::open_closed_streams();
  return run_program(argc, argv);
}
