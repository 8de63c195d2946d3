#include "ricochet/report/obstacle_part.hpp"

#include <algorithm>

#include "ricochet/base/types.hpp"

namespace ricochet {

namespace {

/// Smallest visible distance, relative to the extent of the picture.
constexpr double smallest_visible = 1e-6;
/// Rounding of coordinates in the file, which have nine digits.
constexpr double file_rounding = 1e-9;

Eigen::Map<const Points> points_of(const ObstacleFrame& frame) {
  return {frame.positions.data(), 3, Index(frame.positions.size()) / 3};
}

/// Translations of obstacles relative to the first frame, which has at least one point.
class Translations {
 public:
  explicit Translations(const ObstacleFrame& first)
      : first_(points_of(first)), obstacle_(first.positions.size() / 3, 0) {
    visible_distance_ = smallest_visible * (first_.rowwise().maxCoeff() - first_.rowwise().minCoeff()).maxCoeff();
    const auto corners = std::size_t(first.corners);
    for (std::size_t k = 0; k < first.cells.size(); ++k)
      obstacle_[std::size_t(first.cells[k])] = first.obstacle[k / corners];
    count_.setZero(1 + *std::ranges::max_element(obstacle_));
    for (const int obstacle : obstacle_) count_[obstacle] += 1.0;
  }

  /// Returns 3 × obstacles; none if a point visibly deviates from the translation of its obstacle.
  [[nodiscard]] std::optional<Matrix> of(const ObstacleFrame& frame) const {
    const Eigen::Map<const Points> points = points_of(frame);
    const Points way = points - first_;
    Matrix mean = Matrix::Zero(3, count_.size());
    for (Index k = 0; k < way.cols(); ++k) mean.col(obstacle(k)) += way.col(k) / count_[obstacle(k)];
    const double rounding = file_rounding * (first_.cwiseAbs().maxCoeff() + points.cwiseAbs().maxCoeff());
    for (Index k = 0; k < way.cols(); ++k) {
      if (!((way.col(k) - mean.col(obstacle(k))).cwiseAbs().maxCoeff() <= visible_distance_ + 2.0 * rounding))
        return std::nullopt;
    }
    return mean;
  }

 private:
  [[nodiscard]] int obstacle(Index point) const { return obstacle_[std::size_t(point)]; }

  Eigen::Map<const Points> first_;
  std::vector<int> obstacle_;  ///< per point
  Vector count_;               ///< points per obstacle
  double visible_distance_ = 0.0;
};

/// Returns one row per frame; none if an obstacle does not merely translate.
std::optional<std::vector<double>> translations(const std::vector<const ObstacleFrame*>& frames) {
  const Translations translations(*frames.front());
  std::vector<double> all;
  for (const ObstacleFrame* frame : frames) {
    const auto offsets = translations.of(*frame);
    if (!offsets) return std::nullopt;
    all.insert(all.end(), offsets->data(), offsets->data() + offsets->size());
  }
  return all;
}

}  // namespace

ObstaclePart pack_obstacles(const std::vector<ObstacleFrame>& frames, PackedArrays& arrays) {
  const ObstacleFrame& first = frames.front();
  std::vector<const ObstacleFrame*> shown;
  for (const ObstacleFrame& frame : frames) {
    if (frame.positions.size() == first.positions.size()) shown.push_back(&frame);
  }
  const bool moves =
      std::ranges::any_of(shown, [&](const ObstacleFrame* f) { return f->positions != first.positions; });
  if (!moves) shown.resize(1);
  ObstaclePart part;
  part.corners = first.corners;
  part.cells = arrays.add_indices(first.cells);
  part.obstacle = arrays.add_indices(first.obstacle);
  for (const ObstacleFrame* frame : shown) part.times.push_back(frame->time);
  const auto rows = Index(shown.size());
  const auto add = [&](const std::vector<double>& values, Index of_rows) {
    return arrays.add_reals(values, of_rows, Index(values.size()) / of_rows);
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
