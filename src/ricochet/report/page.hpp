#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// @file The report: a self-contained HTML file that shows one run or several.
namespace ricochet {

struct ReportOptions {
  std::string viewer;                   ///< path of the viewer, an HTML file built from viewer/
  std::size_t most_bytes = 20'000'000;  ///< of the file; larger runs are thinned
};

struct Report {
  std::string html;
  std::vector<std::string> thinned;  ///< parts of the runs that are left out, one sentence each
};

/// Throws Error(file_access) if the viewer or a run is missing, Error(invalid_input) if files are damaged, Error(usage)
/// if a directory is named twice.
[[nodiscard]] Report make_report(const std::vector<std::string>& directories, const ReportOptions& options);

/// Returns true if make_report has made this file.
[[nodiscard]] bool is_report(const std::string& path);
/// Returns true if it is one of these directories, however they are spelled.
[[nodiscard]] bool is_report_of(const std::string& path, const std::vector<std::string>& directories);

}  // namespace ricochet
