#include "ricochet/mesh/gmsh_process.hpp"

#include <fmt/format.h>

#include <deque>
#include <fstream>

#include "ricochet/base/child_process.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/temporary_folder.hpp"

namespace ricochet::gmsh {

namespace {

[[noreturn]] void fail_absent(const std::string& source) {
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("{}: the gmsh program is needed to mesh this file and is not installed; install it (apt-get install "
                  "gmsh), or convert the file to .msh on a machine that has it",
                  source));
}

/// Runs gmsh with its output in `log`, without the user's own options, on which the mesh should not depend.
ChildResult run(std::vector<std::string> arguments, const std::filesystem::path& workspace,
                const std::filesystem::path& log) {
  arguments.insert(arguments.begin(), "gmsh");
  ChildProcess gmsh;
  gmsh.arguments = std::move(arguments);
  gmsh.variables = {"GMSH_HOME=" + workspace.string()};
  gmsh.output = log.string();
  return run_child(std::move(gmsh));
}

/// Returns the last lines of gmsh's output; if there are errors, warnings are dropped.
std::string last_lines(const std::filesystem::path& log) {
  constexpr std::size_t limit = 6;
  std::deque<std::string> all;
  std::deque<std::string> errors;
  std::ifstream stream(log);
  for (std::string line; std::getline(stream, line);) {
    if (line.empty()) continue;
    for (auto* lines : {&all, &errors}) {
      if (lines == &errors && !line.starts_with("Error")) continue;
      lines->push_back(line);
      if (lines->size() > limit) lines->pop_front();
    }
  }
  std::string text;
  for (const std::string& line : errors.empty() ? all : errors) text += "\n  " + line;
  return text.empty() ? " (no output)" : text;
}

void check_spawned(const ChildResult& result, const std::string& source) {
  if (result.is_absent()) fail_absent(source);
  if (result.spawn_error != 0) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: the gmsh program, needed to mesh this file, {}", source, result.description()));
  }
}

}  // namespace

std::string program_version(const std::string& source) {
  const TemporaryFolder workspace(std::filesystem::temp_directory_path(), "ricochet-gmsh-version");
  const std::filesystem::path log = workspace.path() / "log";
  const ChildResult result = run({"-version"}, workspace.path(), log);
  std::string version;
  std::string line;
  for (std::ifstream stream(log); std::getline(stream, line);) version += line;
  check_spawned(result, source);
  return version;
}

void run_program(const std::string& input, const std::string& options, const std::filesystem::path& workspace,
                 const std::filesystem::path& output) {
  // Merged after the input, so that these options override what the input sets.
  const std::filesystem::path options_file = workspace / "options.geo";
  std::ofstream(options_file) << options;
  const std::filesystem::path log = workspace / "gmsh.log";
  const std::string absolute = std::filesystem::absolute(input).string();
  std::vector<std::string> arguments{absolute, options_file.string()};
  arguments.insert(arguments.end(), command_options.begin(), command_options.end());
  arguments.insert(arguments.end(), {"-o", output.string()});
  const ChildResult result = run(std::move(arguments), workspace, log);
  check_spawned(result, input);
  std::error_code ignored;
  const bool written = std::filesystem::file_size(output, ignored) > 0 && !ignored;
  if (!result.succeeded() || !written) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("{}: gmsh could not mesh this file: it {}{}:{}", input, result.description(),
                            written ? "" : " and wrote no mesh", last_lines(log)));
  }
}

}  // namespace ricochet::gmsh
