#include "ricochet/study/study_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "ricochet/base/error.hpp"
#include "ricochet/base/file_version.hpp"
#include "ricochet/base/json.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/keys_override.hpp"
#include "ricochet/case/quantity.hpp"
#include "ricochet/io/durable_file.hpp"
#include "ricochet/io/run_directory.hpp"
#include "ricochet/study/run_folders.hpp"
#include "ricochet/version.hpp"

namespace ricochet {

namespace {

using Texts = std::vector<std::string>;

Json axes_to_json(const StudyPlan& plan) {
  Json axes = Json::array();
  for (const StudyAxis& axis : plan.axes) {
    Json values = Json::array();
    for (const Texts& entry : axis.values) values.push_back(Json(entry));
    axes.push_back({{"keys", axis.keys}, {"values", values}});
  }
  return axes;
}

Json questions_to_json(const StudyQuestions& questions) {
  Json exact = Json::array();
  for (const auto& [quantity, value] : questions.exact) exact.push_back({{"quantity", quantity}, {"value", value}});
  return {{"quantities", questions.quantities},
          {"exact", exact},
          {"reference", questions.reference},
          {"compare", questions.compare},
          {"order", questions.order_key}};
}

StudyPlan plan_from(const Json& json) {
  StudyPlan plan{json.at("case"), json.at("settings").get<Texts>(), {}};
  for (const Json& axis : json.at("axes")) {
    StudyAxis& parsed = plan.axes.emplace_back();
    parsed.keys = axis.at("keys").get<Texts>();
    for (const Json& entry : axis.at("values")) parsed.values.push_back(entry.get<Texts>());
  }
  return plan;
}

StudyQuestions questions_from(const Json& json) {
  StudyQuestions questions{
      json.at("quantities").get<Texts>(), {}, json.at("reference"), json.at("compare").get<Texts>(), json.at("order")};
  for (const Json& entry : json.at("exact")) questions.exact.emplace_back(entry.at("quantity"), entry.at("value"));
  return questions;
}

/// Returns the meaning of settings, independent of how their values are written.
std::set<std::string> meaning_of(const Texts& settings) {
  std::set<std::string> meaning;
  for (const std::string& setting : settings) meaning.insert(normal_override(setting));
  return meaning;
}

std::string numbered(std::size_t number, const std::string& name) { return fmt::format("{:03}-{}", number, name); }

/// Returns the key for "last", "finest" or an order if none is given.
std::string only_numeric_key(const StudyPlan& plan, const std::string& option, bool must_be_one) {
  Texts numeric;
  for (const std::string& key : varied_keys(plan)) {
    if (is_numeric(plan, find_varied(plan, key, option))) numeric.push_back(key);
  }
  if (numeric.size() == 1) return numeric.front();
  if (!must_be_one) {
    const bool has_step = std::ranges::count(numeric, "time.step") > 0;
    return has_step ? "time.step" : numeric.empty() ? "" : numeric.front();
  }
  throw Error(ErrorKind::usage, fmt::format("{}: {} with numeric values; name the key, as in {}:{}", option,
                                            numeric.empty() ? "no key varies" : "several keys vary", option,
                                            numeric.empty() ? plan.axes.front().keys.front() : numeric.front()));
}

std::string checked_reference(const std::string& reference, const StudyPlan& plan) {
  for (const std::string kind : {"last", "finest"}) {
    const std::string option = "--reference " + kind;
    if (reference == kind) {
      const bool only_one = varied_keys(plan).size() == 1;
      const std::string key = only_one ? plan.axes[0].keys[0] : only_numeric_key(plan, option, true);
      return checked_reference(kind + ":" + key, plan);
    }
    if (!reference.starts_with(kind + ":")) continue;
    const std::string key = reference.substr(kind.size() + 1);
    const KeyPosition position = find_varied(plan, key, option);
    if (kind == "finest" && !is_numeric(plan, position))
      throw Error(ErrorKind::usage,
                  fmt::format("{}: the key {} must have at least two values, all of them numbers", option, key));
    return reference;
  }
  if (reference.empty()) return "";
  if (holds_run(reference)) return std::filesystem::absolute(reference).lexically_normal().string();
  throw Error(ErrorKind::usage,
              fmt::format("--reference {}: is neither the directory of a run nor last:KEY or finest:KEY with a key "
                          "that varies; if that run was moved or removed, name another with --reference",
                          reference));
}

void require_study(const std::string& directory) {
  if (holds_study(directory)) return;
  std::error_code ignored;
  const bool is_there = std::filesystem::is_directory(directory, ignored);
  const std::string why = !is_there              ? "there is no such directory"
                          : holds_run(directory) ? "holds a run, not a study; `ricochet run --resume` continues a run"
                                                 : "holds no study: study.json is missing";
  throw Error(ErrorKind::file_access, fmt::format("{}: {}; name the directory of a study, or start one with `ricochet "
                                                  "study CASE.toml --vary KEY=V1,V2,... -o {}`",
                                                  directory, why, is_there ? "DIR" : directory));
}

/// Refuses a plan that no command line could have made. Throws Json::Exception or Error.
void require_sound(const StudyPlan& plan) {
  for (const StudyAxis& axis : plan.axes) {
    if (axis.keys.empty() || axis.values.empty()) throw Json::Exception("\"axes\": an axis has no keys or no values");
    for (const Texts& entry : axis.values) {
      if (entry.size() != axis.keys.size())
        throw Json::Exception(fmt::format("\"axes\": an entry has {} for {}", counted(entry.size(), "value"),
                                          counted(axis.keys.size(), "key")));
    }
  }
  check_plan(plan);
}

void require_sound(StudyQuestions questions, const StudyPlan& plan) {
  const bool is_of_study = questions.reference.starts_with("last:") || questions.reference.starts_with("finest:");
  if (!is_of_study && !questions.reference.empty()) {
    // A run elsewhere may have been moved or removed since; the table reports this.
    questions.reference.clear();
    questions.compare.clear();
  }
  static_cast<void>(checked_questions(std::move(questions), plan));
}

}  // namespace

Study read_study(const std::string& directory) {
  Study study;
  study.directory = directory;
  require_study(directory);
  read_plan(study.path("study.json"), "study", [&](const Json& json) {
    study.plan = plan_from(json);
    require_sound(study.plan);
    study.questions = questions_from(json.at("questions"));
    require_sound(study.questions, study.plan);
    study.runs = number_runs(study.plan);
    const Texts folders = json.at("runs").get<Texts>();
    if (folders.size() != study.runs.size()) {
      throw Json::Exception(fmt::format("\"runs\" has {}, but the values of \"axes\" result in {}",
                                        counted(folders.size(), "folder"), counted(study.runs.size(), "run")));
    }
    require_run_folder_names(folders, "\"runs\"");
    for (std::size_t i = 0; i < folders.size(); ++i) study.runs[i].folder = folders[i];
  });
  return study;
}

void write_study(const Study& study) {
  Texts folders;
  for (const StudyRun& run : study.runs) folders.push_back(run.folder);
  const Json json{{version_attribute, version},
                  {"case", study.plan.case_path},
                  {"settings", study.plan.settings},
                  {"axes", axes_to_json(study.plan)},
                  {"questions", questions_to_json(study.questions)},
                  {"runs", folders}};
  write_durably(study.path("study.json"), json.dump(2) + "\n");
}

std::vector<StudyRun> number_runs(const StudyPlan& plan) {
  std::vector<StudyRun> runs;
  for (PlannedRun& planned : runs_of(plan)) {
    const std::string folder = numbered(runs.size() + 1, planned.name);
    runs.push_back({std::move(planned), folder});
  }
  return runs;
}

std::vector<StudyRun> reuse_runs(const StudyPlan& plan, const Study& before) {
  const auto refuse = [&](const std::string& why) {
    throw Error(
        ErrorKind::file_access,
        fmt::format(
            "{}: holds another study: {}; choose another directory with -o, or overwrite the study with --force",
            before.directory, why));
  };
  if (plan.case_path != before.plan.case_path) refuse(fmt::format("its case is {}", before.plan.case_path));
  std::vector<StudyRun> left = before.runs, runs;
  std::size_t next = left.size();
  for (PlannedRun& planned : runs_of(plan)) {
    const auto same = std::ranges::find_if(
        left, [&](const StudyRun& run) { return meaning_of(run.planned.settings) == meaning_of(planned.settings); });
    const std::string folder = same != left.end() ? same->folder : numbered(++next, planned.name);
    runs.push_back({std::move(planned), folder});
    if (same != left.end()) left.erase(same);
  }
  if (!left.empty()) {
    refuse(fmt::format("this plan has no run with {}, which exists as {}",
                       fmt::join(left.front().planned.settings, ", "), left.front().folder));
  }
  return runs;
}

StudyQuestions checked_questions(StudyQuestions questions, const StudyPlan& plan) {
  for (const std::string& quantity : questions.quantities) static_cast<void>(parse_quantity(quantity));
  for (const auto& [quantity, value] : questions.exact) static_cast<void>(parse_quantity(quantity));
  questions.reference = checked_reference(questions.reference, plan);
  if (questions.order_key.empty()) {
    const std::string& reference = questions.reference;
    const std::string key = reference.substr(reference.find(':') + 1);
    const bool follows = reference.starts_with("finest:") ||
                         (reference.starts_with("last:") && is_numeric(plan, find_varied(plan, key, "--reference")));
    questions.order_key = follows ? key : only_numeric_key(plan, "--order", false);
  } else if (!is_numeric(plan, find_varied(plan, questions.order_key, "--order"))) {
    throw Error(ErrorKind::usage, fmt::format("--order {}: this key must have at least two values, all of them numbers",
                                              questions.order_key));
  }
  if (!questions.compare.empty() && questions.reference.empty())
    throw Error(ErrorKind::usage, "--compare: selects the columns to compare with a run: name it with --reference");
  return questions;
}

std::pair<std::string, double> parse_exact(const std::string& text) {
  const std::size_t equals = text.rfind('=');
  const std::optional<double> value = equals == std::string::npos ? std::nullopt : number_in(text.substr(equals + 1));
  if (!value)
    throw Error(ErrorKind::usage,
                fmt::format("--exact {}: write --exact QUANTITY=VALUE, where VALUE is a number", text));
  return {text.substr(0, equals), *value};
}

}  // namespace ricochet
