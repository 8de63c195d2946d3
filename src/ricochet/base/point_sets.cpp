#include "ricochet/base/point_sets.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "ricochet/base/dense_decompositions.hpp"

namespace ricochet {

namespace {

/// Relative tolerance: points no farther outside a ball than this count as inside.
constexpr double rounding = 1e-12;

struct Ball {
  Vector centre;
  double radius = 0.0;
  [[nodiscard]] bool has(const Vector& point) const { return (point - centre).norm() <= (1.0 + rounding) * radius; }
};

/// Returns the ball with these points on its boundary and its centre among their affine combinations: with
/// a_i = x_i − x_0 and c = x_0 + Σ λ_i a_i, Σ_j 2 a_i·a_j λ_j = a_i·a_i. None if the points are not affinely
/// independent.
std::optional<Ball> ball_through(const Points& nodes, const std::vector<Index>& points) {
  const Index count = Index(points.size()) - 1;
  const Vector first = nodes.col(points[0]);
  if (count == 0) return Ball{first, 0.0};
  Matrix edges(nodes.rows(), count);
  for (Index k = 0; k < count; ++k) edges.col(k) = nodes.col(points[std::size_t(k) + 1]) - first;
  const double scale = edges.colwise().norm().maxCoeff();
  if (!(scale > 0.0)) return std::nullopt;
  edges /= scale;
  const Matrix products = edges.transpose() * edges;
  const SmallCholesky factor(2.0 * products);
  if (!factor.positive_definite()) return std::nullopt;
  const Vector middle = scale * (edges * factor.solve(products.diagonal()));
  return middle.allFinite() ? std::optional(Ball{first + middle, middle.norm()}) : std::nullopt;
}

/// Returns the smallest ball enclosing at most d + 2 points among those through some of them, and which these are.
std::pair<Ball, std::vector<Index>> smallest_ball(const Points& nodes, const std::vector<Index>& points) {
  std::pair<Ball, std::vector<Index>> best;
  bool found = false;
  for (unsigned subset = 1; subset < (1U << points.size()); ++subset) {
    std::vector<Index> chosen;
    for (std::size_t k = 0; k < points.size(); ++k) {
      if ((subset >> k & 1U) != 0U) chosen.push_back(points[k]);
    }
    if (Index(chosen.size()) > nodes.rows() + 1) continue;
    const std::optional<Ball> ball = ball_through(nodes, chosen);
    if (!ball || (found && !(ball->radius < best.first.radius))) continue;
    if (!std::ranges::all_of(points, [&](Index point) { return ball->has(nodes.col(point)); })) continue;
    best = {*ball, chosen};
    found = true;
  }
  return best;
}

}  // namespace

double largest_distance(const Points& points) {
  double largest = 0.0;
  for (Index i = 0; i < points.cols(); ++i) {
    for (Index k = 0; k < i; ++k) largest = std::max(largest, (points.col(i) - points.col(k)).norm());
  }
  return largest;
}

/// Adds the farthest point to the points that support the ball and drops those no longer needed, until no point is
/// outside. The radius grows each time, so no support set occurs twice; a few iterations suffice.
double enclosing_diameter(const Points& points) {
  if (points.cols() == 0) return 0.0;
  std::pair<Ball, std::vector<Index>> ball{{points.col(0), 0.0}, {0}};
  double farthest = 0.0;
  for (;;) {
    Index at = 0;
    farthest = std::sqrt((points.colwise() - ball.first.centre).colwise().squaredNorm().maxCoeff(&at));
    const double before = ball.first.radius;
    if (farthest <= (1.0 + rounding) * before || !std::isfinite(farthest)) break;
    ball.second.push_back(at);
    ball = smallest_ball(points, ball.second);
    if (!(ball.first.radius > before)) break;
  }
  return 2.0 * farthest;
}

}  // namespace ricochet
