#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/report/run_data.hpp"

/// @file Figures for papers, described in JSON for the script that draws them.
namespace ricochet {

struct FigureOptions {
  /// One panel each (a map: one per run): "energy", "force", "momentum", "pressure", "pressure-map",
  /// "probe:NAME.COLUMN" or any column of the history.
  std::vector<std::string> what;
  std::vector<std::string> labels = {};  ///< of the runs; empty: their names
  std::string title = {};
  std::optional<std::pair<double, double>> time = {};  ///< interval to be shown
  bool logarithmic = false;
  double width = 0.0, height = 0.0;  ///< cm; 0: chosen to suit the panels
};

/// Throws Error(usage) if something cannot be drawn, and lists what can be.
[[nodiscard]] std::string describe_figure(const std::vector<RunData>& runs, const FigureOptions& options);

}  // namespace ricochet
