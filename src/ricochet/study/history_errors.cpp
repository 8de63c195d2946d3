#include "ricochet/study/history_errors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

/// Returns the columns NAME_x, NAME_y, NAME_z, as far as they exist.
std::vector<std::string> components_of(const std::string& name, const HistoryTable& table) {
  std::vector<std::string> columns;
  for (const char* axis : {"_x", "_y", "_z"}) {
    if (table.columns.contains(name + axis)) columns.push_back(name + axis);
  }
  return columns;
}

/// A column as a function of time, at the scheme's own instants.
class TimeFunction {
 public:
  TimeFunction(const RunHistory& run, const std::string& column)
      : times_(run.table.columns.at("time")),
        values_(run.table.columns.at(column)),
        delay_(run.summary.delay_of(column)) {}

  [[nodiscard]] std::size_t rows() const { return values_.size(); }
  [[nodiscard]] double time(std::size_t row) const { return times_[row] + delay_; }
  [[nodiscard]] double value(std::size_t row) const { return values_[row]; }

  /// Interpolates linearly between rows. A time that rounding puts beyond the first or last row counts as that row.
  [[nodiscard]] std::optional<double> at(double time) const {
    const double shifted_time = time - delay_;
    const double slack = 1e-9 * std::max(std::abs(times_.front()), std::abs(times_.back()));
    if (shifted_time < times_.front() - slack || shifted_time > times_.back() + slack) return std::nullopt;
    const auto above = std::ranges::upper_bound(times_, shifted_time);
    if (above == times_.begin()) return values_.front();
    if (above == times_.end()) return values_.back();
    const auto i = std::size_t(above - times_.begin());
    const double part = (shifted_time - times_[i - 1]) / (times_[i] - times_[i - 1]);
    return (1.0 - part) * values_[i - 1] + part * values_[i];
  }

 private:
  const std::vector<double>& times_;
  const std::vector<double>& values_;
  double delay_;
};

/// Time integrals of the squared error and the squared reference, for one component.
struct Squares {
  double error = 0.0, reference = 0.0;
  long intervals = 0;
};

Squares integrate_squares(const TimeFunction& run, const TimeFunction& reference) {
  Squares sum;
  double error_before = 0.0, reference_before = 0.0, time_before = 0.0;
  bool has_before = false;
  for (std::size_t row = 0; row < run.rows(); ++row) {
    const double time = run.time(row);
    const std::optional<double> expected = reference.at(time);
    if (!expected) {
      has_before = false;
      continue;
    }
    const double error = (run.value(row) - *expected) * (run.value(row) - *expected);
    const double size = *expected * *expected;
    if (has_before) {
      sum.error += 0.5 * (time - time_before) * (error + error_before);
      sum.reference += 0.5 * (time - time_before) * (size + reference_before);
      ++sum.intervals;
    }
    error_before = error;
    reference_before = size;
    time_before = time;
    has_before = true;
  }
  return sum;
}

bool has_rows(const RunHistory& run, const std::string& column) {
  const auto found = run.table.columns.find(column), time = run.table.columns.find("time");
  return found != run.table.columns.end() && time != run.table.columns.end() && !found->second.empty();
}

}  // namespace

ComparedQuantity find_compared(const std::string& name, const HistoryTable& table) {
  if (table.columns.contains(name)) return {name, {name}};
  const std::vector<std::string> columns = components_of(name, table);
  if (!columns.empty()) return {name, columns};
  const std::string near = nearest_name(name, table.names);
  throw Error(ErrorKind::usage, fmt::format("--compare {}: the history of the reference has no such column or vector{}",
                                            name, near.empty() ? "" : fmt::format("; did you mean \"{}\"?", near)));
}

std::vector<ComparedQuantity> usual_compared(const HistoryTable& table) {
  std::vector<ComparedQuantity> result{find_compared("kinetic_energy", table)};
  if (const auto force = components_of("contact_force", table); !force.empty())
    result.push_back({"contact_force", force});
  const std::string first = "_x";
  for (const std::string& column : table.names) {
    if (!column.starts_with("pair_force.") || !column.ends_with(first)) continue;
    const std::string pair = column.substr(0, column.size() - first.size());
    result.push_back({pair, components_of(pair, table)});
  }
  const std::string suffix = ".displacement_x";
  for (const std::string& column : table.names) {
    if (!column.ends_with(suffix)) continue;
    const std::string vector = column.substr(0, column.size() - 2);
    result.push_back({vector, components_of(vector, table)});
  }
  return result;
}

std::optional<double> relative_error(const ComparedQuantity& quantity, const RunHistory& run,
                                     const RunHistory& reference) {
  Squares sum;
  for (const std::string& column : quantity.columns) {
    if (!has_rows(run, column) || !has_rows(reference, column)) return std::nullopt;
    const Squares part = integrate_squares(TimeFunction(run, column), TimeFunction(reference, column));
    sum.error += part.error;
    sum.reference += part.reference;
    sum.intervals = std::max(sum.intervals, part.intervals);
  }
  if (sum.intervals == 0 || !(sum.reference > 0.0)) return std::nullopt;
  return std::sqrt(sum.error / sum.reference);
}

std::optional<double> observed_order(double error_1, double error_2, double step_1, double step_2) {
  const double order = std::log(error_1 / error_2) / std::log(step_1 / step_2);
  if (!std::isfinite(order)) return std::nullopt;
  return order;
}

}  // namespace ricochet
