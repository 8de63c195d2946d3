#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/mesh/search/box_tree.hpp"

/// @file The closed surface of one body, wherever its nodes have moved to: how deep is a point inside?
namespace ricochet {

/// Segments (2D) or triangles (3D) between nodes, under a tree of boxes. Everything is computed with three coordinates;
/// in two dimensions the third is 0. Nothing is allocated after the construction.
class BodySurface {
 public:
  /// Nodes of one piece, the third −1 in 2D. The normal points out of the body: in 2D it is to the right of the way
  /// from the first node to the second, in 3D the nodes go round it counter-clockwise.
  using Piece = std::array<Index, 3>;

  /// `positions`: d × nodes, of all bodies. The surface starts there.
  BodySurface(const Points& positions, const std::vector<Piece>& pieces);

  /// Takes the nodes to positions + displacement (d per node, of all bodies).
  void move(const Points& positions, const Vector& displacement);

  /// The nodes of the surface, ascending, and where they are.
  [[nodiscard]] const std::vector<Index>& nodes() const { return nodes_; }
  [[nodiscard]] const std::vector<Eigen::Vector3d>& positions() const { return positions_; }
  [[nodiscard]] const Eigen::AlignedBox3d& box() const { return tree_.nodes().front().box; }
  /// Mean length of the edges where the surface starts.
  [[nodiscard]] double edge_length() const { return edge_length_; }

  /// Distance to the surface, negative inside. The sign is that of the angle-weighted normal at the closest point (J.
  /// A. Bærentzen, H. Aanæs, IEEE Trans. Vis. Comput. Graph. 11 (2005) 243–253), right for every closed surface that
  /// does not cross itself.
  [[nodiscard]] double signed_distance(const Eigen::Vector3d& point) const;

  /// Nodes of a piece by their numbers on the surface.
  using Corners = std::array<int, 3>;
  struct Closest {
    double squared_distance;
    Eigen::Vector3d position;
    int piece = -1;
    Corners corners{-1, -1, -1};  ///< surface nodes between which it lies
  };
  /// The point of the surface that is closest to another one; piece −1: numbers too large to be squared.
  [[nodiscard]] Closest closest(const Eigen::Vector3d& point) const;
  /// The same, of the pieces that accept(piece, closest point of it) lets through; piece −1: there is none.
  template <class Accept>
  [[nodiscard]] Closest closest_of(const Eigen::Vector3d& point, const Accept& accept) const;

  [[nodiscard]] bool is_plane() const { return plane_; }
  [[nodiscard]] const std::vector<Corners>& pieces() const { return pieces_; }
  [[nodiscard]] const BoxTree& tree() const { return tree_; }
  [[nodiscard]] const Eigen::Vector3d& at(int node) const { return positions_[static_cast<std::size_t>(node)]; }
  /// The pieces around a node.
  [[nodiscard]] std::span<const int> around(int node) const {
    const int first = first_piece_[static_cast<std::size_t>(node)];
    return {around_.data() + first, static_cast<std::size_t>(first_piece_[static_cast<std::size_t>(node) + 1] - first)};
  }
  /// Unit vector out of the body; zero for a piece without extent.
  [[nodiscard]] Eigen::Vector3d normal_of(int piece) const;
  /// The sum of those of the pieces around a node, weighted by their angles there; of no unit length.
  [[nodiscard]] Eigen::Vector3d normal_at(int node) const;

 private:
  void place_boxes();
  [[nodiscard]] Closest closest_on_piece(const Eigen::Vector3d& point, int piece) const;
  [[nodiscard]] Eigen::Vector3d normal_at(const Closest& place) const;

  bool plane_;
  std::vector<Index> nodes_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<Corners> pieces_;
  std::vector<int> first_piece_;            ///< of each node, in around_; one more at the end
  std::vector<int> around_;                 ///< the pieces around one node after another
  std::vector<Eigen::AlignedBox3d> boxes_;  ///< of the pieces
  BoxTree tree_;
  double edge_length_ = 0.0;
};

template <class Accept>
BodySurface::Closest BodySurface::closest_of(const Eigen::Vector3d& point, const Accept& accept) const {
  Closest best{std::numeric_limits<double>::infinity(), Eigen::Vector3d::Zero(), -1, {-1, -1, -1}};
  const std::vector<BoxTree::Node>& nodes = tree_.nodes();
  std::array<int, BoxTree::deepest> waiting{};
  std::size_t count = 1;
  while (count > 0) {
    const int number = waiting[--count];
    const BoxTree::Node& box = nodes[static_cast<std::size_t>(number)];
    if (box.box.squaredExteriorDistance(point) >= best.squared_distance) continue;
    for (int i = box.first; i < box.first + box.count; ++i) {
      const Closest found = closest_on_piece(point, tree_.order()[static_cast<std::size_t>(i)]);
      if (found.squared_distance < best.squared_distance && accept(found.piece, found.position)) best = found;
    }
    if (box.count > 0) continue;
    // The nearer one first: it comes from the end.
    const bool first_is_nearer = nodes[static_cast<std::size_t>(number) + 1].box.squaredExteriorDistance(point) <=
                                 nodes[static_cast<std::size_t>(box.second)].box.squaredExteriorDistance(point);
    waiting[count++] = first_is_nearer ? box.second : number + 1;
    waiting[count++] = first_is_nearer ? number + 1 : box.second;
  }
  return best;
}

}  // namespace ricochet
