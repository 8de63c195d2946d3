#include "ricochet/study/requested_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/names.hpp"
#include "ricochet/case/quantity.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/run/quantity_value.hpp"
#include "ricochet/study/history_errors.hpp"

namespace ricochet {

namespace {

using Names = std::vector<std::string>;

struct RequestedColumn {
  std::string request;  ///< such as "--quantity max(history.time)"
  std::string column;   ///< column of history.csv
};

[[noreturn]] void refuse(const std::string& request, const std::string& reason) {
  throw Error(ErrorKind::usage, fmt::format("{}: {}", request, reason));
}

/// Refuses a quantity that no run has, whatever its columns. The reason is that of the run with the widest bounds.
void require_possible(const Study& study, const std::string& request, const Quantity& quantity) {
  std::string reason;
  double widest = 0.0;
  for (const StudyRun& run : study.runs) {
    std::optional<TimeSection> time;
    try {
      time = read_case(study.plan.case_path, run.planned.settings).time;
    } catch (const Error&) {  // its row reports the error
      continue;
    }
    const std::string found = impossible_in(*time, quantity);
    if (found.empty()) return;
    const bool is_row = quantity.kind == Quantity::Kind::history_value;
    const double extent = is_row ? double(step_count(*time)) : run_end(*time);
    if (extent <= widest) continue;
    widest = extent;
    reason = found;
  }
  if (!reason.empty()) refuse(request, reason);
}

std::vector<RequestedColumn> columns_in(const Study& study) {
  std::vector<RequestedColumn> columns;
  const auto add = [&](const std::string& option, const std::string& text) {
    const Quantity quantity = parse_quantity(text);
    const std::string request = option + " " + text;
    require_possible(study, request, quantity);
    if (const std::string column = required_column(quantity); !column.empty()) columns.push_back({request, column});
  };
  for (const std::string& text : study.questions.quantities) add("--quantity", text);
  for (const auto& [text, value] : study.questions.exact) add("--exact", text);
  return columns;
}

bool is_run_of_study(const std::string& reference) {
  return reference.starts_with("last:") || reference.starts_with("finest:");
}

/// Returns true if the runs may have different columns, which follow from meshes and probes.
bool columns_vary(const StudyPlan& plan) {
  const Names keys = varied_keys(plan);
  return std::ranges::any_of(
      keys, [](const std::string& key) { return key.starts_with("mesh.") || key.starts_with("probe."); });
}

/// Returns true if a run has the column whatever its mesh.
bool is_always_there(const std::string& column) {
  const auto in = [&](int dimension) {
    const Names names = standard_column_names(dimension);
    return std::ranges::count(names, column) > 0;
  };
  return in(2) && in(3);
}

std::optional<Case> first_valid_case(const Study& study) {
  for (const StudyRun& run : study.runs) {
    try {
      return read_case(study.plan.case_path, run.planned.settings);
    } catch (const Error&) {  // its row reports the error
    }
  }
  return std::nullopt;
}

/// Returns the columns of runs of this case; none if it does not fit its mesh, which the runs will report.
std::optional<Names> columns_of(const Case& input) {
  const log::Silence silence;  // the runs issue the warnings
  try {
    const std::unique_ptr<Model> model = build_model(input);
    return names_of(history_columns(*model));
  } catch (const Error&) {
    return std::nullopt;
  }
}

[[noreturn]] void refuse(const RequestedColumn& request, const Case& input, const Names& columns) {
  refuse(request.request, no_such_column(input, request.column, columns));
}

/// Refuses a column that no run has, for runs whose meshes or probes differ.
void require_possible_column(const RequestedColumn& request, const Case& input) {
  const Names names = history_column_names();
  if (std::ranges::count(names, request.column) > 0) return;
  // A column of a probe, which may have another name in another run.
  if (request.column.find('.') != std::string::npos) return;
  refuse(request, input, names);
}

/// Returns a table without rows for find_compared.
HistoryTable empty_table(const Names& columns) {
  HistoryTable table{columns, {}};
  for (const std::string& column : columns) table.columns[column];
  return table;
}

}  // namespace

void check_requested_columns(const Study& study) {
  const StudyQuestions& questions = study.questions;
  const std::vector<RequestedColumn> request = columns_in(study);
  const bool compares_own_runs = !questions.compare.empty() && is_run_of_study(questions.reference);
  if (!questions.compare.empty() && !compares_own_runs) {
    const std::string path = (std::filesystem::path(questions.reference) / "history.csv").string();
    const HistoryTable reference = read_history(path, true);
    for (const std::string& name : questions.compare) static_cast<void>(find_compared(name, reference));
  }
  const bool needs_runs = compares_own_runs || std::ranges::any_of(request, [](const RequestedColumn& a) {
                            return !is_always_there(a.column);
                          });
  const std::optional<Case> input = needs_runs ? first_valid_case(study) : std::nullopt;
  if (!input) return;
  if (columns_vary(study.plan)) {
    for (const RequestedColumn& one : request) require_possible_column(one, *input);
    return;
  }
  const std::optional<Names> columns = columns_of(*input);
  if (!columns) return;
  for (const RequestedColumn& one : request) {
    if (std::ranges::count(*columns, one.column) == 0) refuse(one, *input, *columns);
  }
  if (!compares_own_runs) return;
  for (const std::string& name : questions.compare) static_cast<void>(find_compared(name, empty_table(*columns)));
}

}  // namespace ricochet
