#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// @file The report: one HTML file that shows one run or several, with all that it needs inside.
namespace ricochet {

struct ReportOptions {
  std::string viewer;                   ///< path of the viewer, an HTML file built from viewer/
  std::size_t most_bytes = 20'000'000;  ///< of the file; runs that take more are thinned
};

struct Report {
  std::string html;
  std::vector<std::string> thinned;  ///< what of the runs is not in it, one sentence each
};

/// Throws Error(file_access) where the viewer or a run is missing, Error(invalid_input) where files are damaged,
/// Error(usage) where a directory is named twice.
[[nodiscard]] Report make_report(const std::vector<std::string>& directories, const ReportOptions& options);

/// Is this file one that make_report has made?
[[nodiscard]] bool is_report(const std::string& path);
/// Is it one of these directories, however they are spelled?
[[nodiscard]] bool is_report_of(const std::string& path, const std::vector<std::string>& directories);

}  // namespace ricochet
