#include "drawing.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "installed_files.hpp"
#include "ricochet/base/child_process.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/python.hpp"
#include "ricochet/base/temporary_folder.hpp"
#include "ricochet/io/durable_file.hpp"

namespace ricochet::program {

namespace fs = std::filesystem;

void draw_figure(const std::string& description, const std::string& format, const std::string& output) {
  const std::string script = installed_file("figure.py", "which draws figures");
  const TemporaryFolder workspace(fs::temp_directory_path(), "ricochet-plot");
  ChildProcess child;
  child.arguments = {python_program(), "-B", script, format, workspace.file("figure")};
  child.variables = {"MPLCONFIGDIR=" + workspace.file("matplotlib")};  // settings of the user have no effect
  child.input = workspace.file("description.json");
  child.output = workspace.file("messages");
  std::ofstream(child.input) << description;
  const ChildResult result = run_child(child);
  if (result.is_absent())
    throw Error(ErrorKind::file_access,
                "figures require Python, which is not installed: apt-get install python3-matplotlib");
  if (result.exit_status() == 3) {
    throw Error(
        ErrorKind::file_access,
        fmt::format(
            "figures require Python's matplotlib, which is not installed ({}): apt-get install python3-matplotlib",
            python_program()));
  }
  if (result.exit_status() == 5) {
    throw Error(ErrorKind::file_access,
                "an .mp4 file requires ffmpeg, which is not installed: apt-get install ffmpeg, or write a .gif");
  }
  if (!result.succeeded()) {
    throw Error(ErrorKind::file_access, fmt::format("the figure could not be drawn: {} {}:\n{}", python_program(),
                                                    result.description(), read_file(workspace.file("messages"))));
  }
  // Written under a temporary name first: the old file stays until the new one is complete.
  const std::string part = output + ".part";
  std::error_code problem;
  fs::copy_file(workspace.file("figure"), part, fs::copy_options::overwrite_existing, problem);
  if (!problem) fs::rename(part, output, problem);
  if (problem) throw Error(ErrorKind::file_access, fmt::format("{}: cannot be written: {}", output, problem.message()));
}

int write_figure(const std::string& description, const std::string& format, const std::string& output) {
  draw_figure(description, format, output);
  fmt::print("{}\n", output);
  return 0;
}

}  // namespace ricochet::program
