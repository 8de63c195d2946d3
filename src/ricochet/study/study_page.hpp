#pragma once

#include <string>

#include "ricochet/study/study_files.hpp"
#include "ricochet/study/study_table.hpp"

/// @file The page of a study: an HTML file with its table and figures.
namespace ricochet {

/// `figure`: an SVG document, or empty. `runs_page`: the name of a report of its runs in its directory, or empty. Links
/// go to the study's directory as seen from `folder`, where the page is.
[[nodiscard]] std::string make_study_page(const Study& study, const StudyResults& results, const std::string& figure,
                                          const std::string& runs_page, const std::string& folder);

/// Is this file one that make_study_page has made?
[[nodiscard]] bool is_study_page(const std::string& path);

}  // namespace ricochet
