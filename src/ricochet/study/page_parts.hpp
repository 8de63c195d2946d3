#pragma once

#include <string>
#include <vector>

/// @file What the pages of studies and of benchmarks are made of: HTML.
namespace ricochet {

/// A page up to its heading; `mark` is a comment by which is_page_with knows it again.
[[nodiscard]] std::string page_begin(const std::string& mark, const std::string& title);
[[nodiscard]] std::string page_end();
[[nodiscard]] bool is_page_with(const std::string& mark, const std::string& path);

/// Sentences, as texts, not as HTML.
[[nodiscard]] std::string html_list(const std::vector<std::string>& sentences);
/// To a file or directory, as seen from the folder that the page is in.
[[nodiscard]] std::string html_link(const std::string& target, const std::string& folder, const std::string& text);
/// To the directory of a run, or to its report where there is one.
[[nodiscard]] std::string html_link_to_run(const std::string& directory, const std::string& folder);

}  // namespace ricochet
