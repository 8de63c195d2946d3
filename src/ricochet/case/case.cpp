#include "ricochet/case/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace ricochet {

std::string SourceLocation::text() const { return line > 0 ? fmt::format("{}:{}:{}", file, line, column) : file; }

SourceLocation Case::where(const std::string& key_path) const {
  std::string enclosing = key_path;
  while (!enclosing.empty()) {
    if (const auto found = locations.find(enclosing); found != locations.end()) return found->second;
    const std::size_t dot = enclosing.rfind('.');
    enclosing = dot == std::string::npos ? "" : enclosing.substr(0, dot);
  }
  return {path, 0, 0};
}

long step_count(const TimeSection& time) {
  // An end that is a whole number of steps up to rounding is taken as that number.
  return std::max(1L, long(std::ceil(time.end / time.step * (1.0 - 1e-12))));
}

double run_end(const TimeSection& time) { return time.adaptive ? time.end : double(step_count(time)) * time.step; }

}  // namespace ricochet
