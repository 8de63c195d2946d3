#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/text.hpp"
#include "texts.hpp"

namespace ricochet::program {

std::string found_text(const ExpectationResult& expectation) {
  return expectation.note.empty() ? fmt::format("found {:.9g}", expectation.value)
                                  : fmt::format("found no value: {}", expectation.note);
}

void print_expectations(const std::vector<ExpectationResult>& expectations) {
  if (expectations.empty()) return;
  const auto met =
      std::count_if(expectations.begin(), expectations.end(), [](const auto& e) { return e.checked && e.holds; });
  const auto left_out =
      std::count_if(expectations.begin(), expectations.end(), [](const auto& e) { return !e.checked; });
  const auto checked = static_cast<long>(expectations.size()) - left_out;
  const std::string others = fmt::format("{} not apply to this run (see summary.json for the reason)",
                                         left_out == 1 ? "1 does" : fmt::format("{} do", left_out));
  if (checked == 0) {
    fmt::print("  expectations: {}\n", others);
  } else {
    fmt::print("  {} of {}{}\n", met, counted(checked, "expectation") + (checked == 1 ? " holds" : " hold"),
               left_out > 0 ? "; " + others : "");
  }
  for (const ExpectationResult& e : expectations) {
    if (!e.checked || e.holds) continue;
    fmt::print("  DOES NOT HOLD: {} (expected {}, {})\n", e.label(), e.expected, found_text(e));
    if (!e.published.empty()) fmt::print("    published: {}\n", e.published);
  }
}

}  // namespace ricochet::program
