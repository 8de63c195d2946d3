#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "commands.hpp"
#include "drawing.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/report/figure.hpp"
#include "ricochet/report/runs_figure.hpp"
#include "ricochet/study/study_figure.hpp"
#include "ricochet/study/study_table.hpp"

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

}  // namespace

namespace {

/// Of one study; a figure shows one.
std::string describe_study(const PlotArguments& arguments, const FigureOptions& options) {
  if (arguments.directories.size() > 1)
    throw Error(ErrorKind::usage, "plot: a figure of a study shows this study alone: name no other directory");
  if (options.time || !options.labels.empty())
    throw Error(ErrorKind::usage, "plot: --time and --label are for figures of runs, and this is a study");
  const Study study = read_study(arguments.directories.front());
  return describe_study_figure(study, make_study_table(study).table,
                               {options.what, options.title, options.logarithmic, options.width, options.height});
}

}  // namespace

int plot(const PlotArguments& arguments) {
  const std::string format = format_of(arguments.output);
  const FigureOptions options = options_of(arguments);
  if (std::any_of(arguments.directories.begin(), arguments.directories.end(), holds_study)) {
    draw_figure(describe_study(arguments, options), format, arguments.output);
    fmt::print("{}\n", arguments.output);
    return 0;
  }
  draw_figure(describe_figure_of(arguments.directories, options), format, arguments.output);
  fmt::print("{}\n", arguments.output);
  return 0;
}

}  // namespace ricochet::program
