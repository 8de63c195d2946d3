#include "ricochet/simulation/monitor/penetration_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/simulation/monitor/penetration_phrases.hpp"

namespace ricochet {

namespace words = penetration_phrases;

namespace {

/// Edge lengths that nodes may move between two checks for self-penetration: parts that pass into each other and out
/// again undetected get hardly deeper than that.
constexpr double max_ignored_motion = 1.0;

std::vector<const Obstacle*> obstacles_of(const std::vector<NamedObstacle>& named) {
  std::vector<const Obstacle*> result;
  for (const NamedObstacle& one : named) result.push_back(one.obstacle);
  return result;
}

/// Size per node, of the body to which it belongs.
std::vector<double> sizes_at_nodes(const std::vector<double>& size_of_body, const ConnectedBodies& bodies) {
  std::vector<double> result;
  for (const int body : bodies.of_node) result.push_back(body < 0 ? 0.0 : size_of_body[std::size_t(body)]);
  return result;
}

/// Nodes of a boundary, ascending and without repetition.
std::vector<Index> nodes_of(const std::vector<CellFacet>& boundary, const std::vector<CellBlock>& cells) {
  std::vector<Index> nodes;
  for (const CellFacet& facet : boundary) {
    for (const Index node : nodes_of_facet(cells, facet)) nodes.push_back(node);
  }
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

}  // namespace

const UnwatchedPenetration* PenetrationReport::deepest() const {
  const auto largest =
      std::ranges::max_element(found, [](const auto& a, const auto& b) { return a.relative_depth < b.relative_depth; });
  return largest == found.end() ? nullptr : &*largest;
}

PenetrationWatch::PenetrationWatch(const Body& body, const SemidiscreteProblem& problem,
                                   const std::vector<ContactPair>& pairs, const std::vector<NamedObstacle>& obstacles)
    : PenetrationWatch(body, problem, pairs, obstacles, describe_bodies(body),
                       std::numeric_limits<double>::infinity()) {}

PenetrationWatch::PenetrationWatch(const Body& body, const SemidiscreteProblem& problem,
                                   const std::vector<ContactPair>& pairs, const std::vector<NamedObstacle>& obstacles,
                                   BodiesOfMesh bodies, double step_work)
    : body_(body),
      pairs_(pairs),
      named_(obstacles),
      bodies_(std::move(bodies)),
      size_(sizes_at_nodes(bodies_.sizes, bodies_.connected)),
      obstacles_(problem, body.space->cells, bodies_.boundary, obstacles_of(obstacles), size_),
      passages_(problem, nodes_of(bodies_.boundary, body.space->cells), obstacles_of(obstacles)),
      body_watch_(problem.nodes, body.space->cells, bodies_.boundary, bodies_.connected, size_,
                  contact_node_allowances(body, problem.contact, pairs, bodies_.connected.of_node)),
      self_watch_(body, problem, pairs, bodies_, step_work),
      problem_(problem),
      obstacle_warned_(obstacles.size(), 0),
      tunnelling_warned_(obstacles.size(), 0),
      self_penetration_warned_(self_watch_.bodies().size(), 0),
      self_contact_warned_(self_watch_.bodies().size(), 0) {
  for (const Group& group : body.mesh->groups) {
    if (group.dimension == body.mesh->dimension - 1)
      boundary_groups_.push_back({group.name, facet_nodes(*body.space, group.members)});
  }
}

void PenetrationWatch::check(const State& state) {
  if (checks_ == 0) obstacles_.check_start(state);
  ++checks_;
  obstacles_.check(state);
  passages_.check(state);
  check_bodies(state, false);
  warn();
}

void PenetrationWatch::check_bodies(const State& state, bool now) {
  // std::function stores two references without an allocation, but no more.
  const BodyWatch::NodeGaps gaps = [this, &state]() -> const Vector& {
    problem_.node_gaps(state.displacement, state.time, node_gap_);
    return node_gap_;
  };
  body_watch_.check(state.displacement, state.time, now, gaps);
  self_watch_.check(state.displacement, state.time, now, gaps);
}

void PenetrationWatch::check_end(const State& state) {
  check_bodies(state, true);
  warn();
}

void PenetrationWatch::warn() {
  for (std::size_t k = 0; k < named_.size(); ++k) {
    if (obstacle_warned_[k] != 0 || !obstacles_.deepest()[k].found()) continue;
    obstacle_warned_[k] = 1;
    const UnwatchedPenetration p = in_obstacle(k);
    log::warning(fmt::format("{} {} is {} inside obstacle \"{}\" at {}, where no contact prevents it: {}; {}",
                             words::when(p.time), p.bodies.front(), words::depth_text(p), p.obstacle,
                             words::coordinates(p.position), advice(k), words::see_summary));
  }
  for (std::size_t k = 0; k < named_.size(); ++k) {
    if (tunnelling_warned_[k] != 0 || !passages_.passages()[k].found()) continue;
    tunnelling_warned_[k] = 1;
    const UnwatchedPenetration p = through_obstacle(k);
    log::warning(
        fmt::format("{} a node of {} at {} has gone through obstacle \"{}\" within one step, which no contact can "
                    "detect; use a time.step in which bodies move by less than the thickness of the obstacle",
                    words::when(p.time), p.bodies.front(), words::coordinates(p.position), p.obstacle));
  }
  for (; rims_warned_ < obstacles_.rims().size(); ++rims_warned_) {
    const ContactBeyondRim rim = beyond(obstacles_.rims()[rims_warned_]);
    log::warning(
        fmt::format("{} the contact of group \"{}\" with \"{}\" has reached the rim of the group, at {}: the boundary "
                    "beyond it penetrates the obstacle unhindered; add that boundary to the group{}",
                    words::when(rim.time), rim.group, rim.obstacle, words::coordinates(rim.position),
                    rim.groups.empty() ? "" : fmt::format(" ({})", join_names(rim.groups))));
  }
  warn_of_bodies();
  warn_of_self_penetration();
}

void PenetrationWatch::warn_of_bodies() {
  const std::vector<BodyPair>& pairs = body_watch_.pairs();
  pairs_warned_.resize(pairs.size(), 0);
  contacts_warned_.resize(pairs.size(), 0);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (pairs_warned_[i] == 0 && pairs[i].deepest.found()) {
      pairs_warned_[i] = 1;
      warn_of(pairs[i]);
    }
    if (contacts_warned_[i] == 0 && pairs[i].at_contact.found()) {
      contacts_warned_[i] = 1;
      warn_at_contact(pairs[i]);
    }
  }
}

void PenetrationWatch::warn_of(const BodyPair& pair) const {
  const UnwatchedPenetration p = of_pair(pair);
  const std::vector<const ContactPair*> contacts = contacts_between(pair.first, pair.second);
  std::string why = "no [[contact]] keeps these bodies apart, so they go through each other";
  if (!contacts.empty()) {
    std::vector<std::string> names;
    for (const ContactPair* contact : contacts)
      names.push_back(fmt::format("\"{}\" and \"{}\"", contact->first_group(), contact->second_group()));
    const bool follows = std::ranges::all_of(contacts, [](const auto* c) { return c->large_sliding; });
    why = fmt::format("the contact of {} does not reach that far{}", fmt::join(names, ", "),
                      follows ? "; extend the groups"
                              : ", or its groups did not face each other there; extend the groups, or pair them with "
                                "pair_at where they meet");
  }
  log::warning(fmt::format("{} {} and {} overlap by {} at {}: {}; {}", words::when(p.time), p.bodies[0], p.bodies[1],
                           words::depth_text(p), words::coordinates(p.position), why, words::see_summary));
}

/// With sliding = "large" pairs follow the motion, so that remedies for exceeded small sliding do not help.
void PenetrationWatch::warn_at_contact(const BodyPair& pair) const {
  const UnwatchedPenetration p = at_contact(pair);
  const ContactPair& contact = pairs_[std::size_t(pair.contact)];
  const std::string why =
      contact.large_sliding
          ? fmt::format(
                "gaps are means over facets of \"{}\", which carries the multipliers, and this overlap does not show "
                "in them: the force of this contact is unreliable from here on",
                contact.group)
          : "the facets that faced each other at the start no longer do so, since the bodies have slid along or past "
            "each other; set sliding = \"large\", pair them with pair_at where they meet, or limit their motion";
  log::warning(fmt::format(
      "{} {} and {} overlap by {} at {}, more than half a facet, although the contact of {} should keep that "
      "node out: {}; {}",
      words::when(p.time), p.bodies[0], p.bodies[1], words::depth_text(p), words::coordinates(p.position),
      pair_names(p.contact[0], p.contact[1]), why, words::see_summary));
}

std::vector<const ContactPair*> PenetrationWatch::contacts_between(int first, int second) const {
  std::vector<const ContactPair*> result;
  const auto contains_node_of = [&](const std::vector<Index>& facets, int body) {
    const std::vector<Index> nodes = facet_nodes(*body_.space, facets);
    return std::ranges::any_of(nodes, [&](Index node) { return bodies_.connected.of_node[std::size_t(node)] == body; });
  };
  for (const ContactPair& pair : pairs_) {
    if (!pair.has_two_sides()) continue;
    if ((contains_node_of(pair.facets, first) && contains_node_of(pair.opposite_facets, second)) ||
        (contains_node_of(pair.facets, second) && contains_node_of(pair.opposite_facets, first)))
      result.push_back(&pair);
  }
  return result;
}

std::string PenetrationWatch::advice(std::size_t obstacle) const {
  const Index node = obstacles_.deepest()[obstacle].node;
  if (!is_on_boundary(node))
    return "the body is inside the obstacle, not next to it: move one of them, or choose the other side";
  std::vector<std::string> groups;
  for (const ContactPair& pair : pairs_) {
    if (pair.obstacle != named_[obstacle].obstacle) continue;
    const std::vector<Index> nodes = facet_nodes(*body_.space, pair.facets);
    if (std::ranges::binary_search(nodes, node))
      return fmt::format("it belongs to the contact group \"{}\", but supports hold it", pair.group);
    groups.push_back(pair.group);
  }
  const std::vector<std::string> own = groups_of(node);
  const std::string location =
      own.empty() ? "no boundary group of the mesh contains it; \"boundary\" is built in and names the whole boundary"
                  : fmt::format("it belongs to the boundary group{} {}", own.size() == 1 ? "" : "s", join_names(own));
  if (groups.empty()) return fmt::format("no [[contact]] names this obstacle ({})", location);
  if (obstacles_.deepest()[obstacle].time == 0.0)
    return fmt::format("{}, or extend the [[contact]] group {}, which does not reach that far ({})", words::check_side,
                       join_names(groups), location);
  return fmt::format("the [[contact]] group {} does not reach that far; extend it ({})", join_names(groups), location);
}

bool PenetrationWatch::is_on_boundary(Index node) const {
  return std::ranges::any_of(bodies_.boundary, [&](const CellFacet& facet) {
    const std::vector<Index> nodes = nodes_of_facet(body_.space->cells, facet);
    return std::ranges::find(nodes, node) != nodes.end();
  });
}

std::vector<std::string> PenetrationWatch::groups_of(Index node) const {
  std::vector<std::string> names;
  for (const BoundaryGroup& group : boundary_groups_) {
    if (std::ranges::binary_search(group.nodes, node)) names.push_back(group.name);
  }
  return names;
}

std::vector<double> PenetrationWatch::coordinates_of(const Eigen::Vector3d& position) const {
  return {position.data(), position.data() + body_.mesh->dimension};
}

UnwatchedPenetration PenetrationWatch::describe(const DeepestPoint& deepest, const std::vector<int>& bodies) const {
  UnwatchedPenetration result;
  double size = size_[std::size_t(deepest.node)];
  for (const int body : bodies) {
    result.bodies.push_back(bodies_.names[std::size_t(body)]);
    size = std::min(size, bodies_.sizes[std::size_t(body)]);
  }
  result.depth = deepest.depth;
  result.relative_depth = deepest.depth / size;
  result.time = deepest.time;
  result.position = coordinates_of(deepest.position);
  result.first_time = deepest.first_time;
  result.groups = groups_of(deepest.node);
  return result;
}

UnwatchedPenetration PenetrationWatch::in_obstacle(std::size_t obstacle) const {
  const DeepestPoint& deepest = obstacles_.deepest()[obstacle];
  UnwatchedPenetration result = describe(deepest, {bodies_.connected.of_node[std::size_t(deepest.node)]});
  result.obstacle = named_[obstacle].name;
  return result;
}

UnwatchedPenetration PenetrationWatch::through_obstacle(std::size_t obstacle) const {
  const DeepestPoint& deepest = passages_.passages()[obstacle];
  UnwatchedPenetration result = describe(deepest, {bodies_.connected.of_node[std::size_t(deepest.node)]});
  result.obstacle = named_[obstacle].name;
  result.passed_through = true;
  return result;
}

UnwatchedPenetration PenetrationWatch::of_pair(const BodyPair& pair) const {
  return describe(pair.deepest, {pair.first, pair.second});
}

UnwatchedPenetration PenetrationWatch::at_contact(const BodyPair& pair) const {
  UnwatchedPenetration result = describe(pair.at_contact, {pair.first, pair.second});
  const ContactPair& contact = pairs_[std::size_t(pair.contact)];
  result.contact = {contact.first_group(), contact.second_group()};
  return result;
}

ContactBeyondRim PenetrationWatch::beyond(const RimContact& rim) const {
  const ContactPair& pair = pairs_[std::size_t(rim.pair)];
  std::vector<std::string> groups = groups_of(rim.node);
  std::erase(groups, pair.group);
  return {pair.group, pair.obstacle_name, rim.time, coordinates_of(rim.position), groups};
}

PenetrationReport PenetrationWatch::report() const {
  PenetrationReport result{checks_, body_watch_.checks()};
  for (std::size_t k = 0; k < named_.size(); ++k) {
    if (obstacles_.deepest()[k].found()) result.found.push_back(in_obstacle(k));
    if (passages_.passages()[k].found()) result.found.push_back(through_obstacle(k));
  }
  for (const BodyPair& pair : body_watch_.pairs()) {
    if (pair.deepest.found()) result.found.push_back(of_pair(pair));
    if (pair.at_contact.found()) result.found.push_back(at_contact(pair));
  }
  for (const SelfPenetration& body : self_watch_.bodies()) {
    if (body.deepest.found()) result.found.push_back(self_penetration(body));
    if (body.at_contact.found()) result.found.push_back(self_penetration_at_contact(body));
  }
  for (const RimContact& rim : obstacles_.rims()) result.rims.push_back(beyond(rim));
  result.self_penetration_checks = self_watch_.checks();
  const auto is_free = [](const NamedObstacle& one) { return one.obstacle->free_motion() != nullptr; };
  if (named_.size() > 1 && std::ranges::any_of(named_, is_free))
    result.not_watched.emplace_back("rigid bodies against each other and other obstacles");
  if (const double ignored = self_watch_.ignored_motion(); ignored > max_ignored_motion) {
    result.not_watched.push_back(
        fmt::format("{} between checks (there were {}, and nodes moved by up to {:.2g} edges in between)",
                    bodies_in_themselves, self_watch_.checks(), ignored));
  }
  if (!self_watch_.watches())
    result.not_watched.push_back(std::string(bodies_in_themselves) + " (they are divided among several processes)");
  return result;
}

void PenetrationWatch::persist(const SnapshotVisitor& visit) {
  obstacles_.persist(visit.part("obstacles"));
  passages_.persist(visit.part("passages"));
  body_watch_.persist(visit.part("bodies"));
  self_watch_.persist(visit.part("themselves"));
  visit("looks", checks_);
  if (!visit.loads()) return;
  // Everything that was found has been reported at once.
  for (std::size_t k = 0; k < obstacle_warned_.size(); ++k)
    obstacle_warned_[k] = obstacles_.deepest()[k].found() ? 1 : 0;
  for (std::size_t k = 0; k < tunnelling_warned_.size(); ++k)
    tunnelling_warned_[k] = passages_.passages()[k].found() ? 1 : 0;
  rims_warned_ = obstacles_.rims().size();
  pairs_warned_.clear();
  contacts_warned_.clear();
  for (const BodyPair& pair : body_watch_.pairs()) {
    if (pair.at_contact.found() && (pair.contact < 0 || pair.contact >= int(pairs_.size())))
      throw Error(ErrorKind::invalid_input, "the checkpoint's record of penetration is damaged");
    pairs_warned_.push_back(pair.deepest.found() ? 1 : 0);
    contacts_warned_.push_back(pair.at_contact.found() ? 1 : 0);
  }
  for (std::size_t i = 0; i < self_watch_.bodies().size(); ++i) {
    const SelfPenetration& body = self_watch_.bodies()[i];
    self_penetration_warned_[i] = body.deepest.found() ? 1 : 0;
    self_contact_warned_[i] = body.at_contact.found() ? 1 : 0;
  }
}

}  // namespace ricochet
