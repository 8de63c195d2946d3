#pragma once

#include <string>
#include <vector>

/// @file The plan of a study: one case, and the values of the keys that vary.
namespace ricochet {

/// Keys that change together, and their values: values[i][k] is the i-th value of keys[k], as passed to --set.
struct StudyAxis {
  std::vector<std::string> keys;
  std::vector<std::vector<std::string>> values;
};

struct StudyPlan {
  std::string case_path;              ///< absolute
  std::vector<std::string> settings;  ///< "key.path=value", the same in all runs
  std::vector<StudyAxis> axes;
};

/// One run of a plan.
struct PlannedRun {
  std::vector<std::size_t> at;        ///< index of the value on each axis
  std::vector<std::string> values;    ///< of all varied keys, axis by axis
  std::vector<std::string> settings;  ///< all settings, as passed to --set
  std::string name;                   ///< name of a directory, made of the values that vary
};

/// Parses "key=v1,v2" or, for keys that change together, "key1,key2=v1/w1,v2/w2". Commas and slashes inside brackets or
/// quotes do not separate; - leaves a key as in the case. Throws Error(usage) that states the error: no value, a
/// repeated value, too many or too few keys, a key that no case has.
[[nodiscard]] StudyAxis parse_axis(const std::string& text);

/// Throws Error(usage) if nothing varies, or if one key varies twice or both varies and is set.
void check_plan(const StudyPlan& plan);

/// Returns the varied keys, axis by axis.
[[nodiscard]] std::vector<std::string> varied_keys(const StudyPlan& plan);

/// Returns all combinations, the last axis fastest.
[[nodiscard]] std::vector<PlannedRun> runs_of(const StudyPlan& plan);

/// Axis of a key, and its index on that axis.
struct KeyPosition {
  std::size_t axis, key;
};
/// Throws Error(usage) that lists the varied keys; `option` names the option that refers to the key.
[[nodiscard]] KeyPosition find_varied(const StudyPlan& plan, const std::string& key, const std::string& option);

/// Returns true for keys that count halvings (mesh.refine, part.NAME.refine): the size of cells is proportional to
/// 2^−value.
[[nodiscard]] bool counts_halvings(const std::string& key);
/// Returns the step to which orders of convergence refer: 2^−value for keys that count halvings, else the value.
[[nodiscard]] double step_of(const std::string& key, double value);

/// Returns true if all values of the key are numbers, and there are at least two.
[[nodiscard]] bool is_numeric(const StudyPlan& plan, KeyPosition position);

}  // namespace ricochet
