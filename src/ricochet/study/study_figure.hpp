#pragma once

#include <string>
#include <vector>

#include "ricochet/study/study_files.hpp"
#include "ricochet/study/table.hpp"

/// @file Figures of a study, described in JSON for the script that draws them.
namespace ricochet {

struct StudyFigureOptions {
  /// One panel each: "work-precision" (errors against processor time), "order" (errors against the key of the orders),
  /// each for all errors or for one ("order:NAME"); or "COLUMN-against-KEY" for any two columns of the table.
  std::vector<std::string> what;
  std::string title = {};
  bool logarithmic = false;          ///< vertical scale of COLUMN-against-KEY
  double width = 0.0, height = 0.0;  ///< cm; 0: chosen to suit the panels
};

/// Describes the figures. Lines connect runs that differ only in the key on the horizontal axis; there is one for each
/// combination of the others. Runs without a value are left out. Throws Error(usage) if something cannot be drawn, and
/// lists the possible figures.
[[nodiscard]] std::string describe_study_figure(const Study& study, const ResultTable& table,
                                                const StudyFigureOptions& options);

/// Returns the figures of a page: errors if there are any, else the results against each numeric key.
[[nodiscard]] std::vector<std::string> usual_figures(const Study& study, const ResultTable& table);

}  // namespace ricochet
