#pragma once

#include <string>
#include <vector>

/// @file The plan of a study: one case, and the values that some of its keys take.
namespace ricochet {

/// Keys that change together, and the values that they take: values[i][k] is the i-th of keys[k], as --set takes it.
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
  std::vector<std::size_t> at;        ///< which value of each axis
  std::vector<std::string> values;    ///< of all varied keys, axis by axis
  std::vector<std::string> settings;  ///< all of them, as --set takes them
  std::string name;                   ///< made of what varies, for a directory
};

/// From "key=v1,v2" or, of keys that change together, "key1,key2=v1/w1,v2/w2". Commas and slashes inside of brackets or
/// quotes do not separate; - leaves a key as the case has it. Throws Error(usage) that says what is wrong: no value,
/// one that is there twice, too many or too few keys, a key that no case has.
[[nodiscard]] StudyAxis parse_axis(const std::string& text);

/// Throws Error(usage) where nothing or one key varies twice, or varies and is set.
void check_plan(const StudyPlan& plan);

/// Varied keys, axis by axis.
[[nodiscard]] std::vector<std::string> varied_keys(const StudyPlan& plan);

/// All combinations, the last axis fastest.
[[nodiscard]] std::vector<PlannedRun> runs_of(const StudyPlan& plan);

/// Where a key is among the axes, and its number on that axis.
struct KeyPlace {
  std::size_t axis, key;
};
/// Throws Error(usage) that lists the varied keys; `option` names what asked.
[[nodiscard]] KeyPlace find_varied(const StudyPlan& plan, const std::string& key, const std::string& option);

/// Of keys that count halvings (mesh.refine, part.NAME.refine): 2^−value goes with the size of cells.
[[nodiscard]] bool counts_halvings(const std::string& key);
/// What orders of convergence are about: 2^−value of these, of all others the value.
[[nodiscard]] double step_of(const std::string& key, double value);

/// All values of the key are numbers, and there are two at least.
[[nodiscard]] bool is_numeric(const StudyPlan& plan, KeyPlace place);

}  // namespace ricochet
