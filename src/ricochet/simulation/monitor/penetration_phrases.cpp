#include "ricochet/simulation/monitor/penetration_phrases.hpp"

#include <fmt/format.h>

namespace ricochet::penetration_phrases {

std::string coordinates(const std::vector<double>& position) {
  std::string text;
  for (const double value : position) text += fmt::format("{}{:.4g}", text.empty() ? "(" : ", ", value);
  return text + ")";
}

std::string when(double time) { return time == 0.0 ? "at the start" : fmt::format("at t = {:.6g}", time); }

std::string depth_text(const UnwatchedPenetration& p) {
  return fmt::format("{:.3g} ({:.2g} of {} size)", p.depth, p.relative_depth,
                     p.bodies.size() == 1 ? "its" : "the smaller body's");
}

}  // namespace ricochet::penetration_phrases
