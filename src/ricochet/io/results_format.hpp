#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/registry.hpp"

/// @file Formats of fields (`output.format`). A format is a registration at the end of the file of its writer, such as
/// xdmf_output.cpp, which names its files and the functions that write and read them.
namespace ricochet {

class FrameOutput;
struct FrameOutputContext;
struct ObstacleFrame;
class ResultsStorage;

struct ResultsFormat {
  std::string description;         ///< for the documentation of `output.format`
  std::vector<std::string> files;  ///< of the body; the first one has the values
  std::string obstacles;           ///< file of the surfaces of the obstacles
  /// File of a run that is locked while its frames are written or read. It is not an HDF5 file, as HDF5 locks its files
  /// itself.
  std::string lock;
  /// Makes the writer of a run's frames. Throws Error(file_access).
  std::unique_ptr<FrameOutput> (*write)(const FrameOutputContext& context) = nullptr;
  /// Opens the results in a directory, whose lock the caller holds. Throws Error(file_access) if files are missing,
  /// Error(invalid_input) if they are damaged.
  std::unique_ptr<ResultsStorage> (*open)(const std::string& directory, const ResultsFormat& format) = nullptr;
  /// Reads the file of the obstacles in a directory. Throws Error(file_access) or Error(invalid_input).
  std::vector<ObstacleFrame> (*read_obstacles)(const std::string& directory, const ResultsFormat& format) = nullptr;

  /// Names of the files, for messages: "results.h5 and results.xdmf".
  [[nodiscard]] std::string file_names() const { return join_names(files, " and ", false); }
};

/// Returns the formats that `output.format` may name.
Registry<ResultsFormat>& results_format_registry();
/// Returns a text of each format, joined by the separator, for messages and the documentation.
[[nodiscard]] std::string any_format(std::string (*text)(const ResultsFormat& format), const char* separator = " or ");
/// Names of the files that runs of any format leave.
[[nodiscard]] std::vector<std::string> files_of_all_formats();
/// Format of the files in a directory; null if there are no files of fields.
[[nodiscard]] const ResultsFormat* find_results_format(const std::string& directory);

}  // namespace ricochet
