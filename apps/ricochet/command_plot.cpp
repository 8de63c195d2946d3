#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>

#include "commands.hpp"
#include "installed_files.hpp"
#include "reading_runs.hpp"
#include "ricochet/base/child_process.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/python.hpp"
#include "ricochet/base/temporary_folder.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/report/figure.hpp"

namespace ricochet::program {

namespace {

namespace fs = std::filesystem;

double number(std::string_view text, const std::string& option, const char* wanted) {
  double value = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size())
    throw Error(ErrorKind::usage, fmt::format("{}: is no number in \"{}\"; {}", text, option, wanted));
  return value;
}

/// "A:B" and "WxH".
std::pair<double, double> two_numbers(const std::string& text, char separator, const char* wanted) {
  const std::size_t at = text.find(separator);
  if (at == std::string::npos) throw Error(ErrorKind::usage, fmt::format("\"{}\": {}", text, wanted));
  const std::string_view whole(text);
  const std::pair<double, double> result{number(whole.substr(0, at), text, wanted),
                                         number(whole.substr(at + 1), text, wanted)};
  return result;
}

std::string format_of(const std::string& output) {
  std::string extension = fs::path(output).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* known : {".svg", ".pdf", ".png"}) {
    if (extension == known) return extension.substr(1);
  }
  throw Error(ErrorKind::usage, fmt::format("{}: a figure is an .svg, .pdf or .png file", output));
}

FigureOptions options_of(const PlotArguments& arguments) {
  FigureOptions options;
  options.what = arguments.what;
  options.labels = arguments.labels;
  options.title = arguments.title;
  options.logarithmic = arguments.logarithmic;
  if (!arguments.time.empty()) {
    const char* wanted = "--time takes the first and the last time to be shown, like 0.02:0.05";
    options.time = two_numbers(arguments.time, ':', wanted);
    if (!(options.time->first < options.time->second)) throw Error(ErrorKind::usage, wanted);
  }
  if (!arguments.size.empty()) {
    const char* wanted = "--size takes width and height in cm, like 17x6";
    std::tie(options.width, options.height) = two_numbers(arguments.size, 'x', wanted);
    for (const double side : {options.width, options.height}) {
      if (!(side >= 2.0 && side <= 200.0)) throw Error(ErrorKind::usage, fmt::format("{}, from 2 to 200", wanted));
    }
  }
  return options;
}

void draw(const std::string& description, const std::string& format, const std::string& output) {
  const std::string script = installed_file("figure.py");
  if (script.empty()) {
    throw Error(ErrorKind::file_access,
                "share/ricochet/figure.py, which draws figures, is missing beside the program: "
                "install Ricochet again");
  }
  const TemporaryFolder workspace(fs::temp_directory_path(), "ricochet-plot");
  ChildProcess child;
  child.arguments = {python_program(), "-B", script, format, workspace.file("figure")};
  child.variables = {"MPLCONFIGDIR=" + workspace.file("matplotlib")};  // the user's own settings change nothing
  child.input = workspace.file("description.json");
  child.output = workspace.file("messages");
  std::ofstream(child.input) << description;
  const ChildOutcome outcome = run_child(child);
  if (outcome.is_absent())
    throw Error(ErrorKind::file_access,
                "figures are drawn by Python, which is not here: apt-get install python3-matplotlib");
  if (outcome.exit_status() == 3) {
    throw Error(ErrorKind::file_access,
                fmt::format("figures are drawn by Python's matplotlib, which is not here ({}): apt-get install "
                            "python3-matplotlib",
                            python_program()));
  }
  if (!outcome.succeeded()) {
    throw Error(ErrorKind::file_access, fmt::format("the figure could not be drawn: {} {}:\n{}", python_program(),
                                                    outcome.description(), read_file(workspace.file("messages"))));
  }
  // Under a temporary name first: what was there stays until all of the new file is.
  const std::string part = output + ".part";
  std::error_code problem;
  fs::copy_file(workspace.file("figure"), part, fs::copy_options::overwrite_existing, problem);
  if (!problem) fs::rename(part, output, problem);
  if (problem) throw Error(ErrorKind::file_access, fmt::format("{}: cannot be written: {}", output, problem.message()));
}

}  // namespace

int plot(const PlotArguments& arguments) {
  const std::string format = format_of(arguments.output);
  const FigureOptions options = options_of(arguments);
  const bool needs_fields = std::count(options.what.begin(), options.what.end(), "pressure-map") > 0;
  std::string description;
  read_with_patience(arguments.directories,
                     [&] { description = describe_figure(read_runs(arguments.directories, needs_fields), options); });
  draw(description, format, arguments.output);
  fmt::print("{}\n", arguments.output);
  return 0;
}

}  // namespace ricochet::program
