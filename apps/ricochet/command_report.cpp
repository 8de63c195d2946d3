#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "commands.hpp"
#include "drawing.hpp"
#include "installed_files.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/temporary_folder.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/report/page.hpp"
#include "ricochet/report/reading_runs.hpp"
#include "ricochet/report/run_data.hpp"
#include "ricochet/study/benchmark/benchmark_page.hpp"
#include "ricochet/study/run_state.hpp"
#include "ricochet/study/study_figure.hpp"
#include "ricochet/study/study_page.hpp"
#include "ricochet/study/study_table.hpp"

namespace ricochet::program {

namespace {

namespace fs = std::filesystem;

ReportOptions options_of(const ReportArguments& arguments) {
  ReportOptions options;
  options.viewer = installed_file("viewer.html", "the template of reports");
  options.most_bytes = std::size_t(arguments.most_megabytes * 1e6);
  return options;
}

/// Returns the file to write: the requested one, or `usual`. Refuses to overwrite anything but such a page.
std::string checked_output(const ReportArguments& arguments, const std::string& usual,
                           bool (*is_own)(const std::string& path), const char* what) {
  const std::string output = arguments.output.empty() ? usual : arguments.output;
  if (!fs::exists(output) || is_own(output)) return output;
  throw Error(ErrorKind::file_access,
              fmt::format("{}: exists and is not {}: name another file with -o, or move this one away", output, what));
}

void require_one_directory(const ReportArguments& arguments, const char* page) {
  if (arguments.directories.size() > 1)
    throw Error(ErrorKind::usage, fmt::format("report: the page of {}: name no other directory", page));
}

int write_page(const std::string& output, const std::string& page) {
  write_durably(output, page);
  fmt::print("{}: open it in a browser\n", output);
  return 0;
}

/// Number of runs that the viewer compares well on one page.
constexpr std::size_t most_runs_on_a_page = 12;

std::string svg_of(const std::string& description) {
  const TemporaryFolder workspace(fs::temp_directory_path(), "ricochet-study");
  draw_figure(description, "svg", workspace.file("figure.svg"));
  return read_file(workspace.file("figure.svg"));
}

/// Writes a page of the study's first completed runs beside the page of the study. Returns its name, or "" if there are
/// none.
std::string write_page_of_runs(const Study& study, const ReportArguments& arguments) {
  std::vector<std::string> directories;
  for (const StudyRun& run : study.runs) {
    const RunState state = read_run_state(study.path(run));  // does not refuse runs of other versions
    if (state.summary && state.summary->status == "done") directories.push_back(study.path(run));
  }
  if (directories.empty()) return "";
  if (directories.size() > most_runs_on_a_page) {
    log::info(fmt::format("runs.html shows the first {} of {} runs; use `ricochet report` for pages of the others",
                          most_runs_on_a_page, directories.size()));
    directories.resize(most_runs_on_a_page);
  }
  write_durably(study.path("runs.html"), make_report(directories, options_of(arguments)).html);
  return "runs.html";
}

int report_study(const ReportArguments& arguments) {
  require_one_directory(arguments, "a study shows this study alone");
  const Study study = read_study(arguments.directories.front());
  const std::string output = checked_output(arguments, study.path("report.html"), is_study_page, "the page of a study");
  const StudyResults results = make_study_table(study);
  StudyFigureOptions figures;
  figures.what = usual_figures(study, results.table);
  const std::string figure = figures.what.empty() ? "" : svg_of(describe_study_figure(study, results.table, figures));
  const std::string runs = write_page_of_runs(study, arguments);
  return write_page(output, make_study_page(study, results, figure, runs, fs::absolute(output).parent_path().string()));
}

int report_benchmarks(const ReportArguments& arguments) {
  require_one_directory(arguments, "benchmarks shows these alone");
  const BenchmarkPlan plan = read_benchmark_plan(arguments.directories.front());
  const std::string output =
      checked_output(arguments, plan.path("report.html"), is_benchmark_page, "a page of benchmarks");
  const std::string folder = fs::absolute(output).parent_path().string();
  return write_page(output, make_benchmark_page(plan, read_benchmark_results(plan), folder));
}

}  // namespace

int report(const ReportArguments& arguments) {
  if (std::ranges::any_of(arguments.directories, holds_study)) return report_study(arguments);
  if (std::ranges::any_of(arguments.directories, holds_benchmarks)) return report_benchmarks(arguments);
  const ReportOptions options = options_of(arguments);
  const std::string folder = arguments.output.empty() ? common_folder(arguments.directories) : "";
  const std::string output =
      checked_output(arguments, (fs::path(folder) / "report.html").string(), is_report, "a report");
  if (arguments.output.empty() && fs::exists(output) && !is_report_of(output, arguments.directories)) {
    throw Error(ErrorKind::file_access,
                fmt::format("{}: exists and shows other runs: name another file with -o, or this one", output));
  }
  Report page;
  read_with_retries(arguments.directories, [&] { page = make_report(arguments.directories, options); });
  write_durably(output, page.html);
  for (const std::string& sentence : page.thinned) log::info(fmt::format("report: {}", sentence));
  fmt::print("{}: {:.1f} MB; open it in a browser\n", output, 1e-6 * double(page.html.size()));
  return 0;
}

}  // namespace ricochet::program
