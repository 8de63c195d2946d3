#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/report/run_data.hpp"

/// @file Figures for papers: what is to be drawn, described in JSON for the script that draws it.
namespace ricochet {

struct FigureOptions {
  /// A panel for each (maps: for each and each run): "energy", "force", "momentum", "pressure", "pressure-map",
  /// "probe:NAME.COLUMN" or any column of the history.
  std::vector<std::string> what;
  std::vector<std::string> labels = {};  ///< of the runs; empty: their names
  std::string title = {};
  std::optional<std::pair<double, double>> time = {};  ///< the part to be shown
  bool logarithmic = false;
  double width = 0.0, height = 0.0;  ///< cm; 0: what suits the panels
};

/// Throws Error(usage) where something cannot be drawn, and says what can be.
[[nodiscard]] std::string describe_figure(const std::vector<RunData>& runs, const FigureOptions& options);

}  // namespace ricochet
