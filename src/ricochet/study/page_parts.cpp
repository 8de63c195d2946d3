#include "ricochet/study/page_parts.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <string_view>

#include "ricochet/study/table.hpp"
#include "ricochet/version.hpp"

namespace ricochet {

namespace {

constexpr std::string_view page_style = R"(
body { font: 15px/1.5 "DejaVu Sans", system-ui, sans-serif; color: #1b1f24; max-width: 78rem; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.4rem; } h2 { font-size: 1.1rem; margin-top: 2rem; }
.wide { overflow-x: auto; } svg { max-width: 100%; height: auto; }
table { border-collapse: collapse; font-size: 0.85rem; margin-bottom: 1.5rem; }
th, td { padding: 0.2rem 0.7rem; border-bottom: 1px solid #d8dbdf; text-align: left; }
th, .number { white-space: nowrap; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
)";

std::string comment_of(const std::string& mark) { return fmt::format("<!-- {} -->", mark); }

}  // namespace

std::string page_begin(const std::string& mark, const std::string& title) {
  return fmt::format(
      "<!doctype html>\n{}\n<html lang=\"en\">\n<head><meta "
      "charset=\"utf-8\"><title>{}</title><style>{}</style></head>\n"
      "<body>\n<h1>{}</h1>\n",
      comment_of(mark), escaped(title), page_style, escaped(title));
}

std::string page_end() { return fmt::format("<p>Ricochet {}</p>\n</body>\n</html>\n", version); }

bool is_page_with(const std::string& mark, const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string head(64, '\0');
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  return head.find(comment_of(mark)) != std::string::npos;
}

std::string html_list(const std::vector<std::string>& sentences) {
  std::string text = "<ul>\n";
  for (const std::string& sentence : sentences) text += fmt::format("<li>{}</li>\n", escaped(sentence));
  return text + "</ul>\n";
}

std::string html_link(const std::string& target, const std::string& folder, const std::string& text) {
  const std::filesystem::path to = std::filesystem::absolute(target).lexically_normal();
  const std::filesystem::path from = std::filesystem::absolute(folder).lexically_normal();
  return fmt::format("<a href=\"{}\">{}</a>", escaped(to.lexically_relative(from).generic_string()), escaped(text));
}

std::string html_link_to_run(const std::string& directory, const std::string& folder) {
  std::error_code ignored;
  const std::filesystem::path report = std::filesystem::path(directory) / "report.html";
  const std::string name = std::filesystem::path(directory).filename().string();
  return html_link(std::filesystem::exists(report, ignored) ? report.string() : directory, folder, name);
}

}  // namespace ricochet
