#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "commands.hpp"
#include "ricochet/base/child_processes.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/study/study.hpp"
#include "stop_signal.hpp"

namespace ricochet::program {

namespace {

namespace fs = std::filesystem;

/// Interprets `--resume DIR` as -o DIR; without a case, the existing plan continues.
StudyArguments with_directory(StudyArguments arguments) {
  std::error_code ignored;
  const bool names_nothing_else = arguments.output_directory.empty() && arguments.vary.empty();
  const bool is_directory = fs::is_directory(arguments.case_file, ignored);
  const bool is_nothing =
      names_nothing_else && !arguments.case_file.empty() && !fs::exists(arguments.case_file, ignored);
  if (arguments.resume && (is_directory || is_nothing)) {
    if (!arguments.output_directory.empty())
      throw Error(ErrorKind::usage, "study --resume: either a case file or the directory of one study is required");
    arguments.output_directory = arguments.case_file;
    arguments.case_file.clear();
  }
  if (arguments.output_directory.empty())
    throw Error(ErrorKind::usage, "study: a directory for the runs and the table is required: -o DIR");
  if (arguments.case_file.empty() && !arguments.resume)
    throw Error(ErrorKind::usage, "study: a case file is required (or --resume and the directory of a study)");
  if (arguments.case_file.empty() && (!arguments.vary.empty() || !arguments.overrides.empty()))
    throw Error(ErrorKind::usage, "study --resume: to vary other values, name the case, too");
  return arguments;
}

StudyPlan plan_of(const StudyArguments& arguments) {
  StudyPlan plan{fs::absolute(arguments.case_file).lexically_normal().string(), arguments.overrides, {}};
  for (const std::string& text : arguments.vary) plan.axes.push_back(parse_axis(text));
  return plan;
}

/// Replaces the quantities requested earlier by those requested now.
StudyQuestions questions_of(const StudyArguments& arguments, StudyQuestions questions) {
  if (!arguments.quantities.empty()) questions.quantities = arguments.quantities;
  if (!arguments.exact.empty()) {
    questions.exact.clear();
    for (const std::string& text : arguments.exact) questions.exact.push_back(parse_exact(text));
  }
  if (!arguments.reference.empty()) {
    questions.reference = arguments.reference;
    questions.order_key.clear();
  }
  if (!arguments.compare.empty()) questions.compare = arguments.compare;
  if (!arguments.order.empty()) questions.order_key = arguments.order;
  return questions;
}

void print_results(const std::string& directory, const StudyResults& results) {
  fmt::print("{}", to_aligned_text(results.table));
  for (const std::string& note : results.notes) fmt::print("  {}\n", note);
  if (!results.warnings.empty())
    fmt::print("  {}: see study.md\n", counted(results.warnings.size(), "warning of the runs", "warnings of the runs"));
  fmt::print("{} of {} done; {}/study.csv, study.md\n", results.done, counted(results.table.rows.size(), "run"),
             directory);
}

}  // namespace

void describe_study(const std::string& directory) { print_results(directory, make_study_table(read_study(directory))); }

int study(const StudyArguments& given) {
  const StudyArguments arguments = with_directory(given);
  const bool goes_on = arguments.case_file.empty();
  const Study before = goes_on ? read_study(arguments.output_directory) : Study{};
  const StudyPlan plan = goes_on ? before.plan : plan_of(arguments);
  StudyOptions options;
  options.threads = arguments.threads;
  options.jobs = arguments.jobs > 0 ? std::size_t(arguments.jobs)
                                    : std::max<std::size_t>(1, usable_cores() / std::size_t(arguments.threads));
  options.resume = arguments.resume;
  options.force = arguments.force;
  options.quiet = arguments.quiet;
  options.stop_signal = stop_signal;
  int signal = 0;
  const StudyResults results =
      conduct_study(arguments.output_directory, plan, questions_of(arguments, before.questions), options, signal);
  print_results(arguments.output_directory, results);
  if (signal == 0) return results.worst_status;
  fmt::print("  stopped; `ricochet study --resume {}` continues it\n", arguments.output_directory);
  return 128 + signal;
}

}  // namespace ricochet::program
