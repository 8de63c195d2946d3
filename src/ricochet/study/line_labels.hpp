#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "ricochet/study/plan.hpp"

/// @file What the lines of a figure are called: by the values of what varies.
namespace ricochet {

/// The values that a run has of these axes, each as short as it can be told from the others: "bathe, step 0.01".
[[nodiscard]] std::string label_by_axes(const PlannedRun& run, const StudyPlan& plan,
                                        const std::vector<std::size_t>& axes);

/// Along an axis whose keys change together, values that are of different kinds make different lines: numbers, "-", and
/// words that come more than once or beside numbers, as in time.step,time.tolerance=1e-4/-,5e-5/-,adaptive/1e-3. The
/// kind of each value of the axis in words, "adaptive" or "numeric step"; "" where all are of one kind. `shown` is the
/// key on the horizontal axis, which makes none.
[[nodiscard]] std::vector<std::string> kinds_along(const StudyAxis& axis, const std::string& shown);

/// Of runs of one study, by what differs between them; empty where they are not all of one study.
[[nodiscard]] std::vector<std::string> labels_in_study(const std::vector<std::string>& directories);

}  // namespace ricochet
