#include "ricochet/case/problems.hpp"

#include <algorithm>
#include <tuple>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"

namespace ricochet {

void Problems::add(const SourceLocation& location, const std::string& message) {
  problems_.push_back({location, message});
}

void Problems::raise() const {
  if (problems_.empty()) return;
  std::vector<Problem> sorted = problems_;
  std::ranges::stable_sort(sorted, [](const Problem& a, const Problem& b) {
    const bool a_is_override = a.location.line == 0, b_is_override = b.location.line == 0;
    return std::tie(a_is_override, a.location.line, a.location.column) <
           std::tie(b_is_override, b.location.line, b.location.column);
  });
  std::string text;
  for (const Problem& problem : sorted) {
    if (!text.empty()) text += '\n';
    text += problem.location.text() + ": " + problem.message;
  }
  throw Error(ErrorKind::invalid_input, text);
}

void Problems::add_warning(const SourceLocation& location, const std::string& message) {
  warnings_.push_back(location.text() + ": " + message);
}

void Problems::add_info(const SourceLocation& location, const std::string& message) {
  infos_.push_back(location.text() + ": " + message);
}

void Problems::log_remarks() const {
  for (const std::string& message : warnings_) log::warning(message);
  for (const std::string& message : infos_) log::info(message);
}

}  // namespace ricochet
