#include <fmt/format.h>

#include <filesystem>

#include "commands.hpp"
#include "installed_files.hpp"
#include "reading_runs.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/report/page.hpp"
#include "ricochet/report/run_data.hpp"

namespace ricochet::program {

namespace {

namespace fs = std::filesystem;

std::string viewer_file() {
  const std::string path = installed_file("viewer.html");
  if (path.empty()) {
    throw Error(
        ErrorKind::file_access,
        "share/ricochet/viewer.html, which reports are made of, is missing beside this program: build or install "
        "Ricochet again");
  }
  return path;
}

}  // namespace

int report(const ReportArguments& arguments) {
  ReportOptions options;
  options.viewer = viewer_file();
  options.most_bytes = static_cast<std::size_t>(arguments.most_megabytes * 1e6);
  const std::string output = arguments.output.empty()
                                 ? (fs::path(common_folder(arguments.directories)) / "report.html").string()
                                 : arguments.output;
  if (fs::exists(output) && !is_report(output)) {
    throw Error(ErrorKind::file_access,
                fmt::format("{}: is there and is no report: name another file with -o, or move it away", output));
  }
  if (arguments.output.empty() && fs::exists(output) && !is_report_of(output, arguments.directories)) {
    throw Error(ErrorKind::file_access,
                fmt::format("{}: is there and shows other runs: name another file with -o, or this one", output));
  }
  Report page;
  read_with_patience(arguments.directories, [&] { page = make_report(arguments.directories, options); });
  write_durably(output, page.html);
  for (const std::string& sentence : page.thinned) log::info(fmt::format("thinned: {}", sentence));
  fmt::print("{}: {:.1f} MB; open it in a browser\n", output, 1e-6 * static_cast<double>(page.html.size()));
  return 0;
}

}  // namespace ricochet::program
