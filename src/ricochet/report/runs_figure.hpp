#pragma once

#include <string>
#include <vector>

#include "ricochet/report/figure.hpp"

/// @file The description of a figure of runs that are read for it.
namespace ricochet {

/// Reads the runs in the directories, with their fields where a figure needs those, waiting for runs that go on; runs
/// of a study that have no labels are called by what the study varies. Throws as describe_figure and read_runs do.
[[nodiscard]] std::string describe_figure_of(const std::vector<std::string>& directories, FigureOptions options);

}  // namespace ricochet
