#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "commands.hpp"
#include "drawing.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/report/animation.hpp"
#include "ricochet/report/figure.hpp"
#include "ricochet/report/runs_figure.hpp"
#include "ricochet/study/study_figure.hpp"
#include "ricochet/study/study_table.hpp"

namespace ricochet::program {

namespace {

namespace fs = std::filesystem;

double number(std::string_view text, const std::string& option, const char* hint) {
  const std::optional<double> value = number_in(text);
  if (!value) throw Error(ErrorKind::usage, fmt::format("{}: not a number in \"{}\"; {}", text, option, hint));
  return *value;
}

/// Parses "A:B" and "WxH".
std::pair<double, double> two_numbers(const std::string& text, char separator, const char* hint) {
  const std::size_t at = text.find(separator);
  if (at == std::string::npos) throw Error(ErrorKind::usage, fmt::format("\"{}\": {}", text, hint));
  const std::string_view view(text);
  const std::pair<double, double> result{number(view.substr(0, at), text, hint),
                                         number(view.substr(at + 1), text, hint)};
  return result;
}

/// Returns the format given by the extension of a file, which must be one of the supported ones.
std::string format_of(const std::string& output, std::initializer_list<const char*> formats, const char* what) {
  std::string extension = fs::path(output).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  for (const char* const supported : formats) {
    if (extension == std::string(".") + supported) return supported;
  }
  throw Error(ErrorKind::usage, fmt::format("{}: {}", output, what));
}

std::pair<double, double> interval_of(const std::string& text) {
  const char* const hint = "--time requires the first and the last time to show, for example 0.02:0.05";
  const std::pair<double, double> interval = two_numbers(text, ':', hint);
  if (!(interval.first < interval.second)) throw Error(ErrorKind::usage, hint);
  return interval;
}

std::pair<double, double> size_of(const std::string& text) {
  const char* const hint = "--size requires width and height in cm, for example 17x6";
  const std::pair<double, double> size = two_numbers(text, 'x', hint);
  for (const double side : {size.first, size.second}) {
    if (!(side >= 2.0 && side <= 200.0))
      throw Error(ErrorKind::usage, fmt::format("{}; each must be from 2 to 200", hint));
  }
  return size;
}

FigureOptions options_of(const PlotArguments& arguments) {
  FigureOptions options;
  options.what = arguments.what;
  options.labels = arguments.labels;
  options.title = arguments.title;
  options.logarithmic = arguments.logarithmic;
  if (!arguments.time.empty()) options.time = interval_of(arguments.time);
  if (!arguments.size.empty()) std::tie(options.width, options.height) = size_of(arguments.size);
  if (arguments.at || arguments.half || arguments.zoom || !arguments.field.empty())
    throw Error(ErrorKind::usage, "plot: --field, --at, --zoom and --half require --what animation");
  return options;
}

/// Draws the moving body of one run or, with --at, its state at one time.
int plot_animation(const PlotArguments& arguments) {
  if (arguments.what.size() > 1 || arguments.directories.size() > 1)
    throw Error(ErrorKind::usage,
                "plot: an animation shows one run and nothing else: name one directory and one --what");
  if (arguments.logarithmic || !arguments.labels.empty())
    throw Error(ErrorKind::usage, "plot: --log and --label apply to curves, not to --what animation");
  if (arguments.at && !arguments.time.empty())
    throw Error(ErrorKind::usage, "plot: --at selects one time, and --time a part of the run: use one of them");
  const std::string format =
      arguments.at
          ? format_of(arguments.output, {"png", "svg", "pdf"}, "a picture must be a .png, .svg or .pdf file")
          : format_of(arguments.output, {"gif", "mp4"},
                      "an animation must be a .gif or .mp4 file; with --at T a .png, .svg or .pdf file of one frame");
  AnimationOptions options;
  if (!arguments.field.empty()) options.field = arguments.field;
  options.time = arguments.at;
  if (!arguments.time.empty()) options.interval = interval_of(arguments.time);
  options.title = arguments.title;
  if (!arguments.size.empty()) {
    std::tie(options.width, options.height) = size_of(arguments.size);
    // The axes, their labels and the colour bar need this much space.
    constexpr double least = 6.0;
    if (options.width < least || options.height < least)
      throw Error(ErrorKind::usage,
                  fmt::format("--size of an animation must be {} cm or more in both directions", least));
  }
  options.half = arguments.half;
  options.zoom = arguments.zoom;
  return write_figure(describe_animation(arguments.directories.front(), options), format, arguments.output);
}

/// Describes the figure of a study; a figure shows only one study.
std::string describe_study(const PlotArguments& arguments, const FigureOptions& options) {
  if (arguments.directories.size() > 1)
    throw Error(ErrorKind::usage, "plot: a figure of a study shows this study alone: name no other directory");
  if (options.time || !options.labels.empty())
    throw Error(ErrorKind::usage, "plot: --time and --label apply to figures of runs, and this is a study");
  const Study study = read_study(arguments.directories.front());
  return describe_study_figure(study, make_study_table(study).table,
                               {options.what, options.title, options.logarithmic, options.width, options.height});
}

}  // namespace

int plot(const PlotArguments& arguments) {
  if (std::ranges::count(arguments.what, "animation") > 0) return plot_animation(arguments);
  const std::string format =
      format_of(arguments.output, {"svg", "pdf", "png"}, "a figure must be an .svg, .pdf or .png file");
  const FigureOptions options = options_of(arguments);
  const bool any_study = std::ranges::any_of(arguments.directories, holds_study);
  return write_figure(
      any_study ? describe_study(arguments, options) : describe_figure_of(arguments.directories, options), format,
      arguments.output);
}

}  // namespace ricochet::program
