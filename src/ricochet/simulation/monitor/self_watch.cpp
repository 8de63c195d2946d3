#include "ricochet/simulation/monitor/self_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/linear_algebra/orthogonal_factor.hpp"
#include "ricochet/mesh/flat_pieces.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/simulation/monitor/surface_pieces.hpp"

namespace ricochet {

namespace {

/// A check is due when a node has moved by this fraction of the mean edge relative to the mean translation of the body:
/// two nodes then have approached each other by at most twice of it.
constexpr double motion_before_check = 0.0125;
/// Fraction of it after an overlap has been reported, when only its depth is of interest.
constexpr double motion_once_found = 0.125;
/// Fraction of the mean edge up to which initial overlaps are attributed to facets that approximate curved surfaces.
constexpr double overlap_of_facets = 0.5;
/// Minimum of SelfOverlap::opening at the start: corners of cubes have 0.58.
constexpr double least_opening = 0.5;
/// Cost of checking one node, in entries of a factor that are read: 0.2 µs in the plane and up to 1 µs in space, 0.4 ns
/// for an entry (measured).
constexpr double work_per_node_in_plane = 500.0, work_per_node_in_space = 2500.0;
/// Largest number of checks that are saved for later, and the number available at the start.
constexpr double most_saved = 4.0;

std::vector<std::vector<CellFacet>> facets_of_bodies(const Body& body, const BodiesOfMesh& bodies) {
  std::vector<std::vector<CellFacet>> result(static_cast<std::size_t>(bodies.connected.count));
  for (const CellFacet& facet : bodies.boundary) {
    const std::vector<Index> nodes = nodes_of_facet(body.space->cells, facet);
    // A facet on the axis is not part of the surface.
    if (is_axisymmetric(body) && std::ranges::all_of(nodes, [&](Index node) { return is_on_axis(body, node); }))
      continue;
    result[std::size_t(bodies.connected.of_node[std::size_t(nodes[0])])].push_back(facet);
  }
  return result;
}

}  // namespace

SelfWatch::SelfWatch(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs,
                     const BodiesOfMesh& bodies, double step_work)
    : positions_(problem.nodes),
      axisymmetric_(problem.axisymmetric),
      work_per_step_(share * step_work),
      pair_count_(int(pairs.size())) {
  if (problem.ranks->are_several()) return;
  std::vector<PairNodes> pair_nodes;
  for (const ContactPair& pair : pairs) {
    PairNodes& nodes = pair_nodes.emplace_back();
    if (!pair.between_bodies()) continue;
    nodes = {pair.tied, facet_nodes(*body.space, pair.facets), facet_nodes(*body.space, pair.opposite_facets)};
    for (const auto* const facets : {&pair.facets, &pair.opposite_facets}) {
      const std::vector<double> sizes = facet_sizes(body, *facets).largest;
      nodes.allowance = std::max(nodes.allowance, 0.5 * *std::ranges::max_element(sizes));
    }
  }
  const std::vector<std::vector<CellFacet>> facets = facets_of_bodies(body, bodies);
  for (std::size_t number = 0; number < facets.size(); ++number) {
    watched_.push_back(watch_body(body, facets[number], bodies.sizes[number]));
    set_contacts(pair_nodes, problem.contact, watched_.back());
    found_.emplace_back().body = int(number);
    work_budget_ += most_saved * watched_.back().work;
  }
}

SelfWatch::WatchedBody SelfWatch::watch_body(const Body& body, const std::vector<CellFacet>& facets,
                                             double size) const {
  const std::vector<CellBlock>& cells = body.space->cells;
  WatchedBody watched(BodySurface(positions_, surface_pieces(positions_, cells, facets)));
  for (const CellFacet& facet : facets) {
    const CellShape shape = facet_shape(cells[facet.block].shape, facet.local);
    watched.facets.push_back({shape, nodes_of_facet(cells, facet)});
    const int degree = degree_of(shape, int(watched.facets.back().nodes.size()));
    watched.facet_of_piece.insert(watched.facet_of_piece.end(), flat_pieces(shape, degree).size(),
                                  watched.facets.size() - 1);
  }
  const std::size_t count = watched.surface.nodes().size();
  watched.contacts.resize(count);
  const SelfOverlap start(watched.surface, axisymmetric_);
  for (int node = 0; node < int(count); ++node)
    watched.is_left_out.push_back(start.opening(node) < least_opening ? 1 : 0);
  watched.at_start.setZero(Index(count));
  watched.last_displacement.setZero(Index(count) * positions_.rows());
  watched.size = size;
  watched.work = (positions_.rows() == 2 ? work_per_node_in_plane : work_per_node_in_space) * double(count);
  return watched;
}

/// Stores the contacts of the body with itself, and excludes nodes that are tied.
void SelfWatch::set_contacts(const std::vector<PairNodes>& pairs, const ContactBoundary& boundary,
                             WatchedBody& watched) {
  const std::vector<Index>& nodes = watched.surface.nodes();
  const auto number_of = [&](Index node) {
    const auto found = std::ranges::lower_bound(nodes, node);
    return found != nodes.end() && *found == node ? std::size_t(found - nodes.begin()) : nodes.size();
  };
  const auto is_here = [&](Index node) { return number_of(node) < nodes.size(); };
  const auto contact_of = [&](std::size_t at, int pair) {
    std::vector<NodeContact>& contacts = watched.contacts[at];
    const auto found = std::ranges::find_if(contacts, [&](const NodeContact& c) { return c.pair == pair; });
    return found == contacts.end() ? nullptr : &*found;
  };
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const PairNodes& pair = pairs[k];
    // In a contact with another body, this body may penetrate itself.
    const bool is_with_itself = std::ranges::any_of(pair.own, is_here) && std::ranges::any_of(pair.opposite, is_here);
    for (const bool opposite : {false, true}) {
      for (const Index node : opposite ? pair.opposite : pair.own) {
        const std::size_t at = number_of(node);
        if (at == nodes.size()) continue;
        if (pair.is_tied) watched.is_left_out[at] = 1;
        if (!is_with_itself) continue;
        NodeContact* contact = contact_of(at, int(k));
        if (contact == nullptr)
          contact = &watched.contacts[at].emplace_back(NodeContact{int(k), false, false, -1, pair.allowance});
        (opposite ? contact->opposite : contact->own) = true;
      }
    }
  }
  for (std::size_t entry = 0; entry < boundary.nodes.size(); ++entry) {
    const std::size_t at = number_of(boundary.nodes[entry]);
    if (at == nodes.size()) continue;
    if (NodeContact* const contact = contact_of(at, boundary.node_pair[entry])) contact->entry = Index(entry);
  }
}

void SelfWatch::check(const Vector& displacement, double time, bool now, const NodeGaps& gaps) {
  if (watched_.empty()) return;
  double all = 0.0;
  for (const WatchedBody& watched : watched_) all += watched.work;
  work_budget_ = std::min(work_budget_ + work_per_step_, most_saved * all);
  bool any = false;
  for (std::size_t number = 0; number < watched_.size(); ++number) {
    WatchedBody& watched = watched_[number];
    const SelfPenetration& found = found_[number];
    const bool is_found = found.deepest.found() || found.at_contact.found();
    const double limit = (is_found ? motion_once_found : motion_before_check) * watched.surface.edge_length();
    const bool due = checks_ == 0 || (work_budget_ >= watched.work && is_due(watched, limit, displacement));
    if (!due && !now) continue;
    if (checks_ > 0) enter_ignored(watched, displacement);
    check_body(number, displacement, time, gaps);
    if (!due) continue;
    any = true;
    if (checks_ > 0) work_budget_ -= watched.work;
    const Index d = positions_.rows();
    const std::vector<Index>& nodes = watched.surface.nodes();
    for (std::size_t i = 0; i < nodes.size(); ++i)
      watched.last_displacement.segment(Index(i) * d, d) = displacement.segment(nodes[i] * d, d);
  }
  if (any) ++checks_;
}

/// Subtracts the mean translation, which cannot bring two regions together. (It does not subtract a rotation: a body
/// that spins is due.)
bool SelfWatch::is_due(const WatchedBody& watched, double limit, const Vector& displacement) const {
  const Index d = positions_.rows();
  const std::vector<Index>& nodes = watched.surface.nodes();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  const auto moved = [&](std::size_t i, Index k) {
    return displacement[nodes[i] * d + k] - watched.last_displacement[Index(i) * d + k];
  };
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (Index k = 0; k < d; ++k) mean[k] += moved(i, k);
  }
  mean /= double(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    double squared = 0.0;
    for (Index k = 0; k < d; ++k) squared += (moved(i, k) - mean[k]) * (moved(i, k) - mean[k]);
    if (squared >= limit * limit) return true;
  }
  return false;
}

double SelfWatch::largest_deformation_since(const WatchedBody& watched, const Vector& displacement) const {
  using Vector3 = Eigen::Vector3d;
  const Index d = positions_.rows();
  const std::vector<Index>& nodes = watched.surface.nodes();
  const auto position = [&](std::size_t i, const Vector& of, Index first) {
    Vector3 result = Vector3::Zero();
    result.head(d) = positions_.col(nodes[i]) + of.segment(first, d);
    return result;
  };
  const auto before = [&](std::size_t i) { return position(i, watched.last_displacement, Index(i) * d); };
  const auto after = [&](std::size_t i) { return position(i, displacement, nodes[i] * d); };
  Vector3 first = Vector3::Zero(), last = Vector3::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    first += before(i) / double(nodes.size());
    last += after(i) / double(nodes.size());
  }
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < nodes.size(); ++i) moments += (after(i) - last) * (before(i) - first).transpose();
  if (d == 2) moments(2, 2) = moments.norm();  // so that the determinant is that of the plane, times this
  const Eigen::Matrix3d rotation = orthogonal_factor(moments);
  double longest = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    longest = std::max(longest, (after(i) - last - rotation * (before(i) - first)).norm());
  return longest;
}

/// Surfaces whose distance at the last check exceeds the motion of nodes towards each other have not met since.
void SelfWatch::enter_ignored(WatchedBody& watched, const Vector& displacement) const {
  const double motion = largest_deformation_since(watched, displacement);
  if (2.0 * motion > watched.clearance)
    watched.ignored = std::max(watched.ignored, motion / watched.surface.edge_length());
}

double SelfWatch::ignored_motion() const {
  double most = 0.0;
  for (const WatchedBody& watched : watched_) most = std::max(most, watched.ignored);
  return most;
}

void SelfWatch::check_body(std::size_t number, const Vector& displacement, double time, const NodeGaps& gaps) {
  WatchedBody& watched = watched_[number];
  SelfPenetration& recorded = found_[number];
  watched.surface.move(positions_, displacement);
  const SelfOverlap overlap(watched.surface, axisymmetric_);
  const bool at_start = checks_ == 0;
  watched.clearance = std::numeric_limits<double>::infinity();
  const Vector* gap = nullptr;
  const std::vector<Index>& nodes = watched.surface.nodes();
  for (int node = 0; node < int(nodes.size()); ++node) {
    const auto i = std::size_t(node);
    if (watched.is_left_out[i] != 0) continue;
    double clearance = 0.0;
    const auto found = overlap.at(node, &clearance);
    // Contacts of the body with itself keep their nodes out between two checks, too.
    if (watched.contacts[i].empty()) watched.clearance = std::min(watched.clearance, clearance);
    if (!found) continue;
    const Eigen::Vector3d& position = watched.surface.at(node);
    const auto piece = std::size_t(found->other_piece);
    double allowed = rounding_of_depth * watched.size + 2.0 * watched.at_start[node] +
                     16.0 * std::numeric_limits<double>::epsilon() * position.lpNorm<Eigen::Infinity>() +
                     sagitta_of(watched.facets[watched.facet_of_piece[piece]], displacement) +
                     sagitta_of(watched.facets[watched.facet_of_piece[std::size_t(found->own_piece)]], displacement);
    if (at_start && found->depth <= overlap_of_facets * watched.surface.edge_length()) {
      watched.at_start[node] = found->depth;
      continue;
    }
    const NodeContact* const contact = contact_at(watched, node, found->other_piece);
    if (contact != nullptr) {
      if (gap == nullptr) gap = &gaps();
      const double here = contact->entry >= 0 ? (*gap)[contact->entry] : 0.0;
      allowed += contact->allowance + (here < 0.0 ? -here : 0.0);
    }
    if (found->depth <= allowed) continue;
    if (contact != nullptr) {
      if (found->depth > recorded.at_contact.depth) recorded.contact = contact->pair;
      recorded.at_contact.enter(nodes[i], found->depth, time, position);
    } else if (found->depth > recorded.deepest.depth) {
      recorded.deepest.enter(nodes[i], found->depth, time, position);
      recorded.own = nodes_of(watched, found->own_piece);
      recorded.through = nodes_of(watched, found->other_piece);
    }
  }
}

const SelfWatch::NodeContact* SelfWatch::contact_at(const WatchedBody& watched, int node, int piece) {
  for (const NodeContact& contact : watched.contacts[std::size_t(node)]) {
    const auto faces = [&](int corner) {
      if (corner < 0) return true;
      const std::vector<NodeContact>& there = watched.contacts[std::size_t(corner)];
      return std::ranges::any_of(there, [&](const NodeContact& other) {
        return other.pair == contact.pair && ((contact.own && other.opposite) || (contact.opposite && other.own));
      });
    };
    const BodySurface::Corners& corners = watched.surface.pieces()[std::size_t(piece)];
    if (std::ranges::all_of(corners, faces)) return &contact;
  }
  return nullptr;
}

/// For facets of second order a quarter of the distance of the nodes from those of the straight facet, since pieces
/// connect the nodes; for quadrilaterals of first order the distance of the nodes from a plane.
double SelfWatch::sagitta_of(const Facet& facet, const Vector& displacement) const {
  const Index d = positions_.rows();
  const auto at = [&](int k) {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    const Index node = facet.nodes[std::size_t(k)];
    result.head(d) = positions_.col(node) + displacement.segment(node * d, d);
    return result;
  };
  const auto vertices = std::size_t(vertex_count(facet.shape));
  if (facet.nodes.size() == vertices)
    return is_simplex(facet.shape) ? 0.0 : 0.25 * (at(0) - at(1) - at(2) + at(3)).norm();
  const std::vector<std::vector<int>>& vertices_of = node_vertices(facet.shape, 2);
  double most = 0.0;
  for (std::size_t k = vertices; k < facet.nodes.size(); ++k) {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    for (const int v : vertices_of[k]) mean += at(v) / double(vertices_of[k].size());
    most = std::max(most, (at(int(k)) - mean).norm());
  }
  return 0.25 * most;
}

std::array<Index, 3> SelfWatch::nodes_of(const WatchedBody& watched, int piece) const {
  std::array<Index, 3> result{-1, -1, -1};
  const BodySurface::Corners& corners = watched.surface.pieces()[std::size_t(piece)];
  for (std::size_t k = 0; k < 3; ++k) {
    if (corners[k] >= 0) result[k] = watched.surface.nodes()[std::size_t(corners[k])];
  }
  return result;
}

/// Returns whether these are nodes and contacts of this problem.
bool SelfWatch::fits(const SelfPenetration& found) const {
  const auto is_node = [this](Index node) { return node >= -1 && node < positions_.cols(); };
  return is_node(found.deepest.node) && is_node(found.at_contact.node) &&
         found.contact >= (found.at_contact.found() ? 0 : -1) && found.contact < pair_count_ &&
         std::ranges::all_of(found.own, is_node) && std::ranges::all_of(found.through, is_node);
}

void SelfWatch::persist(const SnapshotVisitor& visit) {
  const bool is_finite = visit.numbers("found", found_).allFinite();
  const auto fits_here = [this](const SelfPenetration& found) { return fits(found); };
  visit.require(is_finite && std::ranges::all_of(found_, fits_here), "found",
                "has numbers that do not denote nodes and contacts of this problem");
  for (std::size_t k = 0; k < found_.size(); ++k) {
    WatchedBody& watched = watched_[k];
    const SnapshotVisitor each = visit.part(k);
    each("at_start", watched.at_start, watched.at_start.size());
    each.require(watched.at_start.allFinite() && (watched.at_start.array() >= 0.0).all(), "at_start",
                 "has entries that are not depths");
    each("seen", watched.last_displacement, watched.last_displacement.size());
    each.require(watched.last_displacement.allFinite(), "seen", "is not finite");
    each.numbers("unseen", watched.ignored, watched.clearance);
    each.require(watched.ignored >= 0.0 && watched.clearance >= 0.0, "unseen", "has negative entries");
  }
  visit("saved", work_budget_);
  visit.require(work_budget_ >= 0.0 && std::isfinite(work_budget_), "saved", "is not a valid amount of work");
  // Infinite if all checks that are due are performed.
  visit("work", work_per_step_);
  visit.require(work_per_step_ >= 0.0, "work", "is not a valid amount of work");
  visit("looks", checks_);
  visit.require(checks_ >= 0, "looks", "is negative");
}

}  // namespace ricochet
