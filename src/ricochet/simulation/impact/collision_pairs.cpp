#include <algorithm>
#include <map>
#include <utility>

#include "ricochet/simulation/impact/impacts.hpp"

/// @file Collision pairs: bodies, and the obstacles or other bodies to which their contact points belong.
namespace ricochet {

/// Order in which two bodies are named: first that of the `group` of their first contact.
class ImpactRecorder::BodyOrder {
 public:
  void enter(int first, int second, int contact) {
    const auto [entry, is_new] = first_of_.try_emplace(std::minmax(first, second), contact, first);
    if (!is_new && contact < entry->second.first) entry->second = {contact, first};
  }
  [[nodiscard]] bool is_first(int body, int other) const {
    return first_of_.at(std::minmax(body, other)).second == body;
  }

 private:
  std::map<std::pair<int, int>, std::pair<int, int>> first_of_;  ///< bodies → contact, the first body
};

void ImpactRecorder::find_collision_pairs(const std::vector<ContactPair>& pairs) {
  const ContactBoundary& contact = problem_.contact;
  // Per point between bodies: the fraction of its force that acts on each of the bodies that it faces.
  std::vector<std::map<int, double>> opposite(static_cast<std::size_t>(contact.size()));
  const auto own_body = [&](Index point) { return rigid_.body_of_node(contact.first_own_node(point)); };
  const auto pair_of = [&](Index point) { return contact.pair[std::size_t(point)]; };
  BodyOrder order;
  for (Index point = 0; point < contact.size(); ++point) {
    if (!contact.between_bodies(point)) continue;
    const int own = own_body(point);
    contact.visit_nodes(point, [&](Index node, double weight) {
      const int body = rigid_.body_of_node(node);
      if (body != own) opposite[std::size_t(point)][body] -= weight;
    });
    // All surfaces that a point with large sliding can face belong to one body (model_bodies.cpp).
    if (contact.slides(point)) {
      const int body = rigid_.body_of_node(contact.opposite_node[std::size_t(pair_of(point))]);
      opposite[std::size_t(point)].clear();
      if (body != own) opposite[std::size_t(point)][body] = 1.0;
    }
    for (const auto& [body, part] : opposite[std::size_t(point)]) {
      const bool exchanged = pairs[std::size_t(pair_of(point))].exchanged;
      order.enter(exchanged ? body : own, exchanged ? own : body, pair_of(point));
    }
  }
  add_collision_pairs_of_ranks(pairs);
  for (Index point = 0; point < contact.size(); ++point) {
    const int own = own_body(point);
    if (!contact.between_bodies(point)) {
      const int free = free_body_of(point);
      add_part(point, own, free, free < 0 ? pairs[std::size_t(pair_of(point))].obstacle_name : "", 1.0);
    }
    for (const auto& [body, part] : opposite[std::size_t(point)]) {
      if (order.is_first(own, body)) {
        add_part(point, own, body, "", part);
      } else {
        add_part(point, body, own, "", -part);
      }
    }
  }
}

/// Gives all ranks the collision pairs of all, in one order: by body, then by contact pair with an obstacle.
void ImpactRecorder::add_collision_pairs_of_ranks(const std::vector<ContactPair>& pairs) {
  if (!problem_.ranks->are_several()) return;
  const ContactBoundary& contact = problem_.contact;
  for (int body = 0; body < int(rigid_.bodies().size()); ++body) {
    for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
      double points = 0.0;
      for (Index point = 0; point < contact.size(); ++point) {
        const bool is_of_pair = contact.pair[std::size_t(point)] == int(pair);
        points += is_of_pair && rigid_.body_of_node(contact.first_own_node(point)) == body ? 1.0 : 0.0;
      }
      const long count = std::lround(problem_.ranks->sum(points));
      if (count == 0) continue;
      const std::string& obstacle = pairs[pair].obstacle_name;
      const auto found = std::ranges::find_if(collision_pairs_, [&](const CollisionPair& collision) {
        return collision.body == body && collision.obstacle == obstacle;
      });
      if (found == collision_pairs_.end()) {
        collision_pairs_.push_back({body, -1, obstacle, count, false});
      } else {
        found->points += count;
      }
    }
  }
}

/// Returns the number of the free rigid body at this point; −1 if none.
int ImpactRecorder::free_body_of(Index point) const {
  const Obstacle* const obstacle = problem_.obstacle_of_point(point);
  if (obstacle == nullptr || obstacle->free_motion() == nullptr) return -1;
  const std::size_t before = rigid_.bodies().size() - problem_.free_bodies.size();
  for (std::size_t k = 0; k < problem_.free_bodies.size(); ++k) {
    if (problem_.free_bodies[k].get() == obstacle->free_motion()) return int(before + k);
  }
  return -1;
}

void ImpactRecorder::add_part(Index point, int body, int other, const std::string& obstacle, double part) {
  const auto found = std::ranges::find_if(collision_pairs_, [&](const CollisionPair& collision) {
    return collision.body == body && collision.other == other && collision.obstacle == obstacle;
  });
  parts_.push_back({point, std::size_t(found - collision_pairs_.begin()), part});
  if (found == collision_pairs_.end()) {
    collision_pairs_.push_back({body, other, obstacle, 1, false});
  } else if (!problem_.ranks->are_several()) {
    ++found->points;
  }
}

void ImpactRecorder::begin_inside(const std::vector<Index>& points) {
  for (const PointPart& each : parts_) {
    if (std::ranges::find(points, each.point) != points.end()) collision_pairs_[each.collision].begins_inside = true;
  }
  for (CollisionPair& collision : collision_pairs_)
    collision.begins_inside = problem_.ranks->any(collision.begins_inside);
}

}  // namespace ricochet
