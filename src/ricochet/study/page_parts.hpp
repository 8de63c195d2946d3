#pragma once

#include <string>
#include <vector>

/// @file Elements of the HTML pages of studies and of benchmarks.
namespace ricochet {

/// Returns a page up to its heading; `mark` is a comment by which is_page_with recognizes it.
[[nodiscard]] std::string page_begin(const std::string& mark, const std::string& title);
[[nodiscard]] std::string page_end();
[[nodiscard]] bool is_page_with(const std::string& mark, const std::string& path);

/// Returns a list of sentences, which are plain text, not HTML.
[[nodiscard]] std::string html_list(const std::vector<std::string>& sentences);
/// Returns a link to a file or directory, relative to the folder of the page.
[[nodiscard]] std::string html_link(const std::string& target, const std::string& folder, const std::string& text);
/// Returns a link to the directory of a run, or to its report if there is one.
[[nodiscard]] std::string html_link_to_run(const std::string& directory, const std::string& folder);

}  // namespace ricochet
