#include "ricochet/contact/sliding/broad_phase.hpp"

#include <algorithm>
#include <map>

namespace ricochet {

BroadPhase::BroadPhase(const std::vector<std::unique_ptr<SlidingPair>>& pairs, const Points& nodes) : nodes_(nodes) {
  std::map<std::vector<Index>, int> numbers;
  const auto surface_of = [&](const SlidingPair& pair, const std::vector<Index>& facets) {
    const auto [entry, is_new] = numbers.try_emplace(facets, int(surfaces_.size()));
    if (is_new) surfaces_.push_back({facet_nodes(*pair.data().body.space, facets), {}, 0.0});
    return entry->second;
  };
  for (const auto& pair : pairs) {
    Pair& added = pairs_.emplace_back();
    if (!pair->data().is_one_of_many) continue;
    added = {surface_of(*pair, pair->data().facets), surface_of(*pair, pair->data().opposite_facets), pair->height()};
    ++count_;
  }
}

void BroadPhase::move(const Vector& displacement, const Vector* start) {
  for (Surface& surface : surfaces_) {
    surface.box.setEmpty();
    surface.way = 0.0;
    for (const Index node : surface.nodes) {
      const SlidingVector position = current_position(nodes_, node, displacement);
      surface.box.extend(position);
      if (start == nullptr) continue;
      const SlidingVector before = current_position(nodes_, node, *start);
      surface.box.extend(before);
      surface.way = std::max(surface.way, (position - before).norm());
    }
  }
}

bool BroadPhase::are_apart(std::size_t pair) const {
  const Pair& of = pairs_[pair];
  if (of.first < 0) return false;
  const Surface &first = surfaces_[std::size_t(of.first)], &second = surfaces_[std::size_t(of.second)];
  const double reach = reach_of_sliding(std::max(first.way, second.way), of.height);
  // False if a displacement is NaN: such pairs are evaluated, and the error is found there.
  return first.box.exteriorDistance(second.box) > reach;
}

}  // namespace ricochet
