#pragma once

#include <map>
#include <utility>
#include <vector>

#include "ricochet/contact/contact_boundary.hpp"

/// @file The nodes of the contacts with obstacles and the conditions they must meet.
namespace ricochet {

/// Each node once per obstacle. Pairs of bodies have no part in it.
class BoundaryNodes {
 public:
  /// Throws Error(invalid_input) when pairs that share a node and an obstacle differ in multipliers or, where a
  /// multiplier stands for both, in friction; and when obstacles that share a node are one plane there, with different
  /// friction or motion.
  BoundaryNodes(const Body& body, const std::vector<ContactPair>& pairs, const FreeComponent& is_free);

  /// Whether supports hold the node along the obstacle's normal.
  [[nodiscard]] bool is_held(Index node, const Obstacle* obstacle) const;
  [[nodiscard]] Index held_count() const { return held_count_; }
  /// The first pair of this obstacle that names the node; −1: none does.
  [[nodiscard]] int first_pair(Index node, const Obstacle* obstacle) const;

 private:
  struct Entry {
    int first_pair = 0;
    bool held = false;
  };
  using Key = std::pair<Index, const Obstacle*>;

  void check_coincidence(const Body& body, const std::vector<ContactPair>& pairs) const;

  std::map<Key, Entry> nodes_;
  Index held_count_ = 0;
};

}  // namespace ricochet
