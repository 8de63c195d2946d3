#include "ricochet/study/study_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "ricochet/base/error.hpp"
#include "ricochet/base/json.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/study/history_errors.hpp"
#include "ricochet/study/line_labels.hpp"
#include "ricochet/study/order_columns.hpp"
#include "ricochet/study/study_table.hpp"

namespace ricochet {

namespace {

constexpr std::string_view against = "-against-";

/// Contents of a panel: columns of the table, and the axis of the plan along which its lines extend.
struct StudyPanel {
  std::string x, y;
  std::string part = {};  ///< component for a key whose values are vectors: "x", "y", "z" or "length"; empty: chosen
  std::size_t axis = 0;
  bool log_x = false, log_y = false, has_slopes = false;
};

[[noreturn]] void refuse_figure(const std::string& what, const std::string& why) {
  throw Error(
      ErrorKind::usage,
      fmt::format("--what {}: {}; figures of a study are work-precision, order and COLUMN-against-KEY", what, why));
}

bool has_numbers(const ResultTable& table, const std::string& column) {
  const std::size_t c = table.find(column);
  return c < table.columns.size() &&
         std::ranges::any_of(table.rows, [c](const auto& row) { return std::isfinite(number_of(row[c])); });
}

std::vector<std::string> error_columns(const ResultTable& table) {
  std::vector<std::string> columns = table.names();
  std::erase_if(columns,
                [&](const std::string& name) { return !name.starts_with(error_prefix) || !has_numbers(table, name); });
  return columns;
}

void require_column(const std::string& what, const std::string& column, const ResultTable& table) {
  const std::vector<std::string> names = table.names();
  if (std::ranges::count(names, column) > 0) return;
  const std::string near = nearest_name(column, names);
  refuse_figure(what, fmt::format("study.csv has no column \"{}\"{}", column,
                                  near.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", near)));
}

/// Returns the components of a vector written as "[0, -0.5]"; empty if the text is not a vector.
std::vector<double> vector_in(const std::string& text) {
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') return {};
  std::vector<double> result;
  for (std::size_t begin = 1; begin < text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size() - 1);
    const std::size_t first = std::min(text.find_first_not_of(' ', begin), end);
    const std::optional<double> number = number_in(text.substr(first, end - first));
    if (!number) return {};
    result.push_back(*number);
    begin = end + 1;
  }
  return result;
}

/// Returns the vectors of a column, one per row; empty if some row has none or one of another dimension.
std::vector<std::vector<double>> vectors_of(const ResultTable& table, std::size_t column) {
  std::vector<std::vector<double>> result;
  for (const auto& row : table.rows) {
    result.push_back(vector_in(text_of(row[column])));
    if (result.back().empty() || result.back().size() != result.front().size()) return {};
  }
  return result;
}

/// Interprets "initial.velocity.y" as a component of the values of "initial.velocity".
void select_component(const ResultTable& table, StudyPanel& panel) {
  const std::size_t dot = panel.x.rfind('.');
  if (dot == std::string::npos || table.find(panel.x) < table.columns.size()) return;
  const std::string full_name = panel.x.substr(0, dot), part = panel.x.substr(dot + 1);
  const std::size_t column = table.find(full_name);
  if (column >= table.columns.size() || vectors_of(table, column).empty()) return;
  const std::size_t dimension = vectors_of(table, column).front().size();
  const std::size_t number = std::string("xyz").find(part);
  if (part != "length" && (part.size() != 1 || number >= dimension)) return;
  panel.x = full_name;
  panel.part = part;
}

/// Returns one number on the axis for each vector: the requested component, else the only component in which they
/// differ, else their length.
std::vector<double> numbers_of(const std::vector<std::vector<double>>& vectors, std::string& part) {
  std::vector<std::string> differing;
  for (std::size_t k = 0; k < vectors.front().size(); ++k) {
    const auto differs = [&](const std::vector<double>& vector) { return vector[k] != vectors.front()[k]; };
    if (std::ranges::any_of(vectors, differs)) differing.emplace_back(1, "xyz"[k]);
  }
  if (part.empty()) part = differing.size() == 1 ? differing.front() : "length";
  std::vector<double> numbers;
  for (const std::vector<double>& vector : vectors) {
    double length = 0.0;
    for (const double component : vector) length = std::hypot(length, component);
    numbers.push_back(part == "length" ? length : vector[std::string("xyz").find(part)]);
  }
  return numbers;
}

/// Returns the axis of a key; for any other column the axis along which orders are observed, else the last.
std::size_t axis_of(const std::string& column, const Study& study) {
  for (const std::string& key : {column, study.questions.order_key}) {
    const std::vector<std::string> keys = varied_keys(study.plan);
    if (std::ranges::count(keys, key) > 0) return find_varied(study.plan, key, "--what").axis;
  }
  return study.plan.axes.size() - 1;
}

std::vector<StudyPanel> panels_of(const std::string& what, const Study& study, const ResultTable& table,
                                  bool logarithmic) {
  if (const std::size_t at = what.find(against); at != std::string::npos) {
    StudyPanel panel{what.substr(at + against.size()), what.substr(0, at)};
    select_component(table, panel);
    require_column(what, panel.x, table);
    require_column(what, panel.y, table);
    panel.axis = axis_of(panel.x, study);
    panel.log_y = logarithmic;
    return {panel};
  }
  const std::size_t colon = what.find(':');
  const std::string kind = what.substr(0, colon);
  if (kind != "work-precision" && kind != "order") refuse_figure(what, "there is no such figure");
  std::vector<std::string> errors = error_columns(table);
  if (colon != std::string::npos) errors = {error_prefix + what.substr(colon + 1)};
  if (errors.empty())
    refuse_figure(
        what,
        "the table has no errors: run the study with --exact or --reference (with --resume if it exists already)");
  const bool of_order = kind == "order";
  if (of_order && study.questions.order_key.empty()) refuse_figure(what, "no key varies with numeric values");
  std::vector<StudyPanel> panels;
  for (const std::string& error : errors) {
    require_column(what, error, table);
    const std::string x = of_order ? study.questions.order_key : "processor_seconds";
    panels.push_back({x, error, {}, axis_of(x, study), true, true, of_order});
  }
  return panels;
}

/// Returns the label that distinguishes the runs of a line: the values of the other axes, and their kind along its own.
std::string line_label(const PlannedRun& run, const StudyPlan& plan, const StudyPanel& panel) {
  std::vector<std::size_t> others;
  for (std::size_t a = 0; a < plan.axes.size(); ++a) {
    if (a != panel.axis) others.push_back(a);
  }
  std::vector<std::string> parts{label_by_axes(run, plan, others),
                                 kinds_along(plan.axes[panel.axis], panel.x)[run.at[panel.axis]]};
  std::erase(parts, "");
  return fmt::format("{}", fmt::join(parts, ", "));
}

/// Returns a label for readers, such as "error of tip.displacement", without the prefixes for programs.
std::string axis_label(const std::string& column) {
  if (column.starts_with(error_prefix))
    return fmt::format("error of {}", axis_label(column.substr(std::string(error_prefix).size())));
  if (column == "processor_seconds") return "processor time, s";
  for (const std::string prefix : {"summary.", "history."}) {
    if (column.starts_with(prefix)) return column.substr(prefix.size());
  }
  std::string label = column;
  if (label.find('.') == std::string::npos) std::ranges::replace(label, '_', ' ');
  return label;
}

/// A line: its label and its points, in the order of the table.
struct StudyLine {
  std::string label;
  std::vector<double> x, y;
};

/// `numbers` holds the position of each row on the horizontal axis.
std::vector<StudyLine> lines_of(const StudyPanel& panel, const Study& study, const ResultTable& table,
                                const std::vector<double>& numbers) {
  const std::size_t y_column = table.find(panel.y);
  std::vector<StudyLine> lines;
  for (std::size_t i = 0; i < study.runs.size(); ++i) {
    const double x = panel.log_x ? step_of(panel.x, numbers[i]) : numbers[i];
    const double y = number_of(table.rows[i][y_column]);
    const bool is_shown =
        std::isfinite(x) && std::isfinite(y) && !(panel.log_x && x <= 0.0) && !(panel.log_y && y <= 0.0);
    if (!is_shown) continue;
    const std::string label = line_label(study.runs[i].planned, study.plan, panel);
    auto line = std::ranges::find_if(lines, [&](const StudyLine& other) { return other.label == label; });
    if (line == lines.end()) line = lines.insert(line, {label, {}, {}});
    line->x.push_back(x);
    line->y.push_back(y);
  }
  return lines;
}

/// Returns the orders between neighbouring points, from the first point on.
std::vector<double> orders_of(const StudyLine& line) {
  std::vector<double> orders;
  for (std::size_t i = 1; i < line.x.size(); ++i) {
    if (const auto order = observed_order(line.y[i - 1], line.y[i], line.x[i - 1], line.x[i])) orders.push_back(*order);
  }
  return orders;
}

/// Describes the integer orders nearest to the observed ones, as guides (at most two), and the last order of each line.
/// Points from which the error no longer decreases, and the order just before them, are excluded.
void describe_orders(const std::vector<StudyLine>& lines, const std::string& key, Json& panel) {
  std::map<long, int> found;
  std::vector<std::string> last;
  for (const StudyLine& line : lines) {
    std::vector<double> orders = orders_of(line);
    const bool ends_idle = !orders.empty() && find_stagnant_orders(key, orders).back();
    last.push_back(ends_idle ? "floor" : orders.empty() ? "-" : fmt::format("{:.2f}", orders.back()));
    if (line.x.front() < line.x.back()) std::ranges::reverse(orders);
    const std::vector<bool> idle = find_stagnant_orders(key, orders);
    const auto floor = std::size_t(std::ranges::find(idle, true) - idle.begin());
    if (floor < orders.size()) orders.resize(floor > 0 ? floor - 1 : 0);
    for (const double order : orders) {
      if (order > 0.5 && order < 4.5) ++found[std::lround(order)];
    }
  }
  std::vector<std::pair<int, long>> ranked;
  for (const auto& [order, count] : found) ranked.emplace_back(-count, order);
  std::ranges::sort(ranked);
  std::vector<long> slopes;
  for (std::size_t i = 0; i < std::min<std::size_t>(2, ranked.size()); ++i) slopes.push_back(ranked[i].second);
  std::ranges::sort(slopes);
  panel["slopes"] = Json(slopes);
  panel["note"] = fmt::format("last order{}: {}", last.size() > 1 ? "s" : "", fmt::join(last, ", "));
}

/// Returns true if the values span more than a factor of five; others are legible on a linear scale.
bool spans_much(const std::vector<StudyLine>& lines) {
  double least = std::numeric_limits<double>::infinity(), most = 0.0;
  for (const StudyLine& line : lines) {
    for (const double x : line.x) {
      least = std::min(least, x);
      most = std::max(most, x);
    }
  }
  return least > 0.0 && most > 5.0 * least;
}

/// Returns the position of each row on the axis: its number, that of a component of its vector, or the index of a word
/// among `categories`.
std::vector<double> axis_positions(const ResultTable& table, StudyPanel& panel, std::vector<std::string>& categories) {
  const std::size_t column = table.find(panel.x);
  if (const auto vectors = vectors_of(table, column); !vectors.empty()) return numbers_of(vectors, panel.part);
  std::vector<double> numbers, indices;
  bool all_numbers = true;
  for (const auto& row : table.rows) {
    const std::string text = text_of(row[column]);
    all_numbers = all_numbers && (text.empty() || number_in(text));
    const auto category = std::ranges::find(categories, text);
    indices.push_back(double(category - categories.begin()));
    numbers.push_back(number_of(row[column]));
    if (category == categories.end()) categories.push_back(text);
  }
  if (!all_numbers) return indices;
  categories.clear();
  return numbers;
}

std::string label_of_part(const StudyPanel& panel) {
  const std::string label = axis_label(panel.x);
  if (panel.part.empty()) return label;
  return panel.part == "length" ? "length of " + label : fmt::format("{}, {}", label, panel.part);
}

Json describe_panel(StudyPanel panel, const Study& study, const ResultTable& table, const std::string& what) {
  std::vector<std::string> categories;
  const std::vector<double> numbers = axis_positions(table, panel, categories);
  const std::vector<StudyLine> lines = lines_of(panel, study, table, numbers);
  if (lines.empty()) refuse_figure(what, fmt::format("no run has numbers in the columns {} and {}", panel.x, panel.y));
  Json json{{"kind", "lines"},
            {"x_label", (panel.log_x && counts_halvings(panel.x) ? "2^-" : "") + label_of_part(panel)},
            {"y_label", axis_label(panel.y)},
            {"log_y", panel.log_y},
            {"categories", categories},
            {"slopes", Json::array()},
            {"curves", Json::array()}};
  const std::vector<std::string> keys = varied_keys(study.plan);
  json["names_steps"] = std::ranges::count(keys, panel.x) > 0;
  json["log_x"] = panel.log_x || (categories.empty() && spans_much(lines));
  for (const StudyLine& line : lines) json["curves"].push_back({{"label", line.label}, {"x", line.x}, {"y", line.y}});
  json["note"] = "";
  if (panel.has_slopes) describe_orders(lines, panel.x, json);
  return json;
}

}  // namespace

std::string describe_study_figure(const Study& study, const ResultTable& table, const StudyFigureOptions& options) {
  Json figure{{"title", options.title}, {"width", options.width}, {"height", options.height}};
  figure["panels"] = Json::array();
  for (const std::string& what : options.what) {
    for (const StudyPanel& panel : panels_of(what, study, table, options.logarithmic))
      figure["panels"].push_back(describe_panel(panel, study, table, what));
  }
  return figure.dump();
}

std::vector<std::string> usual_figures(const Study& study, const ResultTable& table) {
  std::vector<std::string> figures;
  for (const std::string& error : error_columns(table)) {
    const std::string name = error.substr(std::string(error_prefix).size());
    if (!study.questions.order_key.empty()) figures.push_back("order:" + name);
    figures.push_back("work-precision:" + name);
  }
  if (!figures.empty()) return figures;
  const std::string key =
      study.questions.order_key.empty() ? varied_keys(study.plan).back() : study.questions.order_key;
  for (const char* column : {"restitution", "largest_force", "peak_von_mises"}) {
    if (has_numbers(table, column)) figures.push_back(column + std::string(against) + key);
  }
  return figures;
}

}  // namespace ricochet
