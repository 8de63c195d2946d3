#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "texts.hpp"

namespace ricochet::program {

/// Rounding of sums over all nodes of a mesh, relative to their terms.
constexpr double rounding = 1e-12;

double without_rounding(double value, double size) { return std::abs(value) > rounding * size ? value : 0.0; }

std::string percent(double part) { return fmt::format("{:.{}g} %", 100.0 * part, std::abs(part) < 0.1 ? 2 : 3); }

std::string vector_text(const Vector& values, double size, int digits) {
  std::string text;
  for (const double value : values) {
    const double shown = without_rounding(value, std::max(size, values.norm()));
    text += fmt::format("{}{:.{}g}", text.empty() ? "" : ", ", shown, digits);
  }
  return "(" + text + ")";
}

}  // namespace ricochet::program
