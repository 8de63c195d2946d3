#include "ricochet/simulation/monitor/body_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "ricochet/base/angles.hpp"
#include "ricochet/mesh/search/closest_point.hpp"

namespace ricochet {

namespace {}  // namespace

BodySurface::BodySurface(const Points& positions, const std::vector<Piece>& pieces) : plane_(positions.rows() == 2) {
  const std::size_t corners = plane_ ? 2 : 3;
  for (const Piece& piece : pieces) nodes_.insert(nodes_.end(), piece.begin(), piece.begin() + long(corners));
  std::ranges::sort(nodes_);
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  first_piece_.assign(nodes_.size() + 1, 0);
  for (const Piece& piece : pieces) {
    Corners own{-1, -1, -1};
    for (std::size_t k = 0; k < corners; ++k) {
      own[k] = int(std::ranges::lower_bound(nodes_, piece[k]) - nodes_.begin());
      ++first_piece_[std::size_t(own[k]) + 1];
    }
    pieces_.push_back(own);
  }
  std::partial_sum(first_piece_.begin(), first_piece_.end(), first_piece_.begin());
  around_.resize(std::size_t(first_piece_.back()));
  std::vector<int> next(first_piece_.begin(), first_piece_.end() - 1);
  for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
    for (std::size_t k = 0; k < corners; ++k) around_[std::size_t(next[std::size_t(pieces_[piece][k])]++)] = int(piece);
  }
  positions_.assign(nodes_.size(), Eigen::Vector3d::Zero());
  boxes_.resize(pieces_.size());
  move(positions, Vector());
  tree_ = BoxTree(boxes_);
  for (const Corners& piece : pieces_) {
    for (std::size_t k = 0; k < corners; ++k) edge_length_ += (at(piece[k]) - at(piece[(k + 1) % corners])).norm();
  }
  edge_length_ /= double(corners * pieces_.size());
}

void BodySurface::move(const Points& positions, const Vector& displacement) {
  const Index d = positions.rows();
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Index node = nodes_[i];
    for (Index k = 0; k < d; ++k)
      positions_[i][k] = positions(k, node) + (displacement.size() > 0 ? displacement[node * d + k] : 0.0);
  }
  compute_boxes();
  if (!tree_.empty()) tree_.refit(boxes_);
}

void BodySurface::compute_boxes() {
  for (std::size_t piece = 0; piece < pieces_.size(); ++piece) {
    boxes_[piece].setEmpty();
    for (const int node : pieces_[piece]) {
      if (node >= 0) boxes_[piece].extend(at(node));
    }
  }
}

BodySurface::Closest BodySurface::closest_on_piece(const Eigen::Vector3d& point, int piece) const {
  const Corners& corners = pieces_[std::size_t(piece)];
  const ClosestPoint found = plane_ ? closest_on_segment(point, at(corners[0]), at(corners[1]))
                                    : closest_on_triangle(point, at(corners[0]), at(corners[1]), at(corners[2]));
  Closest result{(point - found.position).squaredNorm(), found.position, piece, {-1, -1, -1}};
  for (std::size_t k = 0; k < 3; ++k) {
    if (found.corners[k] >= 0) result.corners[k] = corners[std::size_t(found.corners[k])];
  }
  return result;
}

BodySurface::Closest BodySurface::closest(const Eigen::Vector3d& point) const {
  return closest_of(point, [](int, const Eigen::Vector3d&) { return true; });
}

Eigen::Vector3d BodySurface::normal_of(int piece) const {
  const Corners& corners = pieces_[std::size_t(piece)];
  const Eigen::Vector3d along = at(corners[1]) - at(corners[0]);
  if (plane_) return Eigen::Vector3d(along[1], -along[0], 0.0).normalized();
  return along.cross(at(corners[2]) - at(corners[0])).normalized();
}

Eigen::Vector3d BodySurface::normal_at(int node) const {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const int piece : around(node)) {
    const Corners& own = pieces_[std::size_t(piece)];
    const auto here = std::size_t(std::ranges::find(own, node) - own.begin());
    const double weight =
        plane_ ? 1.0 : angle_between(at(own[(here + 1) % 3]) - at(own[here]), at(own[(here + 2) % 3]) - at(own[here]));
    normal += normal_of(piece) * weight;
  }
  return normal;
}

/// Returns the normal of the piece if the position is inside it; at an edge the sum of those of its pieces, at a corner
/// weighted by the pieces' angles there.
Eigen::Vector3d BodySurface::normal_at(const Closest& nearest) const {
  const Corners& corners = nearest.corners;
  const bool inside = corners[1] >= 0 && (plane_ || corners[2] >= 0);
  if (inside) return normal_of(nearest.piece);
  if (corners[1] < 0) return normal_at(corners[0]);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (const int piece : around(corners[0])) {
    const Corners& own = pieces_[std::size_t(piece)];
    if (std::ranges::find(own, corners[1]) != own.end()) normal += normal_of(piece);
  }
  return normal;
}

double BodySurface::signed_distance(const Eigen::Vector3d& point) const {
  const Closest nearest = closest(point);
  if (nearest.piece < 0) return std::numeric_limits<double>::infinity();  // numbers too large to be squared
  const double distance = std::sqrt(nearest.squared_distance);
  return normal_at(nearest).dot(point - nearest.position) < 0.0 ? -distance : distance;
}

}  // namespace ricochet
