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
#include "ricochet/study/study_figure.hpp"
#include "ricochet/study/study_page.hpp"
#include "ricochet/study/study_table.hpp"

namespace ricochet::program {

namespace {

namespace fs = std::filesystem;

std::string viewer_file() {
  const std::string path = installed_file("viewer.html");
  if (path.empty()) {
    throw Error(ErrorKind::file_access,
                "share/ricochet/viewer.html, the template of reports, is missing beside this program: build or install "
                "Ricochet again");
  }
  return path;
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
std::string write_page_of_runs(const Study& study, double most_megabytes) {
  std::vector<std::string> directories;
  for (const StudyRun& run : study.runs) {
    if (holds_run(study.path(run)) && read_summary_of_run(study.path(run)).status == "done")
      directories.push_back(study.path(run));
  }
  if (directories.empty()) return "";
  if (directories.size() > most_runs_on_a_page) {
    log::info(fmt::format("runs.html shows the first {} of {} runs; use `ricochet report` for pages of the others",
                          most_runs_on_a_page, directories.size()));
    directories.resize(most_runs_on_a_page);
  }
  ReportOptions options;
  options.viewer = viewer_file();
  options.most_bytes = static_cast<std::size_t>(most_megabytes * 1e6);
  write_durably(study.path("runs.html"), make_report(directories, options).html);
  return "runs.html";
}

int report_study(const ReportArguments& arguments) {
  if (arguments.directories.size() > 1)
    throw Error(ErrorKind::usage, "report: the page of a study shows this study alone: name no other directory");
  const Study study = read_study(arguments.directories.front());
  const std::string output = arguments.output.empty() ? study.path("report.html") : arguments.output;
  if (fs::exists(output) && !is_study_page(output)) {
    throw Error(
        ErrorKind::file_access,
        fmt::format("{}: exists and is not the page of a study: name another file with -o, or move this one away",
                    output));
  }
  const StudyResults results = make_study_table(study);
  StudyFigureOptions figures;
  figures.what = usual_figures(study, results.table);
  const std::string figure = figures.what.empty() ? "" : svg_of(describe_study_figure(study, results.table, figures));
  const std::string runs = write_page_of_runs(study, arguments.most_megabytes);
  write_durably(output, make_study_page(study, results, figure, runs, fs::absolute(output).parent_path().string()));
  fmt::print("{}: open it in a browser\n", output);
  return 0;
}

int report_benchmarks(const ReportArguments& arguments) {
  if (arguments.directories.size() > 1)
    throw Error(ErrorKind::usage, "report: the page of benchmarks shows these alone: name no other directory");
  const BenchmarkPlan plan = read_benchmark_plan(arguments.directories.front());
  const std::string output = arguments.output.empty() ? plan.path("report.html") : arguments.output;
  if (fs::exists(output) && !is_benchmark_page(output)) {
    throw Error(
        ErrorKind::file_access,
        fmt::format("{}: exists and is not a page of benchmarks: name another file with -o, or move this one away",
                    output));
  }
  const std::string folder = fs::absolute(output).parent_path().string();
  write_durably(output, make_benchmark_page(plan, read_benchmark_results(plan), folder));
  fmt::print("{}: open it in a browser\n", output);
  return 0;
}

}  // namespace

int report(const ReportArguments& arguments) {
  if (std::any_of(arguments.directories.begin(), arguments.directories.end(), holds_study))
    return report_study(arguments);
  if (std::any_of(arguments.directories.begin(), arguments.directories.end(), holds_benchmarks))
    return report_benchmarks(arguments);
  ReportOptions options;
  options.viewer = viewer_file();
  options.most_bytes = static_cast<std::size_t>(arguments.most_megabytes * 1e6);
  const std::string output = arguments.output.empty()
                                 ? (fs::path(common_folder(arguments.directories)) / "report.html").string()
                                 : arguments.output;
  if (fs::exists(output) && !is_report(output)) {
    throw Error(
        ErrorKind::file_access,
        fmt::format("{}: exists and is not a report: name another file with -o, or move this one away", output));
  }
  if (arguments.output.empty() && fs::exists(output) && !is_report_of(output, arguments.directories)) {
    throw Error(ErrorKind::file_access,
                fmt::format("{}: exists and shows other runs: name another file with -o, or this one", output));
  }
  Report page;
  read_with_retries(arguments.directories, [&] { page = make_report(arguments.directories, options); });
  write_durably(output, page.html);
  for (const std::string& sentence : page.thinned) log::info(fmt::format("report: {}", sentence));
  fmt::print("{}: {:.1f} MB; open it in a browser\n", output, 1e-6 * static_cast<double>(page.html.size()));
  return 0;
}

}  // namespace ricochet::program
