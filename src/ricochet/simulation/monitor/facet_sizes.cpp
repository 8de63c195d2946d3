#include "ricochet/simulation/monitor/facet_sizes.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "ricochet/fem/mesh_measures.hpp"

namespace ricochet {

namespace {

/// Fraction of a facet by which a displacement takes a node from its middle to its end.
constexpr double half = 0.5;

std::set<int> bodies_of(const Body& body, const std::vector<Index>& facets, const std::vector<int>& body_of_node) {
  std::set<int> result;
  for (const Index node : facet_nodes(*body.space, facets)) result.insert(body_of_node[std::size_t(node)]);
  return result;
}

}  // namespace

FacetSizes facet_sizes(const Body& body, const std::vector<Index>& facets) {
  const auto count = std::size_t(body.space->node_count());
  FacetSizes result{std::vector<double>(count, 0.0), std::vector<double>(count, 0.0)};
  for (const Index facet : facets) {
    const double size = facet_diameter(*body.mesh, facet);
    for (const Index node : facet_nodes(*body.space, {facet})) {
      double &smallest = result.smallest[std::size_t(node)], &largest = result.largest[std::size_t(node)];
      smallest = smallest > 0.0 ? std::min(smallest, size) : size;
      largest = std::max(largest, size);
    }
  }
  return result;
}

namespace {

/// Adds both sides of a pair with large sliding, as the facets that a node will face are not known beforehand.
void add_sliding_nodes(const Body& body, const ContactBoundary& contact, const ContactPair& pair, int number,
                       const std::vector<int>& body_of_node, std::vector<ContactNodeAllowance>& result) {
  const FacetSizes own = facet_sizes(body, pair.facets), opposite = facet_sizes(body, pair.opposite_facets);
  const double size = std::max(*std::ranges::max_element(own.largest), *std::ranges::max_element(opposite.largest));
  const std::set<int> own_bodies = bodies_of(body, pair.facets, body_of_node);
  const std::set<int> opposite_bodies = bodies_of(body, pair.opposite_facets, body_of_node);
  std::map<Index, Index> entries;
  for (std::size_t entry = 0; entry < contact.nodes.size(); ++entry) {
    if (contact.node_pair[entry] == number) entries[contact.nodes[entry]] = Index(entry);
  }
  const auto add = [&](const std::vector<Index>& facets, const std::set<int>& others) {
    for (const Index node : facet_nodes(*body.space, facets)) {
      const auto found = entries.find(node);
      for (const int other : others) {
        if (other != body_of_node[std::size_t(node)])
          result.push_back({node, other, number, found != entries.end() ? found->second : -1, half * size});
      }
    }
  };
  add(pair.facets, opposite_bodies);
  add(pair.opposite_facets, own_bodies);
}

}  // namespace

std::vector<ContactNodeAllowance> contact_node_allowances(const Body& body, const ContactBoundary& contact,
                                                          const std::vector<ContactPair>& pairs,
                                                          const std::vector<int>& body_of_node) {
  std::vector<ContactNodeAllowance> result;
  for (std::size_t number = 0; number < pairs.size(); ++number) {
    const ContactPair& pair = pairs[number];
    if (!pair.has_two_sides()) continue;
    if (pair.large_sliding) {
      add_sliding_nodes(body, contact, pair, int(number), body_of_node, result);
      continue;
    }
    const FacetSizes own = facet_sizes(body, pair.facets), opposite = facet_sizes(body, pair.opposite_facets);
    const std::set<int> own_bodies = bodies_of(body, pair.facets, body_of_node);
    const std::set<int> opposite_bodies = bodies_of(body, pair.opposite_facets, body_of_node);
    for (std::size_t entry = 0; entry < contact.nodes.size(); ++entry) {
      if (contact.node_pair[entry] != int(number)) continue;
      const auto node = std::size_t(contact.nodes[entry]);
      const bool is_opposite = contact.is_opposite[entry] != 0;
      double size = (is_opposite ? opposite : own).largest[node];
      // The conditions may be those of the facets that the node faces, which may be coarser.
      for (SparseRowMatrix::InnerIterator at(contact.opposite_projection, Index(entry)); at; ++at)
        size = std::max(size, (is_opposite ? own : opposite).largest[std::size_t(at.col())]);
      for (const int other : is_opposite ? own_bodies : opposite_bodies) {
        if (other != body_of_node[node])
          result.push_back({contact.nodes[entry], other, int(number), Index(entry), half * size});
      }
    }
  }
  return result;
}

Vector slip_limits(const Body& body, const ContactBoundary& contact, const std::vector<ContactPair>& pairs) {
  Vector result = Vector::Zero(contact.size());
  for (std::size_t number = 0; number < pairs.size(); ++number) {
    if (!pairs[number].has_two_sides() || pairs[number].large_sliding) continue;
    const FacetSizes own = facet_sizes(body, pairs[number].facets),
                     opposite = facet_sizes(body, pairs[number].opposite_facets);
    for (Index point = 0; point < contact.size(); ++point) {
      if (contact.pair[std::size_t(point)] != int(number)) continue;
      double smallest = std::numeric_limits<double>::infinity();
      contact.visit_nodes(point, [&](Index node, double) {
        for (const FacetSizes* sizes : {&own, &opposite}) {
          const double size = sizes->smallest[std::size_t(node)];
          if (size > 0.0) smallest = std::min(smallest, size);
        }
      });
      result[point] = half * smallest;
    }
  }
  return result;
}

}  // namespace ricochet
