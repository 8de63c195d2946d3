#include "ricochet/study/order_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "ricochet/base/text.hpp"
#include "ricochet/study/history_errors.hpp"
#include "ricochet/study/study_table.hpp"

namespace ricochet {

namespace {

/// Smallest meaningful order. Solutions with fronts have orders down to a third, where halving the step removes a fifth
/// of the error; with this order it removes a fifteenth.
constexpr double least_order = 0.1;

/// Returns the preceding run along an axis; none for the first.
std::optional<std::size_t> run_before(const Study& study, std::size_t run, std::size_t axis) {
  std::vector<std::size_t> at = study.runs[run].planned.at;
  if (at[axis]-- == 0) return std::nullopt;
  const auto found = std::ranges::find_if(study.runs, [&](const StudyRun& other) { return other.planned.at == at; });
  return std::size_t(found - study.runs.begin());
}

/// Returns the orders for column c of errors, run by run.
std::vector<std::optional<double>> orders_of(const Study& study, const ResultTable& table, std::size_t c) {
  const KeyPosition position = find_varied(study.plan, study.questions.order_key, "--order");
  const auto step = [&](std::size_t run) {
    const std::size_t at = study.runs[run].planned.at[position.axis];
    return step_of(study.questions.order_key,
                   number_in(study.plan.axes[position.axis].values[at][position.key]).value());
  };
  std::vector<std::optional<double>> orders(table.rows.size());
  for (std::size_t run = 0; run < orders.size(); ++run) {
    const auto before = run_before(study, run, position.axis);
    if (!before) continue;
    orders[run] =
        observed_order(number_of(table.rows[*before][c]), number_of(table.rows[run][c]), step(*before), step(run));
  }
  return orders;
}

/// Returns a text such as "2 of 6 for tip.displacement", or "".
std::string idle_text(const std::string& key, const std::string& name,
                      const std::vector<std::optional<double>>& orders) {
  std::vector<double> found;
  for (const std::optional<double>& order : orders) {
    if (order) found.push_back(*order);
  }
  const std::vector<bool> idle = find_stagnant_orders(key, found);
  const auto count = std::ranges::count(idle, true);
  return count > 0 ? fmt::format("{} of {} for {}", count, found.size(), name) : "";
}

bool is_biased(const StudyQuestions& questions) {
  return questions.reference == "finest:" + questions.order_key || questions.reference == "last:" + questions.order_key;
}

}  // namespace

std::vector<bool> find_stagnant_orders(const std::string& key, const std::vector<double>& orders) {
  const auto positive = std::ranges::count_if(orders, [](double order) { return order > 0.0; });
  const bool smaller_is_finer = key == "time.step" || 2 * positive >= std::ptrdiff_t(orders.size());
  std::vector<bool> idle;
  for (const double order : orders) idle.push_back((smaller_is_finer ? order : -order) < least_order);
  return idle;
}

void add_order_columns(const Study& study, ResultTable& table, std::vector<std::string>& notes) {
  const std::string& key = study.questions.order_key;
  if (key.empty()) return;
  std::vector<std::string> idle;
  bool any = false;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (!table.columns[c].name.starts_with(error_prefix)) continue;
    const std::string name = table.columns[c].name.substr(std::string(error_prefix).size());
    const std::vector<std::optional<double>> orders = orders_of(study, table, c);
    any = any || std::ranges::any_of(orders, [](const auto& order) { return order.has_value(); });
    const auto behind = std::ptrdiff_t(c + 1);
    table.columns.insert(table.columns.begin() + behind, {order_prefix + name, true, 3, 2});
    for (std::size_t run = 0; run < table.rows.size(); ++run)
      table.rows[run].insert(table.rows[run].begin() + behind, orders[run] ? TableCell(*orders[run]) : TableCell());
    if (std::string text = idle_text(key, name, orders); !text.empty()) idle.push_back(std::move(text));
  }
  if (!any) return;
  notes.push_back(fmt::format("Orders are observed between a value of {} and the previous one.", key));
  if (!idle.empty()) {
    notes.push_back(
        fmt::format("Orders below {} are meaningless ({}): the error no longer decreases with {} there, and the "
                    "remaining error has another cause, such as the mesh or the reference.",
                    least_order, fmt::join(idle, ", "), key));
  }
  if (is_biased(study.questions)) {
    notes.push_back(
        "The last orders are too large, since the reference is a run of this study: with half the step it makes an "
        "order of 2 appear as 2.3. To avoid this, name a much finer run with --reference.");
  }
}

}  // namespace ricochet
