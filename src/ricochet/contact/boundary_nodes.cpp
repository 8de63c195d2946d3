#include "ricochet/contact/boundary_nodes.hpp"

#include <fmt/format.h>
#include <Eigen/QR>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/contact/contact_directions.hpp"
#include "ricochet/contact/multiplier_space.hpp"

namespace ricochet {

namespace {

/// Multipliers that share a node must agree on what holds there.
void check_agreement(const ContactPair& first, const ContactPair& second, bool held) {
  if (first.multipliers != second.multipliers) {
    throw Error(ErrorKind::invalid_input,
                fmt::format("contact groups \"{}\" and \"{}\" share a node against obstacle \"{}\" with different "
                            "multipliers (\"{}\" and \"{}\"); separate them by at least one facet or give them the "
                            "same",
                            first.group, second.group, first.obstacle_name, first.multipliers, second.multipliers));
  }
  if (held || first.friction == second.friction) return;
  if (anchor_of(first.multipliers) == MultiplierAnchor::facet) return;  // each facet has its own
  throw Error(ErrorKind::invalid_input,
              fmt::format("contact groups \"{}\" and \"{}\" share a node against obstacle \"{}\" with different "
                          "friction coefficients or bounds; separate them by at least one facet, give them the same, "
                          "or use multipliers \"p0\", whose friction is per facet",
                          first.group, second.group, first.obstacle_name));
}

}  // namespace

BoundaryNodes::BoundaryNodes(const Body& body, const std::vector<ContactPair>& pairs, const FreeComponent& is_free) {
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    for (const Index node : facet_nodes(*body.space, pairs[k].facets)) {
      const auto [entry, added] = nodes_.try_emplace({node, pairs[k].obstacle});
      if (added) {
        const Vector normal = pairs[k].obstacle->normal(body.space->nodes.col(node));
        entry->second = {static_cast<int>(k), !has_free_part(node, normal, is_free)};
        held_count_ += entry->second.held ? 1 : 0;
      }
      check_agreement(pairs[static_cast<std::size_t>(entry->second.first_pair)], pairs[k], entry->second.held);
    }
  }
  check_independence(body, pairs);
}

bool BoundaryNodes::is_held(Index node, const Obstacle* obstacle) const {
  return nodes_.at({node, obstacle}).held;
}

int BoundaryNodes::first_pair(Index node, const Obstacle* obstacle) const {
  return nodes_.at({node, obstacle}).first_pair;
}

/// The conditions at one node must be independent, or their forces are not determined.
void BoundaryNodes::check_independence(const Body& body, const std::vector<ContactPair>& pairs) const {
  for (auto entry = nodes_.begin(); entry != nodes_.end();) {
    const Index node = entry->first.first;
    const Vector at = body.space->nodes.col(node);
    std::vector<int> meeting;
    for (; entry != nodes_.end() && entry->first.first == node; ++entry) {
      if (!entry->second.held) meeting.push_back(entry->second.first_pair);
    }
    if (meeting.size() < 2) continue;
    std::sort(meeting.begin(), meeting.end());
    Matrix normals(at.size(), static_cast<Index>(meeting.size()));
    std::string names;
    for (std::size_t k = 0; k < meeting.size(); ++k) {
      const ContactPair& pair = pairs[static_cast<std::size_t>(meeting[k])];
      normals.col(static_cast<Index>(k)) = pair.obstacle->normal(at);
      names += fmt::format("{}\"{}\"", k == 0 ? "" : ", ", pair.obstacle_name);
    }
    Eigen::ColPivHouseholderQR<Matrix> qr(normals);
    qr.setThreshold(1e-8);
    if (qr.rank() == normals.cols()) continue;
    throw Error(ErrorKind::invalid_input,
                fmt::format("the node at ({}{}{}) is in contact with obstacles {} whose normals are linearly "
                            "dependent there; remove one of these contacts",
                            at[0], ", ",
                            at.size() == 3 ? fmt::format("{}, {}", at[1], at[2]) : fmt::format("{}", at[1]), names));
  }
}

}  // namespace ricochet
