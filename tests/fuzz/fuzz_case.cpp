#include <cstdint>
#include <string>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/case/read_case.hpp"

/// @file Any bytes as a case file yield a case, or an error of the library.

namespace {

/// Lines "#--set KEY=VALUE", comments of TOML, are overrides as on the command line.
std::vector<std::string> overrides_in(const std::string& text) {
  static const std::string mark = "#--set ";
  std::vector<std::string> result;
  for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
    const std::size_t first = at + mark.size();
    result.push_back(text.substr(first, text.find('\n', first) - first));
  }
  return result;
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int* /*argc*/, char*** /*argv*/) {
  ricochet::log::set_level(ricochet::log::Level::off);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    (void)ricochet::read_case_text(text, "case.toml", overrides_in(text));
  } catch (const ricochet::Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
