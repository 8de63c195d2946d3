#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/mesh/search/box_tree.hpp"

/// @file Closed surface of one body in its current configuration, for the depth of points inside it.
namespace ricochet {

/// Segments (2D) or triangles (3D) between nodes, in a bounding-box tree. All computations use three coordinates; in
/// two dimensions the third is 0. Nothing is allocated after construction.
class BodySurface {
 public:
  /// Nodes of one piece, the third −1 in 2D. The normal points out of the body: in 2D it is to the right of the
  /// direction from the first node to the second, in 3D the nodes are in counter-clockwise order seen from outside.
  using Piece = std::array<Index, 3>;

  /// `positions`: d × nodes, of all bodies. They are the initial positions of the surface.
  BodySurface(const Points& positions, const std::vector<Piece>& pieces);

  /// Moves the nodes to positions + displacement (d per node, of all bodies).
  void move(const Points& positions, const Vector& displacement);

  /// Nodes of the surface, ascending, and their current positions.
  [[nodiscard]] const std::vector<Index>& nodes() const { return nodes_; }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& positions() const { return positions_; }
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return tree_.nodes().front().box; }
  /// Mean length of the edges in the initial positions.
  [[nodiscard]] double edge_length() const { return edge_length_; }

  /// Distance to the surface, negative inside. The sign is that of the angle-weighted normal at the closest point (J.
  /// A. Bærentzen, H. Aanæs, IEEE Trans. Vis. Comput. Graph. 11 (2005) 243–253), which is correct for every closed
  /// surface without self-intersections.
  [[nodiscard]] double signed_distance(const Eigen::Vector3d& point) const;

  /// Nodes of a piece, numbered on the surface.
  using Corners = std::array<int, 3>;
  struct Closest {
    double squared_distance;
    Eigen::Vector3d position;
    int piece = -1;
    Corners corners{-1, -1, -1};  ///< surface nodes between which the point lies
  };
  /// Point of the surface that is closest to a given one; piece −1: the numbers are too large to be squared.
  [[nodiscard]] Closest closest(const Eigen::Vector3d& point) const;
  /// As above, for the pieces that accept(piece, closest point of it) admits; piece −1 if there is none.
  template <class Accept>
  [[nodiscard]] Closest closest_of(const Eigen::Vector3d& point, const Accept& accept) const;

  [[nodiscard]] bool is_plane() const { return plane_; }
  [[nodiscard]] const std::vector<Corners>& pieces() const { return pieces_; }
  [[nodiscard]] const BoxTree& tree() const { return tree_; }
  [[nodiscard]] const Eigen::Vector3d& at(int node) const { return positions_[std::size_t(node)]; }
  /// Pieces around a node.
  [[nodiscard]] std::span<const int> around(int node) const {
    const int first = first_piece_[std::size_t(node)];
    return {around_.data() + first, std::size_t(first_piece_[std::size_t(node) + 1] - first)};
  }
  /// Unit normal out of the body; zero for a degenerate piece.
  [[nodiscard]] Eigen::Vector3d normal_of(int piece) const;
  /// Sum of the unit normals of the pieces around a node, weighted by their angles there; not a unit vector.
  [[nodiscard]] Eigen::Vector3d normal_at(int node) const;

 private:
  void compute_boxes();
  [[nodiscard]] Closest closest_on_piece(const Eigen::Vector3d& point, int piece) const;
  [[nodiscard]] Eigen::Vector3d normal_at(const Closest& nearest) const;

  bool plane_;
  std::vector<Index> nodes_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Corners> pieces_;
  std::vector<int> first_piece_;            ///< per node, index into around_; one more at the end
  std::vector<int> around_;                 ///< pieces around each node, node by node
  std::vector<Eigen::AlignedBox3d> boxes_;  ///< of the pieces
  BoxTree tree_;
  double edge_length_ = 0.0;
};

template <class Accept>
BodySurface::Closest BodySurface::closest_of(const Eigen::Vector3d& point, const Accept& accept) const {
  Closest best{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero(), -1, {-1, -1, -1}};
  const std::vector<BoxTree::Node>& nodes = tree_.nodes();
  std::array<int, BoxTree::max_depth> waiting{};
  std::size_t count = 1;
  while (count > 0) {
    const int number = waiting[--count];
    const BoxTree::Node& box = nodes[std::size_t(number)];
    if (box.box.squaredExteriorDistance(point) >= best.squared_distance) continue;
    for (int i = box.first; i < box.first + box.count; ++i) {
      const Closest found = closest_on_piece(point, tree_.order()[std::size_t(i)]);
      if (found.squared_distance < best.squared_distance && accept(found.piece, found.position)) best = found;
    }
    if (box.count > 0) continue;
    // The nearer child is pushed last and therefore visited first.
    const bool first_is_nearer = nodes[std::size_t(number) + 1].box.squaredExteriorDistance(point) <=
                                 nodes[std::size_t(box.second)].box.squaredExteriorDistance(point);
    waiting[count++] = first_is_nearer ? box.second : number + 1;
    waiting[count++] = first_is_nearer ? number + 1 : box.second;
  }
  return best;
}

}  // namespace ricochet
