#include "ricochet/report/obstacle_part.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

/// Of the extent of what is drawn.
constexpr double smallest_seen = 1e-6;
/// Of a coordinate in the file, which has nine digits.
constexpr double file_rounding = 1e-9;

double largest_coordinate(const ObstacleFrame& frame) {
  double largest = 0.0;
  for (const double x : frame.positions) largest = std::max(largest, std::abs(x));
  return largest;
}

/// Longest side of the box around all points.
double extent(const ObstacleFrame& frame) {
  double longest = 0.0;
  for (std::size_t axis = 0; axis < 3 && axis < frame.positions.size(); ++axis) {
    double low = frame.positions[axis], high = low;
    for (std::size_t k = axis; k < frame.positions.size(); k += 3) {
      low = std::min(low, frame.positions[k]);
      high = std::max(high, frame.positions[k]);
    }
    longest = std::max(longest, high - low);
  }
  return longest;
}

/// How far obstacles are from where they were in the first frame.
class Translations {
 public:
  explicit Translations(const ObstacleFrame& first)
      : first_(first),
        obstacle_(first.positions.size() / 3, 0),
        seen_(smallest_seen * extent(first)),
        largest_(largest_coordinate(first)) {
    const auto corners = static_cast<std::size_t>(first.corners);
    for (std::size_t k = 0; k < first.cells.size(); ++k)
      obstacle_[static_cast<std::size_t>(first.cells[k])] = static_cast<std::size_t>(first.obstacle[k / corners]);
    for (const std::size_t obstacle : obstacle_) {
      if (obstacle >= points_.size()) points_.resize(obstacle + 1, 0.0);
      points_[obstacle] += 1.0;
    }
  }

  /// obstacles × 3; nothing where a point is visibly elsewhere than it would be then.
  [[nodiscard]] std::optional<std::vector<double>> of(const ObstacleFrame& frame) const {
    std::vector<double> offsets(3 * points_.size(), 0.0);
    const auto way = [&](std::size_t k) { return frame.positions[k] - first_.positions[k]; };
    const auto entry = [&](std::size_t k) { return 3 * obstacle_[k / 3] + k % 3; };
    for (std::size_t k = 0; k < first_.positions.size(); ++k) offsets[entry(k)] += way(k) / points_[obstacle_[k / 3]];
    const double rounding = file_rounding * (largest_ + largest_coordinate(frame));
    for (std::size_t k = 0; k < first_.positions.size(); ++k) {
      if (!(std::abs(way(k) - offsets[entry(k)]) <= seen_ + 2.0 * rounding)) return std::nullopt;
    }
    return offsets;
  }

 private:
  const ObstacleFrame& first_;
  std::vector<std::size_t> obstacle_;  ///< of each point
  std::vector<double> points_;         ///< how many of each obstacle
  double seen_, largest_;
};

/// One row for each frame; nothing where an obstacle does something else than to translate.
std::optional<std::vector<double>> translations(const std::vector<const ObstacleFrame*>& frames) {
  const Translations translations(*frames.front());
  std::vector<double> all;
  for (const ObstacleFrame* frame : frames) {
    const auto offsets = translations.of(*frame);
    if (!offsets) return std::nullopt;
    all.insert(all.end(), offsets->begin(), offsets->end());
  }
  return all;
}

}  // namespace

ObstaclePart pack_obstacles(const std::vector<ObstacleFrame>& frames, PackedArrays& arrays) {
  const ObstacleFrame& first = frames.front();
  const bool moves =
      std::any_of(frames.begin(), frames.end(), [&](const ObstacleFrame& f) { return f.positions != first.positions; });
  std::vector<const ObstacleFrame*> shown;
  for (const ObstacleFrame& frame : frames) {
    if (frame.positions.size() == first.positions.size() && (moves || shown.empty())) shown.push_back(&frame);
  }
  ObstaclePart part;
  part.corners = first.corners;
  part.cells = arrays.add_indices(first.cells);
  part.obstacle = arrays.add_indices(first.obstacle);
  for (const ObstacleFrame* frame : shown) part.times.push_back(frame->time);
  const auto rows = static_cast<Index>(shown.size());
  const auto add = [&](const std::vector<double>& values, Index of_rows) {
    return arrays.add_reals(values, of_rows, static_cast<Index>(values.size()) / of_rows);
  };
  const auto offsets = moves ? translations(shown) : std::nullopt;
  if (offsets) part.offsets = add(*offsets, rows);
  std::vector<double> positions = first.positions;
  if (moves && !offsets) {
    for (std::size_t k = 1; k < shown.size(); ++k)
      positions.insert(positions.end(), shown[k]->positions.begin(), shown[k]->positions.end());
  }
  part.positions = add(positions, moves && !offsets ? rows : 1);
  return part;
}

}  // namespace ricochet
