#include "ricochet/run/rotation_watch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/fem/green_strain.hpp"

namespace ricochet {

/// Rotations below the least are not recorded; above it, each growth by a hundredth is.
constexpr double least_noted = 1e-6, noted_growth = 1.01;

std::string spurious_strain(double rotation) {
  return fmt::format("a spurious strain of {:.2g} % (1 - cos of the angle)", 100.0 * (1.0 - std::cos(rotation)));
}

double limit_of_rotation(const Body& body) {
  return has_finite_strain(body) ? std::numeric_limits<double>::infinity() : rotation_limit;
}

RotationWatch::RotationWatch(const Body& body, const Ranks& ranks, std::size_t column)
    : body_(body), ranks_(ranks), column_(column), limit_(limit_of_rotation(body)) {
  // No rotation exceeds π.
  const double most = std::log(std::numbers::pi / least_noted) / std::log(noted_growth);
  records_.reserve(std::size_t(most) + 3);
}

void RotationWatch::persist(const SnapshotVisitor& visit) {
  visit.list("", records_, records_.capacity());
  bool fits = true;
  for (std::size_t i = 0; i < records_.size(); ++i) {
    const auto& [time, rotation] = records_[i];
    fits = fits && std::isfinite(time) && std::isfinite(rotation);
    if (i > 0) fits = fits && time > records_[i - 1].time && rotation > records_[i - 1].rotation;
  }
  if (visit.loads() && !fits) throw Error(ErrorKind::invalid_input, "the checkpoint's record of rotations is damaged");
}

double RotationWatch::time_beyond_limit() const {
  const auto first =
      std::ranges::find_if(records_, [this](const RotationRecord& noted) { return noted.rotation > limit_; });
  return first == records_.end() ? std::numeric_limits<double>::infinity() : first->time;
}

double RotationWatch::largest_until(double time) const {
  const auto after = std::ranges::find_if(records_, [time](const RotationRecord& noted) { return noted.time > time; });
  return after == records_.begin() ? 0.0 : std::prev(after)->rotation;
}

void RotationWatch::watch(const std::vector<double>& row, const State& state) {
  const double rotation = row[column_], before = records_.empty() ? 0.0 : records_.back().rotation;
  const bool passes = before <= limit_ && rotation > limit_;
  if (passes || (rotation > least_noted && rotation > noted_growth * before)) records_.push_back({row[1], rotation});
  if (!passes) return;
  log::warning(
      fmt::format("at t = {:.6g} a cell has rotated by {:.3g} rad: above {} rad small strain no longer holds; this "
                  "rotation causes {}, and the largest actual strain is {:.2g} %. A rotating body inflates, and from "
                  "here on its forces and rebounds are wrong; an impact that ended before is not affected. A law of "
                  "finite strain (law = \"neo-hookean\" in [[material]]) holds for any rotation",
                  row[1], rotation, rotation_limit, spurious_strain(rotation),
                  100.0 * ranks_.maximum(largest_green_strain(body_, state.displacement))));
}

}  // namespace ricochet
