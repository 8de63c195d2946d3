#include "ricochet/study/study_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/run/quantity_value.hpp"
#include "ricochet/study/history_errors.hpp"
#include "ricochet/study/order_columns.hpp"
#include "ricochet/study/result_columns.hpp"

namespace ricochet {

namespace {

/// Returns the quantities of the case's [[expect]] entries, each once; the expected values do not matter here.
std::vector<std::string> expected_quantities(const Study& study) {
  std::vector<std::string> quantities;
  for (const StudyRun& run : study.runs) {
    try {
      for (const ExpectSection& expect : read_case(study.plan.case_path, run.planned.settings).expectations) {
        if (std::ranges::count(quantities, expect.quantity) == 0) quantities.push_back(expect.quantity);
      }
      break;
    } catch (const Error&) {  // a run that was refused, as its row states
    }
  }
  return quantities;
}

std::string reference_in_words(const std::string& reference) {
  const std::string key = reference.substr(reference.find(':') + 1);
  if (reference.starts_with("finest:"))
    return fmt::format("the run with the {} {}", counts_halvings(key) ? "largest" : "smallest", key);
  if (reference.starts_with("last:")) return fmt::format("the run with the last {}", key);
  return reference;
}

class StudyTableMaker {
 public:
  explicit StudyTableMaker(const Study& study) : study_(study), questions_(study.questions) {}
  StudyResults make();

 private:
  using Cells = std::vector<TableCell>;
  using CellOf = std::function<TableCell(std::size_t run)>;
  void add_column(TableColumn column, CellOf cell);
  void fill_columns();
  void add_result_columns();
  void add_quantities();
  void add_exact_errors();
  void add_history_errors();
  void add_messages();
  void note_problems();
  void note_messages();
  void note_warnings();
  [[nodiscard]] TableCell value_of(const std::string& quantity, std::size_t run, const std::string& option);
  [[nodiscard]] const RunHistory* history_of(const std::string& directory);
  [[nodiscard]] std::string reference_of(std::size_t run) const;
  [[nodiscard]] std::vector<ComparedQuantity> compared();

  const Study& study_;
  const StudyQuestions& questions_;
  std::vector<RunState> states_;
  std::map<std::string, RunHistory> histories_;  ///< histories that are still needed
  std::vector<CellOf> new_columns_;
  std::map<std::string, std::string> problems_;  ///< error per option that requests a value runs do not have
  std::set<std::string> answered_;               ///< such options for which some run has a value
  std::map<std::string, int> missing_counts_;    ///< number of runs without the value
  bool has_missing_quantity_ = false;
  StudyResults results_;
};

/// Adds a column to be filled by the next fill_columns().
void StudyTableMaker::add_column(TableColumn column, CellOf cell) {
  results_.table.columns.push_back(std::move(column));
  new_columns_.push_back(std::move(cell));
}

/// Fills columns run by run, so that only the histories of one run and of the references are in memory.
void StudyTableMaker::fill_columns() {
  std::set<std::string> references;
  for (std::size_t i = 0; i < study_.runs.size(); ++i) references.insert(reference_of(i));
  for (std::size_t i = 0; i < study_.runs.size(); ++i) {
    for (const CellOf& cell : new_columns_) results_.table.rows[i].push_back(cell(i));
    if (const std::string own = study_.path(study_.runs[i]); !references.contains(own)) histories_.erase(own);
  }
  new_columns_.clear();
  note_problems();
}

/// Reports values that could not be found. If only some runs lack a value, their cells stay empty; if all lack it, the
/// question is wrong.
void StudyTableMaker::note_problems() {
  for (const auto& [question, problem] : problems_) {
    if (answered_.contains(question) && missing_counts_.contains(question)) {
      log::warning(
          fmt::format("{}: {} of {} lack it", question, missing_counts_[question], counted(results_.done, "run")));
      continue;
    }
    log::warning(fmt::format("{}: {}", question, problem));
    if (answered_.contains(question)) continue;
    results_.notes.push_back(fmt::format("{}: {}.", question, problem));
    has_missing_quantity_ = true;
  }
  problems_.clear();
}

void StudyTableMaker::add_result_columns() {
  results_.table.key_columns = varied_keys(study_.plan).size();
  for (const std::string& key : varied_keys(study_.plan)) results_.table.columns.push_back({key});
  for (TableColumn& column : result_columns()) results_.table.columns.push_back(std::move(column));
  for (const StudyRun& run : study_.runs) {
    states_.push_back(read_run_state(study_.path(run)));
    Cells& row = results_.table.rows.emplace_back();
    for (const std::string& value : run.planned.values) row.emplace_back(value);
    for (TableCell& cell : result_cells(run.folder, states_.back())) row.push_back(std::move(cell));
    const std::optional<int> status = states_.back().final_status();
    results_.done += states_.back().status_text() == "done";
    results_.worst_status = worse_status(results_.worst_status, status.value_or(0));
  }
}

/// Returns null if the run has no history that can be read.
const RunHistory* StudyTableMaker::history_of(const std::string& directory) {
  const auto known = histories_.find(directory);
  if (known != histories_.end()) return &known->second;
  const std::string path = (std::filesystem::path(directory) / "history.csv").string();
  try {
    RunHistory history{read_summary_of_run(directory), {}};
    history.table = read_history(path, history.summary.status != "done");
    return &histories_.emplace(directory, std::move(history)).first->second;
  } catch (const Error&) {
    return nullptr;
  }
}

/// Returns the value of a quantity. If an option requests it, runs without the value are reported.
TableCell StudyTableMaker::value_of(const std::string& quantity, std::size_t run, const std::string& option) {
  if (states_[run].status_text() != "done") return {};
  const std::string question = option + " " + quantity;
  try {
    const RunHistory* history = history_of(study_.path(study_.runs[run]));
    if (history == nullptr)
      throw Error(ErrorKind::file_access, fmt::format("history.csv of {} cannot be read", study_.runs[run].folder));
    const double value = ricochet::value_of(parse_quantity(quantity), history->table, states_[run].summary_json);
    answered_.insert(question);
    return value;
  } catch (const Error& problem) {
    if (option.empty()) return {};
    problems_[question] = problem.what();
    ++missing_counts_[question];
    return {};
  }
}

/// Adds the quantities; those of the case's expectations, often numerous, are for programs only.
void StudyTableMaker::add_quantities() {
  std::vector<std::string> added;
  const auto add = [&](const std::string& quantity, bool is_requested) {
    if (std::ranges::count(added, quantity) > 0) return;
    added.push_back(quantity);
    const std::string option = is_requested ? "--quantity" : "";
    add_column({quantity, is_requested, 5, 1}, [=, this](std::size_t run) { return value_of(quantity, run, option); });
  };
  for (const std::string& quantity : questions_.quantities) add(quantity, true);
  for (const std::string& quantity : expected_quantities(study_)) add(quantity, false);
}

void StudyTableMaker::add_exact_errors() {
  for (const auto& requested : questions_.exact) {
    const std::string& quantity = requested.first;
    const double exact = requested.second;
    add_column({error_prefix + quantity, true, 3, 2}, [&quantity, exact, this](std::size_t run) -> TableCell {
      const TableCell value = value_of(quantity, run, "--exact");
      if (std::holds_alternative<std::monostate>(value)) return {};
      const double error = std::abs(number_of(value) - exact);
      return exact != 0.0 ? error / std::abs(exact) : error;
    });
    results_.notes.push_back(fmt::format("{}{} is {} {:.9g}.", error_prefix, quantity,
                                         exact != 0.0 ? "the error relative to the exact value" : "the distance from",
                                         exact));
  }
}

/// Returns the directory of the run with which a run is compared.
std::string StudyTableMaker::reference_of(std::size_t run) const {
  const std::size_t colon = questions_.reference.find(':');
  const std::string kind = questions_.reference.substr(0, colon);
  if (colon == std::string::npos || (kind != "last" && kind != "finest")) return questions_.reference;
  const std::string key = questions_.reference.substr(colon + 1);
  const KeyPosition position = find_varied(study_.plan, key, "--reference");
  const auto& values = study_.plan.axes[position.axis].values;
  std::size_t chosen = values.size() - 1;
  if (kind == "finest") {
    const auto step = [&](const auto& value) { return step_of(key, number_in(value[position.key]).value_or(0.0)); };
    const auto finest =
        std::ranges::min_element(values, [&](const auto& a, const auto& b) { return step(a) < step(b); });
    chosen = std::size_t(finest - values.begin());
  }
  std::vector<std::size_t> at = study_.runs[run].planned.at;
  at[position.axis] = chosen;
  const auto found = std::ranges::find_if(study_.runs, [&](const StudyRun& other) { return other.planned.at == at; });
  return study_.path(*found);
}

/// Returns the quantities to compare, from the first reference that exists.
std::vector<ComparedQuantity> StudyTableMaker::compared() {
  for (std::size_t i = 0; i < study_.runs.size(); ++i) {
    const RunHistory* reference = history_of(reference_of(i));
    if (reference == nullptr) continue;
    if (questions_.compare.empty()) return usual_compared(reference->table);
    std::vector<ComparedQuantity> result;
    for (const std::string& name : questions_.compare) {
      try {
        result.push_back(find_compared(name, reference->table));
      } catch (const Error&) {  // the rest of the table is made nonetheless
        problems_["--compare " + name] = "the history of the reference has no such column or vector";
      }
    }
    return result;
  }
  problems_["--reference " + questions_.reference] =
      "no possible reference run has a history, or the run was moved or removed";
  return {};
}

void StudyTableMaker::add_history_errors() {
  if (questions_.reference.empty()) return;
  for (const ComparedQuantity& quantity : compared()) {
    add_column({error_prefix + quantity.name, true, 3, 2}, [quantity, this](std::size_t run) -> TableCell {
      const std::string own = study_.path(study_.runs[run]), directory = reference_of(run);
      if (own == directory || states_[run].status_text() != "done") return {};
      const RunHistory *history = history_of(own), *reference = history_of(directory);
      const std::string question = "--compare " + quantity.name;
      if (reference == nullptr || reference->summary.status != "done") {
        problems_["--reference " + directory] = "this run is not done, so there are no errors relative to it";
        return {};
      }
      answered_.insert("--reference " + directory);
      const std::optional<double> error =
          history != nullptr ? relative_error(quantity, *history, *reference) : std::nullopt;
      if (error) answered_.insert(question);
      if (!error && !questions_.compare.empty())
        problems_[question] =
            "some runs have no such column or no two rows in common with the reference, or the reference is 0";
      return error ? TableCell(*error) : TableCell();
    });
  }
  results_.notes.push_back(
      fmt::format("Errors of histories are differences from {} in the L2 norm over time, relative to its norm.",
                  reference_in_words(questions_.reference)));
}

void StudyTableMaker::add_messages() {
  add_column({"message", false}, [this](std::size_t run) -> TableCell {
    const RunState& state = states_[run];
    const std::optional<int> status = state.final_status();
    if (status == 0) return {};
    if (status == int(ErrorKind::expectation)) {
      std::vector<std::string> broken;
      for (const ExpectationResult& e : state.summary->expectations) {
        if (e.checked && !e.holds) broken.push_back(fmt::format("{} is not {}", e.quantity, e.expected));
      }
      return fmt::format("{}", fmt::join(broken, "; "));
    }
    return state.message;
  });
}

void StudyTableMaker::note_messages() {
  for (std::size_t i = 0; i < study_.runs.size(); ++i) {
    const std::string message = text_of(results_.table.rows[i].back());
    if (!message.empty()) results_.notes.push_back(fmt::format("{}: {}", study_.runs[i].folder, message));
  }
}

void StudyTableMaker::note_warnings() {
  for (std::size_t i = 0; i < study_.runs.size(); ++i) {
    if (!states_[i].summary) continue;
    for (const std::string& warning : states_[i].summary->warnings)
      results_.warnings.push_back(fmt::format("{}: {}", study_.runs[i].folder, warning));
  }
}

StudyResults StudyTableMaker::make() {
  add_result_columns();
  add_quantities();
  add_exact_errors();
  add_history_errors();
  fill_columns();
  add_order_columns(study_, results_.table, results_.notes);
  add_messages();
  fill_columns();
  note_messages();
  note_warnings();
  if (has_missing_quantity_ && results_.worst_status == 0) results_.worst_status = int(ErrorKind::usage);
  return std::move(results_);
}

std::string markdown_item(const std::string& text) { return fmt::format("- {}\n", markdown_text(text)); }

}  // namespace

StudyResults make_study_table(const Study& study) { return StudyTableMaker(study).make(); }

void write_study_table(const Study& study, const StudyResults& results) {
  write_durably(study.path("study.csv"), to_csv(results.table));
  std::string page =
      fmt::format("# Study of {}\n\n", markdown_text(std::filesystem::path(study.plan.case_path).filename().string()));
  for (const StudyAxis& axis : study.plan.axes) {
    std::vector<std::string> values;
    for (const auto& entry : axis.values) values.push_back(fmt::format("{}", fmt::join(entry, "/")));
    page += markdown_item(fmt::format("{} = {}", fmt::join(axis.keys, ","), fmt::join(values, ", ")));
  }
  for (const std::string& setting : study.plan.settings) page += markdown_item("set: " + setting);
  page += "\n" + to_markdown(results.table) + "\n";
  for (const std::string& note : results.notes) page += markdown_item(note);
  if (!results.warnings.empty()) page += "\nWarnings of the runs:\n\n";
  for (const std::string& warning : results.warnings) page += markdown_item(warning);
  write_durably(study.path("study.md"), page);
}

}  // namespace ricochet
