#pragma once

#include <string>
#include <vector>

#include "ricochet/report/figure.hpp"

/// @file The description of a figure together with the runs that it needs.
namespace ricochet {

/// Reads the runs in the directories, with their fields if a figure needs them, waiting for runs in progress; runs of a
/// study without labels are named after the values that the study varies. Throws as describe_figure and read_runs do.
[[nodiscard]] std::string describe_figure_of(const std::vector<std::string>& directories, FigureOptions options);

}  // namespace ricochet
