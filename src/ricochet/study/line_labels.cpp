#include "ricochet/study/line_labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "ricochet/base/text.hpp"
#include "ricochet/study/study_files.hpp"

namespace ricochet {

namespace {

using Texts = std::vector<std::string>;

std::string last_part(const std::string& key) { return key.substr(key.rfind('.') + 1); }

/// Returns the shortest label of an axis value that distinguishes it from the others: the first key alone, if that
/// suffices.
std::string value_label(const StudyAxis& axis, std::size_t at) {
  const auto same = [&](const auto& other) { return other.front() == axis.values[at].front(); };
  if (std::ranges::count_if(axis.values, same) == 1) return axis.values[at].front();
  return fmt::format("{}", fmt::join(axis.values[at], "/"));
}

/// Returns the kinds of one key's values; empty if they do not make separate lines: all numbers, or all different
/// words, such as meshes that are refined successively.
Texts kinds_of_key(const StudyAxis& axis, std::size_t key) {
  Texts kinds;
  for (const Texts& entry : axis.values) {
    const std::string& value = entry[key];
    const std::string name = last_part(axis.keys[key]);
    kinds.push_back(number_in(value) ? "numeric " + name : value == "-" ? "no " + name : value);
  }
  const std::size_t distinct = std::set<std::string>(kinds.begin(), kinds.end()).size();
  if (distinct == 1 || distinct == kinds.size()) return {};
  return kinds;
}

}  // namespace

std::string label_by_axes(const PlannedRun& run, const StudyPlan& plan, const std::vector<std::size_t>& axes) {
  Texts parts;
  for (const std::size_t a : axes) {
    const std::string &key = plan.axes[a].keys.front(), value = value_label(plan.axes[a], run.at[a]);
    parts.push_back(number_in(value) ? fmt::format("{} {}", last_part(key), value) : value);
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

Texts kinds_along(const StudyAxis& axis, const std::string& shown) {
  std::vector<Texts> by_key;
  for (std::size_t key = 0; key < axis.keys.size(); ++key) {
    if (axis.keys.size() == 1 || axis.keys[key] == shown) continue;
    if (Texts kinds = kinds_of_key(axis, key); !kinds.empty()) by_key.push_back(std::move(kinds));
  }
  Texts full_labels(axis.values.size());
  for (std::size_t i = 0; i < full_labels.size(); ++i) {
    for (const Texts& kinds : by_key) full_labels[i] += (full_labels[i].empty() ? "" : ", ") + kinds[i];
  }
  // A single key if it suffices to distinguish the lines.
  const std::size_t distinct = std::set<std::string>(full_labels.begin(), full_labels.end()).size();
  for (const Texts& kinds : by_key) {
    if (std::set<std::string>(kinds.begin(), kinds.end()).size() == distinct) return kinds;
  }
  return full_labels;
}

Texts labels_in_study(const Texts& directories) {
  namespace fs = std::filesystem;
  std::string study_folder;
  Texts folders;
  for (const std::string& directory : directories) {
    fs::path path = fs::absolute(directory).lexically_normal();
    if (!path.has_filename()) path = path.parent_path();  // a trailing slash
    const std::string study = path.parent_path().parent_path().string();
    if (path.parent_path().filename() != "runs" || !holds_study(study) ||
        (!study_folder.empty() && study_folder != study))
      return {};
    study_folder = study;
    folders.push_back(path.filename().string());
  }
  if (study_folder.empty()) return {};
  const Study study = read_study(study_folder);
  std::vector<const PlannedRun*> runs;
  for (const std::string& folder : folders) {
    const auto found = std::ranges::find_if(study.runs, [&](const StudyRun& run) { return run.folder == folder; });
    if (found == study.runs.end()) return {};
    runs.push_back(&found->planned);
  }
  std::vector<std::size_t> axes;
  for (std::size_t a = 0; a < study.plan.axes.size(); ++a) {
    const auto differs = [&](const PlannedRun* run) { return run->at[a] != runs.front()->at[a]; };
    if (std::ranges::any_of(runs, differs)) axes.push_back(a);
  }
  if (axes.empty()) return {};
  Texts labels;
  for (const PlannedRun* run : runs) labels.push_back(label_by_axes(*run, study.plan, axes));
  return labels;
}

}  // namespace ricochet
