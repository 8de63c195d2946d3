#include "ricochet/report/figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/json.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/report/contact_line.hpp"
#include "ricochet/report/history_part.hpp"
#include "ricochet/report/judgement.hpp"

namespace ricochet {

namespace {

/// Largest number of points of a curve: more are not visible and make large files.
constexpr std::size_t most_points = 20'000;
/// Ratio of a run's extent to that of the others from which its curve is cut off, so that it does not hide them.
constexpr double outlying = 8.0;

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  [[nodiscard]] double farthest() const { return std::abs(high) >= std::abs(low) ? high : low; }
  [[nodiscard]] double reach() const { return std::max(std::abs(low), std::abs(high)); }
};

struct Curve {
  std::string label;
  std::size_t run;
  std::vector<double> times, values;
  Extent extent;
};

/// A quantity that a panel shows for a run, and its name.
struct Quantity {
  std::string column, name;
  bool from_zero = false;
};

[[noreturn]] void refuse(const std::string& message) { throw Error(ErrorKind::usage, message); }

double spread(const std::vector<double>& values) {
  if (values.empty()) return 0.0;
  const auto [least, largest] = std::ranges::minmax_element(values);
  return *largest - *least;
}

/// Returns the component with the largest range.
std::string largest_component(const RunData& run, const std::string& vector) {
  std::string best;
  for (const char* axis : {"_x", "_y", "_z"}) {
    if (!run.has_column(vector + axis)) continue;
    if (best.empty() || spread(run.column(vector + axis)) > spread(run.column(best))) best = vector + axis;
  }
  return best;
}

/// Returns the component of the force on obstacles, or of the one between two bodies with a larger range.
std::string force_component(const RunData& run) {
  std::string best = largest_component(run, "contact_force");
  for (std::size_t i = 0; i < run.summary.contacts.size(); ++i) {
    const std::string pair = largest_component(run, fmt::format("pair_force.{}", i));
    if (!pair.empty() && spread(run.column(pair)) > spread(run.column(best))) best = pair;
  }
  return best;
}

std::string in_words(std::string column) {
  std::ranges::replace(column, '_', ' ');
  if (const std::size_t dot = column.find('.'); dot != std::string::npos) column.replace(dot, 1, ": ");
  return column;
}

Quantity quantity_of(const std::string& what, const RunData& run) {
  if (what == "energy") return {"total_energy", "total energy", true};
  if (what == "force" || what == "momentum") {
    const std::string column = what == "force" ? force_component(run) : largest_component(run, "momentum");
    return {column, in_words(column), what == "force"};
  }
  if (what == "pressure") {
    const Probe* probe = run.contact_probe();
    if (probe == nullptr) {
      refuse(
          fmt::format("{}: no probe of this run is a node on the contact boundary: add a [[probe]] there, or use "
                      "--what pressure-map",
                      run.directory));
    }
    return {probe->name + ".pressure", fmt::format("contact pressure ({})", probe->name), true};
  }
  const std::string column = what.starts_with("probe:") ? what.substr(6) : what;
  if (!run.has_column(column)) {
    const std::string near = nearest_name(column, run.column_names());
    refuse(
        fmt::format("--what {}: {}/history.csv has no column \"{}\"{}; available: energy, force, momentum, pressure, "
                    "pressure-map, probe:NAME.COLUMN and the columns of history.csv",
                    what, run.directory, column, near.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", near)));
  }
  return {column, in_words(column), false};
}

Curve curve_of(const RunData& run, std::size_t number, const std::string& label, const std::string& column,
               const FigureOptions& options) {
  Curve curve{label, number, {}, {}, {}};
  const std::vector<double>&times = run.times_of(column), &values = run.column(column);
  const double shift = run.summary.delay_of(column);
  for (std::size_t i = 0; i < times.size(); ++i) {
    const double time = times[i] + shift;
    if (options.time && (time < options.time->first || time > options.time->second)) continue;
    curve.times.push_back(time);
    // Values that cannot be shown leave a gap in the curve.
    const bool shown = std::isfinite(values[i]) && (!options.logarithmic || values[i] > 0.0);
    curve.values.push_back(shown ? values[i] : std::numeric_limits<double>::quiet_NaN());
    if (shown) curve.extent.add(values[i]);
  }
  if (!(curve.extent.low <= curve.extent.high)) {
    refuse(fmt::format("{}: \"{}\" has nothing to draw{}{}", run.directory, column,
                       options.time ? " in this time interval" : "",
                       options.logarithmic ? ": a logarithmic scale shows only positive values" : ""));
  }
  if (curve.times.size() > most_points) {
    const std::size_t rows = (2 * curve.times.size() + most_points - 1) / most_points;
    curve.times = thinned(curve.times, rows);
    curve.values = thinned(curve.values, rows);
  }
  return curve;
}

/// Chooses the range such that all curves are shown except those whose extent is many times that of the others; these
/// get a note.
void choose_range(const std::vector<Curve>& curves, bool from_zero, Json& panel) {
  std::vector<double> reaches;
  for (const Curve& curve : curves) reaches.push_back(curve.extent.reach());
  std::ranges::sort(reaches);
  const double middle = reaches[(reaches.size() - 1) / 2];
  Extent inside, outside;
  panel["notes"] = Json::array();
  for (const Curve& curve : curves) {
    const bool leaves = middle > 0.0 && curve.extent.reach() > outlying * middle;
    (leaves ? outside : inside).add(curve.extent.low);
    (leaves ? outside : inside).add(curve.extent.high);
    if (leaves) panel["notes"].push_back({curve.label, curve.extent.farthest()});
  }
  if (from_zero) inside.add(0.0);
  const double height = inside.high - inside.low;
  double low = inside.low, high = inside.high;
  if (outside.high > high) high += 0.75 * height;
  if (outside.low < low) low -= 0.75 * height;
  if (low == high) {
    const double margin = low == 0.0 ? 1.0 : 0.1 * std::abs(low);
    low -= margin;
    high += margin;
  }
  if (std::isfinite(1.2 * (high - low))) panel["range"] = {low - 0.04 * (high - low), high + 0.1 * (high - low)};
}

/// `roughness` of the runs, see Judgement.
Json panel_of_curves(const std::vector<RunData>& runs, const std::vector<std::string>& labels,
                     const std::vector<double>& roughness, const std::string& what, const FigureOptions& options) {
  Json panel{{"kind", "curves"}, {"x_label", "time"}, {"logarithmic", options.logarithmic}};
  std::vector<Curve> curves;
  std::string name;
  bool from_zero = false;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Quantity quantity = quantity_of(what, runs[i]);
    if (i == 0) name = quantity.name;
    if (quantity.name != name) name = what == "force" ? "contact force (largest component)" : in_words(what);
    from_zero = quantity.from_zero;
    curves.push_back(curve_of(runs[i], i, labels[i], quantity.column, options));
  }
  panel["y_label"] = name;
  if (!options.logarithmic) choose_range(curves, from_zero, panel);
  // Smooth curves are drawn over those that oscillate.
  std::ranges::stable_sort(curves, [&](const Curve& a, const Curve& b) { return roughness[a.run] > roughness[b.run]; });
  panel["curves"] = Json::array();
  Extent time;
  for (const Curve& curve : curves) {
    time.add(curve.times.front());
    time.add(curve.times.back());
    panel["curves"].push_back({{"label", curve.label},
                               {"run", curve.run},
                               {"rattles", name != "total energy" && roughness[curve.run] > 2.0},
                               {"x", curve.times},
                               {"y", curve.values}});
  }
  panel["times"] = {time.low, time.high};
  return panel;
}

Json panel_of_map(const RunData& run, const std::string& label, const FigureOptions& options) {
  const ResultField* field = run.results ? run.results->find_field("contact_pressure") : nullptr;
  if (field == nullptr) {
    refuse(fmt::format("{}: the run wrote no contact pressures (output.fields, output.fields_every)", run.directory));
  }
  const ContactLine line = make_contact_line(run.results->nodes(), run.results->contact_facets());
  if (line.position.empty()) {
    refuse(
        fmt::format("{}: a map of the pressure over time requires a contact boundary in the plane; `ricochet report` "
                    "shows the pressure on the surface of bodies in space",
                    run.directory));
  }
  Json panel{{"kind", "map"},
             {"title", label},
             {"x_label", "time"},
             {"y_label", "along the boundary"},
             {"y", line.position},
             {"pieces", line.pieces},
             {"x", Json::array()},
             {"values", Json::array()},
             {"value_label", "contact pressure"}};
  std::vector<float> values;
  std::vector<double> pressures;
  for (std::size_t frame = 0; frame < run.results->times().size(); ++frame) {
    const double time = run.results->times()[frame];
    if (options.time && (time < options.time->first || time > options.time->second)) continue;
    run.results->read(Index(frame), *field, values);
    Json row = Json::array();
    for (const Index node : line.nodes) {
      const auto value = double(values[std::size_t(node)]);
      row.push_back(value);
      if (value > 0.0) pressures.push_back(value);
    }
    panel["x"].push_back(time);
    panel["values"].push_back(std::move(row));
  }
  if (panel["x"].size() < 2) refuse(fmt::format("{}: there are fewer than two frames to draw", run.directory));
  // The scale ends at a percentile, so that a few peaks hide nothing.
  std::ranges::sort(pressures);
  panel["high"] = pressures.empty() ? 1.0 : pressures[(pressures.size() - 1) * 99 / 100];
  return panel;
}

}  // namespace

std::string describe_figure(const std::vector<RunData>& runs, const FigureOptions& options) {
  if (!options.labels.empty() && options.labels.size() != runs.size())
    refuse(fmt::format("--label appears {} times for {} runs", options.labels.size(), runs.size()));
  std::vector<std::string> labels = options.labels;
  std::vector<double> roughness;
  for (const RunData& run : runs) {
    if (labels.size() < runs.size()) labels.push_back(run.name);
    roughness.push_back(judge(run).roughness);
  }
  Json figure{{"title", options.title}, {"width", options.width}, {"height", options.height}};
  if (options.time) figure["time"] = {options.time->first, options.time->second};
  figure["panels"] = Json::array();
  for (const std::string& what : options.what) {
    if (what == "pressure-map") {
      for (std::size_t i = 0; i < runs.size(); ++i)
        figure["panels"].push_back(panel_of_map(runs[i], labels[i], options));
    } else {
      figure["panels"].push_back(panel_of_curves(runs, labels, roughness, what, options));
    }
  }
  return figure.dump();
}

}  // namespace ricochet
