#include "ricochet/run/quantity_value.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/io/summary.hpp"

namespace ricochet {

namespace {

/// Tolerance of times, relative to the distance of two rows: cases state times in decimals, rows hold sums of steps.
constexpr double same_time = 1e-6;

/// A column over time, linear between its points.
struct TimeSeries {
  std::vector<double> times, values;

  [[nodiscard]] std::size_t size() const { return times.size(); }
  void add(double time, double value) {
    times.push_back(time);
    values.push_back(value);
  }
};

/// Position between a point and the next one.
struct TimePosition {
  std::size_t point = 0;
  double fraction = 0.0;  ///< fraction of the interval; 0 at the point itself
};

const std::vector<double>& column_of(const HistoryTable& history, const std::string& name) {
  const auto found = history.columns.find(name);
  if (found == history.columns.end()) throw Error(ErrorKind::invalid_input, no_such_column(name, history.names));
  if (found->second.empty())
    throw Error(ErrorKind::invalid_input, fmt::format("history.{}: history.csv has no rows", name));
  return found->second;
}

double value_in_row(const std::vector<double>& column, const Quantity& quantity) {
  const long rows = long(column.size());
  const long row = quantity.row < 0 ? rows + quantity.row : quantity.row;
  if (row < 0 || row >= rows) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("history.{}[{}]: history.csv has {}", quantity.name, quantity.row, counted(rows, "row")));
  }
  return column[std::size_t(row)];
}

TimePosition locate_time(const TimeSeries& course, double time, const std::string& column) {
  const std::vector<double>& times = course.times;
  if (times.size() > 1) {
    const auto later = std::upper_bound(times.begin() + 1, times.end() - 1, time);
    const auto next = std::size_t(later - times.begin());
    const double fraction = (time - times[next - 1]) / (times[next] - times[next - 1]);
    if (std::abs(fraction) <= same_time) return {next - 1};
    if (std::abs(fraction - 1.0) <= same_time) return {next};
    if (fraction > 0.0 && fraction < 1.0) return {next - 1, fraction};
  } else if (time == times.front()) {
    return {};
  }
  throw Error(
      ErrorKind::invalid_input,
      fmt::format("history.{}: the time {:.9g} is outside the rows of history.csv, which extend from {:.9g} to {:.9g}",
                  column, time, times.front(), times.back()));
}

double value_at(const TimeSeries& course, TimePosition position) {
  const double value = course.values[position.point];
  return position.fraction == 0.0 ? value : value + position.fraction * (course.values[position.point + 1] - value);
}

TimeSeries part_of(const TimeSeries& series, const TimeInterval& interval, const std::string& column) {
  const TimePosition begin = locate_time(series, interval.begin, column),
                     end = locate_time(series, interval.end, column);
  TimeSeries part;
  part.add(interval.begin, value_at(series, begin));
  const std::size_t last = end.point + (end.fraction > 0.0 ? 1 : 0);
  for (std::size_t i = begin.point + 1; i < last; ++i) part.add(series.times[i], series.values[i]);
  part.add(interval.end, value_at(series, end));
  return part;
}

double integral(const TimeSeries& course) {
  double sum = 0.0;
  for (std::size_t i = 1; i < course.size(); ++i)
    sum += 0.5 * (course.values[i] + course.values[i - 1]) * (course.times[i] - course.times[i - 1]);
  return sum;
}

double mean(const TimeSeries& course) {
  const double duration = course.times.back() - course.times.front();
  return course.size() == 1 ? course.values.front() : integral(course) / duration;
}

double total_variation(const TimeSeries& course) {
  double sum = 0.0;
  for (std::size_t i = 1; i < course.size(); ++i) sum += std::abs(course.values[i] - course.values[i - 1]);
  return sum;
}

double largest_absolute(const TimeSeries& course) {
  double largest = 0.0;
  for (const double value : course.values) largest = std::max(largest, std::abs(value));
  return largest;
}

[[noreturn]] void throw_no_event(const TimeSeries& course, const Quantity& quantity) {
  const auto [least, largest] = std::ranges::minmax_element(course.values);
  const bool above = quantity.threshold.above;
  throw Error(ErrorKind::invalid_input,
              fmt::format("history.{} is never {} {:g}: its {} value from {:.9g} to {:.9g} is {:.9g}", quantity.name,
                          above ? "above" : "below", quantity.threshold.level, above ? "largest" : "smallest",
                          course.times.front(), course.times.back(), above ? *largest : *least));
}

/// Returns the first or the last time at which a threshold is exceeded.
double time_of_event(const TimeSeries& course, const Quantity& quantity) {
  const auto [level, above] = quantity.threshold;
  const bool first = quantity.kind == Quantity::Kind::first_time;
  const std::size_t size = course.size();
  const auto point = [&](std::size_t i) { return first ? i : size - 1 - i; };
  for (std::size_t i = 0; i < size; ++i) {
    const double time = course.times[point(i)], value = course.values[point(i)];
    if (!(above ? value > level : value < level)) continue;
    if (i == 0) return time;
    const double time_before = course.times[point(i - 1)], value_before = course.values[point(i - 1)];
    return time_before + (time - time_before) * (level - value_before) / (value - value_before);
  }
  throw_no_event(course, quantity);
}

double value_of_course(const Quantity& quantity, const TimeSeries& course) {
  switch (quantity.kind) {
    case Quantity::Kind::maximum:
      return *std::ranges::max_element(course.values);
    case Quantity::Kind::minimum:
      return *std::ranges::min_element(course.values);
    case Quantity::Kind::maximum_absolute:
      return largest_absolute(course);
    case Quantity::Kind::total_variation:
      return total_variation(course);
    case Quantity::Kind::mean:
      return mean(course);
    case Quantity::Kind::integral:
      return integral(course);
    case Quantity::Kind::first_time:
    case Quantity::Kind::last_time:
      return time_of_event(course, quantity);
    case Quantity::Kind::value_at_time:
      return value_at(course, locate_time(course, quantity.time, quantity.name));
    case Quantity::Kind::history_value:
    case Quantity::Kind::summary_value:
      break;
  }
  return 0.0;
}

/// Returns the reason why no run with these steps has a row, or "".
std::string impossible_row(const TimeSection& time, const Quantity& quantity) {
  if (time.adaptive || quantity.kind != Quantity::Kind::history_value) return "";
  const long rows = step_count(time) + 1;
  if (quantity.row < rows && quantity.row >= -rows) return "";
  return fmt::format("the row {} is outside of history.csv, which has at most {}", quantity.row, counted(rows, "row"));
}

}  // namespace

std::string impossible_in(const TimeSection& time, const Quantity& quantity) {
  if (quantity.kind == Quantity::Kind::summary_value) return summary_path_problem(quantity.name);
  std::vector<double> times;
  if (quantity.kind == Quantity::Kind::value_at_time) times = {quantity.time};
  if (quantity.interval) times = {quantity.interval->begin, quantity.interval->end};
  const double end = run_end(time);
  for (const double instant : times) {
    if (instant < 0.0 || instant > end * (1.0 + 1e-9))
      return fmt::format("the time {:.9g} is outside the run, which extends from 0 to {:.9g}", instant, end);
  }
  return impossible_row(time, quantity);
}

std::string required_column(const Quantity& quantity) {
  if (quantity.kind != Quantity::Kind::summary_value) return quantity.name;
  const std::string extrema = "extrema.";
  const std::size_t end = quantity.name.rfind('.');
  if (!quantity.name.starts_with(extrema) || end <= extrema.size()) return "";
  return quantity.name.substr(extrema.size(), end - extrema.size());
}

std::string no_such_column(const std::string& name, const std::vector<std::string>& names) {
  const std::string near = nearest_name(name, names), own = name.substr(0, name.find('.') + 1);
  std::string hint = near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near);
  if (near.empty() && !own.empty()) {
    std::vector<std::string> same = names;
    std::erase_if(same, [&](const std::string& column) { return !column.starts_with(own); });
    if (!same.empty()) hint = fmt::format("; those of \"{}\" are {}", own.substr(0, own.size() - 1), join_names(same));
  }
  return fmt::format("history.csv has no column \"{}\"{}", name, hint);
}

std::string no_such_column(const Case& input, const std::string& name, const std::vector<std::string>& names) {
  for (const ProbeSection& probe : input.probes) {
    if (probe.every == 0 || !name.starts_with(probe.name + ".")) continue;
    return fmt::format(
        "history.csv has no column \"{}\": probe \"{}\" has \"every\", so its columns are in probes-{}.csv; remove "
        "\"every\"",
        name, probe.name, probe.every);
  }
  return no_such_column(name, names);
}

double value_of(const Quantity& quantity, const HistoryTable& history, const std::string& summary_json) {
  if (quantity.kind == Quantity::Kind::summary_value) return summary_value(summary_json, quantity.name);
  const std::vector<double>& column = column_of(history, quantity.name);
  if (quantity.kind == Quantity::Kind::history_value) return value_in_row(column, quantity);
  const TimeSeries series{column_of(history, "time"), column};
  return value_of_course(quantity, quantity.interval ? part_of(series, *quantity.interval, quantity.name) : series);
}

}  // namespace ricochet
