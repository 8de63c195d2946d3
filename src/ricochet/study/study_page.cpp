#include "ricochet/study/study_page.hpp"

#include <fmt/format.h>

#include <filesystem>

#include "ricochet/base/text.hpp"
#include "ricochet/study/page_parts.hpp"

namespace ricochet {

namespace {

constexpr const char* page_mark = "ricochet study";

/// Returns an SVG as part of a page, without the text before its element.
std::string inline_svg(const std::string& document) {
  const std::size_t begin = document.find("<svg");
  return begin == std::string::npos ? "" : document.substr(begin);
}

std::string links_to_runs(const Study& study, const std::string& folder) {
  std::string text = "<ul>\n";
  for (const StudyRun& run : study.runs) text += "<li>" + html_link_to_run(study.path(run), folder) + "</li>\n";
  return text + "</ul>\n";
}

}  // namespace

std::string make_study_page(const Study& study, const StudyResults& results, const std::string& figure,
                            const std::string& runs_page, const std::string& folder) {
  const std::string title = "Study of " + std::filesystem::path(study.plan.case_path).filename().string();
  std::string page = page_begin(page_mark, title);
  std::vector<std::string> plan;
  for (const StudyAxis& axis : study.plan.axes) {
    std::vector<std::string> values;
    for (const auto& entry : axis.values) values.push_back(fmt::format("{}", fmt::join(entry, "/")));
    plan.push_back(fmt::format("{} varies: {}", fmt::join(axis.keys, ", "), fmt::join(values, ", ")));
  }
  for (const std::string& setting : study.plan.settings) plan.push_back(fmt::format("set: {}", setting));
  page += html_list(plan) + "<h2>Results</h2>\n<div class=\"wide\">\n" + to_html(results.table) + "</div>\n";
  if (!results.notes.empty()) page += html_list(results.notes);
  if (!results.warnings.empty()) {
    page += fmt::format("<details><summary>{} of the runs</summary>\n", counted(results.warnings.size(), "warning"));
    page += html_list(results.warnings) + "</details>\n";
  }
  if (!figure.empty()) page += "<h2>Figures</h2>\n" + inline_svg(figure) + "\n";
  page += "<h2>Runs</h2>\n";
  if (!runs_page.empty()) page += "<p>" + html_link(study.path(runs_page), folder, "Report of the runs") + "</p>\n";
  page += links_to_runs(study, folder);
  return page + page_end();
}

bool is_study_page(const std::string& path) { return is_page_with(page_mark, path); }

}  // namespace ricochet
