#include "ricochet/contact/construction/boundary_nodes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>

#include "ricochet/base/error.hpp"
#include "ricochet/contact/contact_directions.hpp"
#include "ricochet/contact/multipliers/multiplier_space.hpp"

namespace ricochet {

namespace {

/// Checks that multipliers that share a node agree in their properties.
void check_agreement(const ContactPair& first, const ContactPair& second, bool supported) {
  if (first.multipliers != second.multipliers) {
    throw Error(
        ErrorKind::invalid_input,
        fmt::format("contact groups \"{}\" and \"{}\" share a node against obstacle \"{}\" with different multipliers "
                    "(\"{}\" and \"{}\"); separate them by at least one facet or use the same for both",
                    first.group, second.group, first.obstacle_name, first.multipliers, second.multipliers));
  }
  if (supported || first.friction == second.friction) return;
  if (anchor_of(first.multipliers) == MultiplierAnchor::facet) return;  // each facet has its own
  throw Error(ErrorKind::invalid_input,
              fmt::format("contact groups \"{}\" and \"{}\" share a node against obstacle \"{}\" with different "
                          "friction coefficients or bounds; separate them by at least one facet, use the same for "
                          "both, or use multipliers \"p0\", whose friction is per facet",
                          first.group, second.group, first.obstacle_name));
}

/// Whether it makes no difference which of the two obstacles carries a node.
bool carry_alike(const ContactPair& one, const ContactPair& other) {
  if (!one.friction.any() && !other.friction.any()) return true;
  return one.friction == other.friction && !one.obstacle->moves() && !other.obstacle->moves();
}

/// Whether the surfaces coincide here, to rounding, in position and direction.
bool coincide(const Obstacle& one, const Obstacle& other, const Vector& at) {
  constexpr double same_direction = 1e-8;
  if ((one.normal(at) - other.normal(at)).norm() > same_direction) return false;
  return std::abs(one.gap(at) - other.gap(at)) <= one.gap_rounding(at) + other.gap_rounding(at);
}

}  // namespace

BoundaryNodes::BoundaryNodes(const Body& body, const std::vector<ContactPair>& pairs, const FreeComponent& is_free) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (pairs[k].between_bodies()) continue;
    for (const Index node : facet_nodes(*body.space, pairs[k].facets)) {
      const auto [entry, added] = nodes_.try_emplace({node, pairs[k].obstacle});
      if (added) {
        // If the normal rotates with the motion, only a node with all components constrained is constrained along it.
        const int d = body.space->dimension;
        const Vector normal = pairs[k].obstacle->has_constant_normals()
                                  ? Vector(pairs[k].obstacle->normal(body.space->nodes.col(node)))
                                  : Vector(Vector::Constant(d, 1.0 / std::sqrt(d)));
        entry->second = {int(k), !has_free_part(node, normal, is_free)};
        supported_count_ += entry->second.supported ? 1 : 0;
      }
      check_agreement(pairs[std::size_t(entry->second.first_pair)], pairs[k], entry->second.supported);
    }
  }
  check_coincidence(body, pairs);
}

bool BoundaryNodes::is_supported(Index node, const Obstacle* obstacle) const {
  return nodes_.at({node, obstacle}).supported;
}

int BoundaryNodes::first_pair(Index node, const Obstacle* obstacle) const {
  const auto entry = nodes_.find({node, obstacle});
  return entry != nodes_.end() ? entry->second.first_pair : -1;
}

/// Conditions at a node may be linearly dependent: the step still has a unique motion. But if two surfaces coincide, it
/// must not matter which of them carries the node: the distribution of the force between them is not determined.
void BoundaryNodes::check_coincidence(const Body& body, const std::vector<ContactPair>& pairs) const {
  for (auto one = nodes_.begin(); one != nodes_.end(); ++one) {
    for (auto other = std::next(one); other != nodes_.end() && other->first.first == one->first.first; ++other) {
      if (one->second.supported || other->second.supported) continue;
      const ContactPair& first = pairs[std::size_t(one->second.first_pair)];
      const ContactPair& second = pairs[std::size_t(other->second.first_pair)];
      const Vector at = body.space->nodes.col(one->first.first);
      if (carry_alike(first, second) || !coincide(*first.obstacle, *second.obstacle, at)) continue;
      std::string coordinates;
      for (const double coordinate : at)
        coordinates += fmt::format("{}{}", coordinates.empty() ? "" : ", ", coordinate);
      throw Error(ErrorKind::invalid_input,
                  fmt::format("obstacles \"{}\" and \"{}\" are the same surface at the node at ({}), with different "
                              "friction or motion: which of them carries the node is undetermined; remove one of these "
                              "contacts or move one of the obstacles",
                              std::min(first.obstacle_name, second.obstacle_name),
                              std::max(first.obstacle_name, second.obstacle_name), coordinates));
    }
  }
}

}  // namespace ricochet
