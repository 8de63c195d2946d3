#include "ricochet/study/study_page.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>

#include "ricochet/base/text.hpp"
#include "ricochet/version.hpp"

namespace ricochet {

namespace {

constexpr std::string_view page_mark = "<!-- ricochet study -->";

constexpr std::string_view page_style = R"(
body { font: 15px/1.5 "DejaVu Sans", system-ui, sans-serif; color: #1b1f24; max-width: 78rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.4rem; } h2 { font-size: 1.1rem; margin-top: 2rem; }
.wide { overflow-x: auto; } svg { max-width: 100%; height: auto; }
table { border-collapse: collapse; font-size: 0.85rem; margin-bottom: 1.5rem; }
th, td { padding: 0.2rem 0.7rem; border-bottom: 1px solid #d8dbdf; text-align: left; }
th, .number { white-space: nowrap; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
)";

/// An SVG as part of a page: without what stands before its element.
std::string inline_svg(const std::string& document) {
  const std::size_t begin = document.find("<svg");
  return begin == std::string::npos ? "" : document.substr(begin);
}

std::string list_of(const std::vector<std::string>& sentences) {
  std::string text = "<ul>\n";
  for (const std::string& sentence : sentences) text += fmt::format("<li>{}</li>\n", escaped(sentence));
  return text + "</ul>\n";
}

std::string link(const Study& study, const std::string& file, const std::string& folder, const std::string& text) {
  const std::filesystem::path target = std::filesystem::absolute(study.path(file)).lexically_normal();
  const std::filesystem::path from = std::filesystem::absolute(folder).lexically_normal();
  return fmt::format("<a href=\"{}\">{}</a>", escaped(target.lexically_relative(from).generic_string()), escaped(text));
}

std::string links_to_runs(const Study& study, const std::string& folder) {
  std::string text = "<ul>\n";
  for (const StudyRun& run : study.runs) {
    std::error_code ignored;
    const std::string directory = "runs/" + run.folder, report = directory + "/report.html";
    const bool has_report = std::filesystem::exists(study.path(report), ignored);
    text += "<li>" + link(study, has_report ? report : directory, folder, run.folder) + "</li>\n";
  }
  return text + "</ul>\n";
}

}  // namespace

std::string make_study_page(const Study& study, const StudyResults& results, const std::string& figure,
                            const std::string& runs_page, const std::string& folder) {
  const std::string title = "Study of " + std::filesystem::path(study.plan.case_path).filename().string();
  std::string page = fmt::format(
      "<!doctype html>\n{}\n<html lang=\"en\">\n<head><meta "
      "charset=\"utf-8\"><title>{}</title><style>{}</style></head>\n"
      "<body>\n<h1>{}</h1>\n",
      page_mark, escaped(title), page_style, escaped(title));
  std::vector<std::string> plan;
  for (const StudyAxis& axis : study.plan.axes) {
    std::vector<std::string> values;
    for (const auto& entry : axis.values) values.push_back(fmt::format("{}", fmt::join(entry, "/")));
    plan.push_back(fmt::format("{} varies: {}", fmt::join(axis.keys, ", "), fmt::join(values, ", ")));
  }
  for (const std::string& setting : study.plan.settings) plan.push_back(fmt::format("set: {}", setting));
  page += list_of(plan) + "<h2>Results</h2>\n<div class=\"wide\">\n" + to_html(results.table) + "</div>\n";
  if (!results.notes.empty()) page += list_of(results.notes);
  if (!results.warnings.empty()) {
    page += fmt::format("<details><summary>{} of the runs</summary>\n", counted(results.warnings.size(), "warning"));
    page += list_of(results.warnings) + "</details>\n";
  }
  if (!figure.empty()) page += "<h2>Figures</h2>\n" + inline_svg(figure) + "\n";
  page += "<h2>Runs</h2>\n";
  if (!runs_page.empty()) page += "<p>" + link(study, runs_page, folder, "Report of the runs") + "</p>\n";
  page += links_to_runs(study, folder);
  return page + fmt::format("<p>Ricochet {}</p>\n</body>\n</html>\n", version);
}

bool is_study_page(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(64, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find(page_mark) != std::string::npos;
}

}  // namespace ricochet
