#pragma once

#include <string>

#include "ricochet/study/study_files.hpp"
#include "ricochet/study/study_table.hpp"

/// @file The page of a study: an HTML file with its table and figures.
namespace ricochet {

/// Makes the page. `figure` is an SVG document, or empty; `runs_page` is the name of a report of its runs in its
/// directory, or empty. Links to the study's directory are relative to `folder`, which contains the page.
[[nodiscard]] std::string make_study_page(const Study& study, const StudyResults& results, const std::string& figure,
                                          const std::string& runs_page, const std::string& folder);

/// Returns true if make_study_page has made this file.
[[nodiscard]] bool is_study_page(const std::string& path);

}  // namespace ricochet
