#pragma once

#include <map>
#include <utility>
#include <vector>

#include "ricochet/contact/contact_boundary.hpp"

/// @file Nodes of the contacts with obstacles, and the checks that they must pass.
namespace ricochet {

/// Contains each node once per obstacle. Pairs of bodies are excluded.
class BoundaryNodes {
 public:
  /// Throws Error(invalid_input) if pairs that share a node and an obstacle differ in multipliers or, if a
  /// multiplier belongs to both, in friction; and if obstacles that share a node coincide in one plane there, with
  /// different friction or motion.
  BoundaryNodes(const Body& body, const std::vector<ContactPair>& pairs, const FreeComponent& is_free);

  /// Whether supports constrain the node along the obstacle's normal.
  [[nodiscard]] bool is_supported(Index node, const Obstacle* obstacle) const;
  [[nodiscard]] Index supported_count() const { return supported_count_; }
  /// Number of the first pair of this obstacle that contains the node; −1 if none does.
  [[nodiscard]] int first_pair(Index node, const Obstacle* obstacle) const;

 private:
  struct Entry {
    int first_pair = 0;
    bool supported = false;
  };
  using Key = std::pair<Index, const Obstacle*>;

  void check_coincidence(const Body& body, const std::vector<ContactPair>& pairs) const;

  std::map<Key, Entry> nodes_;
  Index supported_count_ = 0;
};

}  // namespace ricochet
