#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/base/log.hpp"
#include "ricochet/base/rounded.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file Detection of load and motion changes that fit inside one adaptive step.
namespace ricochet {

namespace {

struct Brief {
  double start = 0.0, duration = 0.0;  ///< the part that the values at the ends of an interval do not show
};

/// Searches intervals of the longest step for one within which a function of time departs from the line between its end
/// values by far more than the end values differ. A step of that length sees nothing of such a change.
template <class Function>
std::optional<Brief> find_brief_change(const Function& value, double longest, double end) {
  constexpr int parts = 32;
  constexpr double most_intervals = 20'000.0, felt = 0.05, shown = 0.1;
  const auto intervals = int(std::min(std::ceil(end / longest), most_intervals));
  std::vector<double> values(static_cast<std::size_t>(intervals * parts + 1));
  const double spacing = longest / parts;
  double scale = 0.0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = value(std::min(double(k) * spacing, end));
    scale = std::max(scale, std::abs(values[k]));
  }
  for (int i = 0; i < intervals; ++i) {
    const double* const at = values.data() + std::ptrdiff_t(i) * parts;
    const auto beside = [&](int k) { return std::abs(at[k] - at[0] - (at[parts] - at[0]) * k / parts); };
    double most = 0.0;
    for (int k = 1; k < parts; ++k) most = std::max(most, beside(k));
    if (most <= felt * scale) continue;
    // The ends of the neighbouring intervals would reveal the change to a step as well.
    double least_end = at[0], most_end = at[0];
    for (int k = std::max(i - 1, 0); k <= std::min(i + 2, intervals); ++k) {
      least_end = std::min(least_end, values[std::size_t(k * parts)]);
      most_end = std::max(most_end, values[std::size_t(k * parts)]);
    }
    if (most_end - least_end > shown * most) continue;
    int first = 1, last = parts - 1;
    while (beside(first) < 0.5 * most) ++first;
    while (beside(last) < 0.5 * most) --last;
    return Brief{(i * parts + first) * spacing, std::max(last - first, 1) * spacing};
  }
  return std::nullopt;
}

/// Returns all functions of time of the case with their keys.
std::vector<std::pair<std::string, const Expression*>> functions_of_time(const Case& input) {
  std::vector<std::pair<std::string, const Expression*>> result;
  const auto add = [&](const std::string& key, const std::vector<Expression>& values) {
    for (const Expression& value : values)
      if (value.depends_on_time()) result.emplace_back(key, &value);
  };
  const auto add_one = [&](const std::string& key, const Expression& value) {
    if (value.depends_on_time()) result.emplace_back(key, &value);
  };
  for (std::size_t i = 0; i < input.supports.size(); ++i)
    add_one(fmt::format("support.{}.value", i), input.supports[i].value);
  for (std::size_t i = 0; i < input.tractions.size(); ++i)
    add(fmt::format("traction.{}.value", i), input.tractions[i].value);
  for (std::size_t i = 0; i < input.pressures.size(); ++i)
    add_one(fmt::format("pressure.{}.value", i), input.pressures[i].value);
  add("load.body_force", input.load.body_force);
  for (const ObstacleSection& obstacle : input.obstacles) {
    add("obstacle." + obstacle.name + ".motion", obstacle.motion);
    add("obstacle." + obstacle.name + ".rotation", obstacle.rotation);
    add("obstacle." + obstacle.name + ".force", obstacle.force);
    add("obstacle." + obstacle.name + ".torque", obstacle.torque);
  }
  return result;
}

}  // namespace

void warn_of_brief_changes(const Case& input, const Vector& centre) {
  const double longest = input.time.step;
  std::string last_key;
  for (const auto& [key, function] : functions_of_time(input)) {
    if (key == last_key) continue;
    const auto value = [&, &f = *function](double time) {
      return f(centre[0], centre[1], centre.size() > 2 ? centre[2] : 0.0, time);
    };
    const std::optional<Brief> brief = find_brief_change(value, longest, input.time.end);
    if (!brief) continue;
    last_key = key;
    log::warning(fmt::format(
        "{}: this value changes and returns at t = {:.6g}, within {:.2g}, but steps may be as long as {:g}: adaptive "
        "steps evaluate it at their ends and may miss the change; set time.largest = {:.1g} or less",
        input.where(key).text(), brief->start, brief->duration, longest, rounded_down(0.5 * brief->duration, 1)));
  }
}

}  // namespace ricochet
