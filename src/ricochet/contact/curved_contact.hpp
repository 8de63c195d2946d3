#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ricochet/contact/contact_boundary.hpp"

/// @file Contact with curved obstacles, and with planes that rotate. A contact point is at x_i = Σ_j c_ij (X + U)_j,
/// its gap is that of the obstacle there, and its rows are c ⊗ n(x_i) and c ⊗ t(x_i): G is exactly the derivative of
/// the gap, unless the normals are those of a step.
namespace ricochet {

struct CurvedContactData {
  struct Point {
    Index number = 0;               ///< among all contact points
    std::size_t obstacle = 0;       ///< among `obstacles`
    std::array<bool, 3> is_free{};  ///< components without support
  };
  struct Node {
    Index entry = 0;  ///< in the contact boundary's nodes
    Index node = 0;
    std::size_t obstacle = 0;
  };
  std::vector<const Obstacle*> obstacles;  ///< unique
  std::vector<Point> points;
  std::vector<Node> nodes;
  Points node_positions;  ///< reference positions of all nodes
  Points node_normals;    ///< of the contact boundary's nodes, at the start
  SparseRowMatrix trace;  ///< c
};

[[nodiscard]] std::unique_ptr<ContactGeometry> make_curved_contact(CurvedContactData data);

}  // namespace ricochet
