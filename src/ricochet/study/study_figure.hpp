#pragma once

#include <string>
#include <vector>

#include "ricochet/study/study_files.hpp"
#include "ricochet/study/table.hpp"

/// @file Figures of a study: what is to be drawn, described in JSON for the script that draws it.
namespace ricochet {

struct StudyFigureOptions {
  /// A panel for each: "work-precision" (errors against processor time), "order" (errors against the key that orders
  /// are of), both of all errors or of one ("order:NAME"); or "COLUMN-against-KEY" of any two columns of the table.
  std::vector<std::string> what;
  std::string title = {};
  bool logarithmic = false;          ///< of COLUMN-against-KEY: the vertical scale
  double width = 0.0, height = 0.0;  ///< cm; 0: what suits the panels
};

/// Lines join runs that differ in the key on the horizontal axis alone; there is one for each combination of all
/// others. Runs without a value are left out. Throws Error(usage) where something cannot be drawn, and says what can
/// be.
[[nodiscard]] std::string describe_study_figure(const Study& study, const ResultTable& table,
                                                const StudyFigureOptions& options);

/// What a page shows: errors if there are some, else what came out against each numeric key.
[[nodiscard]] std::vector<std::string> usual_figures(const Study& study, const ResultTable& table);

}  // namespace ricochet
