#pragma once

#include <Eigen/Geometry>
#include <array>
#include <vector>

#include "ricochet/base/types.hpp"
#include "ricochet/contact/box_tree.hpp"

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

 private:
  struct Closest {
    double squared_distance;
    Eigen::Vector3d position;
    int piece = -1;
    std::array<int, 3> corners{-1, -1, -1};  ///< surface nodes between which it lies
  };

  void place_boxes();
  [[nodiscard]] Closest closest(const Eigen::Vector3d& point) const;
  void try_piece(const Eigen::Vector3d& point, int piece, Closest& best) const;
  [[nodiscard]] Eigen::Vector3d normal_of(int piece) const;
  [[nodiscard]] Eigen::Vector3d normal_at(const Closest& place) const;
  [[nodiscard]] const Eigen::Vector3d& at(int node) const { return positions_[static_cast<std::size_t>(node)]; }

  bool plane_;
  std::vector<Index> nodes_;
  std::vector<Eigen::Vector3d> positions_;
  std::vector<std::array<int, 3>> pieces_;  ///< by numbers of the surface's own nodes
  std::vector<int> first_piece_;            ///< of each node, in around_; one more at the end
  std::vector<int> around_;                 ///< the pieces around one node after another
  std::vector<Eigen::AlignedBox3d> boxes_;  ///< of the pieces
  BoxTree tree_;
  double edge_length_ = 0.0;
};

}  // namespace ricochet
