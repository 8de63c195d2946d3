#include "ricochet/case/case.hpp"

#include <fmt/format.h>

namespace ricochet {

std::string SourceLocation::text() const {
  return line > 0 ? fmt::format("{}:{}:{}", file, line, column) : file;
}

SourceLocation Case::where(const std::string& key_path) const {
  std::string enclosing = key_path;
  while (!enclosing.empty()) {
    if (const auto found = locations.find(enclosing); found != locations.end()) return found->second;
    const std::size_t dot = enclosing.rfind('.');
    enclosing = dot == std::string::npos ? "" : enclosing.substr(0, dot);
  }
  return {path, 0, 0};
}

}  // namespace ricochet
