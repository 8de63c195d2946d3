#include "ricochet/mesh/convert_process.hpp"

#include <fmt/format.h>

#include <deque>
#include <fstream>
#include <set>

#include "ricochet/base/child_process.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/python.hpp"
#include "ricochet/base/temporary_folder.hpp"
#include "ricochet/mesh/converter_files.hpp"
#include "ricochet/mesh/mesh_cache.hpp"
#include "ricochet/mesh/read_mesh.hpp"

namespace ricochet::gmsh {

namespace fs = std::filesystem;

namespace {

struct Response {
  ChildResult result;
  std::deque<std::string> last_lines;

  [[nodiscard]] std::string last_line() const { return last_lines.empty() ? "" : last_lines.back(); }
};

Response run(const std::vector<std::string>& arguments, const fs::path& workspace) {
  const fs::path script = workspace / "convert_mesh.py";
  for (const ConverterFile& file : converter_files())
    std::ofstream(workspace / file.name, std::ios::binary) << file.text;
  ChildProcess python;
  python.arguments = {python_program(), "-B", script.string()};
  python.arguments.insert(python.arguments.end(), arguments.begin(), arguments.end());
  python.variables = {"PYTHONIOENCODING=utf-8:surrogateescape"};
  python.output = (workspace / "convert.log").string();
  Response response;
  response.result = run_child(python);
  constexpr std::size_t shown = 6;
  std::ifstream log(python.output);
  for (std::string line; std::getline(log, line);) {
    if (line.find_first_not_of(" \t") == std::string::npos) continue;
    response.last_lines.push_back(line);
    if (response.last_lines.size() > shown) response.last_lines.pop_front();
  }
  return response;
}

[[noreturn]] void fail(const std::string& message) { throw Error(ErrorKind::invalid_input, message); }

/// Exit statuses of convert_mesh.py.
constexpr int refused = 2, package_missing = 3;

void check(const Response& response, const std::string& source) {
  if (response.result.succeeded()) return;
  if (response.result.is_absent() || response.result.exit_status() == package_missing) {
    fail(
        fmt::format("{}: files of this format are read with Python's meshio, and a package is missing: apt-get install "
                    "{} (or convert the file to .msh on a machine that has it)",
                    source, response.result.is_absent() ? "python3-meshio" : response.last_line()));
  }
  if (response.result.exit_status() == refused) fail(response.last_line());
  std::string text;
  for (const std::string& line : response.last_lines) text += "\n  " + line;
  fail(fmt::format("{}: the file could not be read: {} {}{}", source, python_program(), response.result.description(),
                   text.empty() ? " without any output" : ":" + text));
}

}  // namespace

std::string converter_version(const std::string& source) {
  const TemporaryFolder workspace(fs::temp_directory_path(), "ricochet-converter");
  const Response response = run({"--version"}, workspace.path());
  check(response, source);
  std::string program;
  for (const ConverterFile& file : converter_files()) program += file.name + "\n" + file.text;
  return response.last_line() + "\n" + fnv1a_128(program);
}

void convert_mesh(const std::string& input, const fs::path& workspace, const fs::path& output) {
  check(run({input, output.string()}, workspace), input);
}

void repeat_notes(std::string_view content, const std::string& source) {
  constexpr std::string_view opening = "\n$Notes\n", closing = "$EndNotes\n";
  constexpr std::size_t head = 100;  // the section is the first behind $MeshFormat
  const std::size_t start = content.substr(0, head).find(opening);
  if (start == std::string_view::npos) return;
  std::string_view notes = content.substr(start + opening.size());
  notes = notes.substr(0, notes.find(closing));
  constexpr std::string_view note = "note: ", warning = "warning: ";
  while (!notes.empty()) {
    const std::size_t end = std::min(notes.find('\n'), notes.size());
    const std::string_view line = notes.substr(0, end);
    notes.remove_prefix(std::min(end + 1, notes.size()));
    if (line.starts_with(note)) log::info(fmt::format("{}: {}", source, line.substr(note.size())));
    if (line.starts_with(warning)) log::warning(fmt::format("{}: {}", source, line.substr(warning.size())));
  }
}

}  // namespace ricochet::gmsh

namespace ricochet {

bool is_foreign_mesh(const std::string& path) {
  static const std::set<std::string> extensions{".inp",   ".vtk", ".vtu",  ".med",  ".e",      ".exo",  ".ex2",
                                                ".xdmf",  ".xmf", ".cgns", ".h5m",  ".hmf",    ".avs",  ".mesh",
                                                ".meshb", ".bdf", ".nas",  ".fem",  ".f3grid", ".mdpa", ".ugrid",
                                                ".su2",   ".vol", ".ele",  ".node", ".tec",    ".xml"};
  return extensions.contains(gmsh::extension_of(path));
}

}  // namespace ricochet
