#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ricochet/study/plan.hpp"

/// @file Labels of the lines of a figure, from the values that vary.
namespace ricochet {

/// Returns the values of a run on these axes, each as short as possible while unambiguous: "bathe, step 0.01".
[[nodiscard]] std::string label_by_axes(const PlannedRun& run, const StudyPlan& plan,
                                        const std::vector<std::size_t>& axes);

/// Returns the kind of each value along an axis whose keys change together: "adaptive" or "numeric step", or "" if all
/// are of one kind. Values of different kinds make different lines: numbers, "-", and words that occur more than once
/// or beside numbers, as in time.step,time.tolerance=1e-4/-,5e-5/-,adaptive/1e-3. `shown` is the key on the horizontal
/// axis, which makes no lines.
[[nodiscard]] std::vector<std::string> kinds_along(const StudyAxis& axis, const std::string& shown);

/// Returns labels of runs of one study, from their differences; empty if they do not all belong to one study.
[[nodiscard]] std::vector<std::string> labels_in_study(const std::vector<std::string>& directories);

}  // namespace ricochet
