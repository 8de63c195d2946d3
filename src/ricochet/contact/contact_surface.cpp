#include "ricochet/contact/contact_surface.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "ricochet/fem/cell_integration.hpp"
#include "ricochet/fem/exterior_facets.hpp"
#include "ricochet/mesh/reference_cell.hpp"

namespace ricochet {

namespace {

constexpr char node_open = 0, node_pressed = 1, node_unknown = 2;
/// Upper bound on the corners of the part of a facet in contact: all border nodes of degree 2, and as many crossings.
constexpr std::size_t most_corners = 16;

/// Plate modulus E/(1 − ν²) of a cell; in plane stress E.
double plate_modulus(const Body& body, Index cell) {
  const Material& material = material_of(body, cell);
  const double poisson = is_plane_stress(body) ? 0.0 : material.poisson();
  return material.young() / (1.0 - poisson * poisson);
}

std::vector<double> plate_moduli(const Body& body, const std::vector<Index>& facets) {
  std::vector<double> result;
  for (const std::vector<Index>& cells : cells_of_facets(*body.mesh, facets))
    result.push_back(plate_modulus(body, cells.front()));
  return result;
}

}  // namespace

double pressed_part_of_edge(double ratio) {
  // u = 1 − θ:  u³ + q u − q = 0,  q = 9/(16 ρ²): one real root, by Cardano's formula.
  const double q = 9.0 / (16.0 * ratio * ratio);
  if (!(q > 0.0)) return 1.0;  // an infinite ratio
  if (!std::isfinite(q)) return 0.0;
  const double u = 2.0 * std::sqrt(q / 3.0) * std::sinh(std::asinh(1.5 * std::sqrt(3.0 / q)) / 3.0);
  return std::clamp(1.0 - u, 0.0, 1.0);
}

/// Gathers the facets of all pairs.
class ContactSurface::Builder {
 public:
  Builder(const Body& body, const std::vector<ContactPair>& pairs, const ContactBoundary& boundary,
          ContactSurface& surface)
      : body_(body), pairs_(pairs), boundary_(boundary), surface_(surface) {
    for (const CellBlock& block : body.mesh->facets)
      surface.shapes_.push_back(
          make_facet_shape(block.shape, body.mesh->degree, body.space->degree, surface.axisymmetric_));
    for (std::size_t pair = 0; pair < pairs.size(); ++pair) surface_.patch_of_pair_.push_back(patch_of(pair));
    std::vector<std::vector<Facet>> facets(pairs.size());
    for (int patch = 0; patch < patches_; ++patch) {
      surface_.first_slot_of_patch_.push_back(surface_.slots_.size());
      slot_of_.clear();
      for (std::size_t pair = 0; pair < pairs.size(); ++pair) {
        if (surface_.patch_of_pair_[pair] == patch && !pairs[pair].tied) add_facets(pair, facets[pair]);
      }
      surface_.entries_of_patch_.push_back(entries_of(patch));
      add_points(patch);
    }
    surface_.first_slot_of_patch_.push_back(surface_.slots_.size());
    finish(facets);
  }

 private:
  /// Pairs with the same obstacle share their contact points.
  int patch_of(std::size_t pair) {
    for (std::size_t before = 0; before < pair; ++before) {
      if (pairs_[pair].obstacle != nullptr && pairs_[before].obstacle == pairs_[pair].obstacle)
        return surface_.patch_of_pair_[before];
    }
    return patches_++;
  }

  std::size_t slot_of(Index node) {
    const auto [entry, added] = slot_of_.try_emplace(node, surface_.slots_.size());
    if (added) surface_.slots_.push_back({node, 0.0});
    return entry->second;
  }

  [[nodiscard]] std::vector<Entry> entries_of(int patch) const {
    std::vector<Entry> result;
    for (std::size_t entry = 0; entry < boundary_.nodes.size(); ++entry) {
      const auto pair = std::size_t(boundary_.node_pair[entry]);
      const Index node = boundary_.nodes[entry];
      if (boundary_.is_opposite[entry] != 0 || surface_.patch_of_pair_[pair] != patch) continue;
      if (!result.empty() && result.back().node == node) continue;  // from another pair
      const auto slot = slot_of_.find(node);
      result.push_back({Index(entry), node, slot != slot_of_.end() ? Index(slot->second) : Index{-1}});
    }
    return result;
  }

  void add_facets(std::size_t pair, std::vector<Facet>& result) {
    const ContactPair& contact = pairs_[pair];
    const std::vector<double> own = plate_moduli(body_, contact.facets);
    double compliance = 0.0;
    for (const double modulus : plate_moduli(body_, contact.opposite_facets))
      compliance += 1.0 / (modulus * double(contact.opposite_facets.size()));
    for (std::size_t i = 0; i < contact.facets.size(); ++i) {
      const IndexInBlocks location = locate_facet(*body_.space, contact.facets[i]);
      const CellBlock& geometry = body_.mesh->facets[location.block];
      const CellBlock& block = body_.space->facets[location.block];
      Facet facet{location.block, surface_.slots_of_facets_.size(), geometry_nodes_.size(), 0.0,
                  1.0 / (1.0 / own[i] + compliance)};
      for (int k = 0; k < block.nodes_per_cell; ++k)
        surface_.slots_of_facets_.push_back(slot_of(block.cell(location.local)[k]));
      for (int k = 0; k < geometry.nodes_per_cell; ++k) geometry_nodes_.push_back(geometry.cell(location.local)[k]);
      result.push_back(facet);
    }
  }

  void add_points(int patch) {
    for (Index point = 0; point < boundary_.size(); ++point) {
      if (surface_.patch_of_pair_[std::size_t(boundary_.pair[std::size_t(point)])] != patch) continue;
      boundary_.visit_own_nodes(point, [&](Index node, double weight) {
        const auto slot = slot_of_.find(node);
        if (slot != slot_of_.end()) of_points_.emplace_back(int(point), int(slot->second), weight);
      });
    }
  }

  void finish(const std::vector<std::vector<Facet>>& facets) {
    surface_.positions_.resize(surface_.dimension_, Index(geometry_nodes_.size()));
    for (std::size_t k = 0; k < geometry_nodes_.size(); ++k)
      surface_.positions_.col(Index(k)) = body_.mesh->nodes.col(geometry_nodes_[k]);
    surface_.node_positions_.resize(surface_.dimension_, Index(surface_.slots_.size()));
    for (std::size_t k = 0; k < surface_.slots_.size(); ++k)
      surface_.node_positions_.col(Index(k)) = body_.space->nodes.col(surface_.slots_[k].node);
    for (const std::vector<Facet>& of_pair : facets) {
      surface_.first_facet_.push_back(surface_.facets_.size());
      for (Facet facet : of_pair) {
        facet.area = surface_.measure(facet, nullptr).whole();
        const Index count = surface_.shapes_[facet.shape].displacement.node_count();
        for (std::size_t k = 0; k < std::size_t(count); ++k)
          surface_.slots_[surface_.slots_of_facets_[facet.first_slot + k]].area += facet.area / double(count);
        surface_.facets_.push_back(facet);
      }
    }
    surface_.first_facet_.push_back(surface_.facets_.size());
    surface_.slots_of_points_.resize(boundary_.size(), Index(surface_.slots_.size()));
    surface_.slots_of_points_.setFromTriplets(of_points_.begin(), of_points_.end());
  }

  const Body& body_;
  const std::vector<ContactPair>& pairs_;
  const ContactBoundary& boundary_;
  ContactSurface& surface_;
  int patches_ = 0;
  std::map<Index, std::size_t> slot_of_;  ///< of the current patch
  std::vector<Index> geometry_nodes_;     ///< nodes of the mesh
  std::vector<Eigen::Triplet<double>> of_points_;
};

ContactSurface::ContactSurface(const Body& body, const std::vector<ContactPair>& pairs, const ContactBoundary& boundary)
    : dimension_(body.space->dimension),
      deforms_(has_finite_strain(body)),
      axisymmetric_(is_axisymmetric(body)),
      nodes_(body.space->node_count()) {
  Builder(body, pairs, boundary, *this);
}

FacetArea ContactSurface::measure(const Facet& facet, const Vector* displacement) const {
  using Places = FacetArea::Places;
  const FacetShape& shape = shapes_[facet.shape];
  Places positions = Places::Zero(), motions = Places::Zero();
  for (Index k = 0; k < shape.geometry.node_count(); ++k)
    positions.col(k).head(dimension_) = positions_.col(Index(facet.first_position) + k);
  for (Index k = 0; displacement != nullptr && k < shape.displacement.node_count(); ++k) {
    const std::size_t slot = slots_of_facets_[facet.first_slot + std::size_t(k)];
    motions.col(k).head(dimension_) = displacement->segment(slots_[slot].node * dimension_, dimension_);
  }
  return {shape, positions, motions, axisymmetric_};
}

void ContactSurface::find_stretch(const Vector& displacement, Vector& area_of_slots, Vector& stretch) const {
  area_of_slots.setZero(Index(slots_.size()));
  for (const Facet& facet : facets_) {
    const auto count = std::size_t(shapes_[facet.shape].displacement.node_count());
    const double share = measure(facet, &displacement).whole() / double(count);
    for (std::size_t k = 0; k < count; ++k) area_of_slots[Index(slots_of_facets_[facet.first_slot + k])] += share;
  }
  stretch.setOnes(slots_of_points_.rows());
  for (Index point = 0; point < stretch.size(); ++point) {
    double now = 0.0, before = 0.0;
    for (SparseRowMatrix::InnerIterator entry(slots_of_points_, point); entry; ++entry) {
      now += std::abs(entry.value()) * area_of_slots[entry.col()];
      before += std::abs(entry.value()) * slots_[std::size_t(entry.col())].area;
    }
    if (before > 0.0) stretch[point] = now / before;
  }
}

/// Determines the states of the nodes of a pair's patch. Each rank contributes its own points.
void ContactSurface::find_states(int pair, const ContactView& view, Work& work) const {
  const ContactBoundary& boundary = view.boundary;
  const auto patch = std::size_t(patch_of_pair_[std::size_t(pair)]);
  const std::size_t first = first_slot_of_patch_[patch], last = first_slot_of_patch_[patch + 1];
  constexpr Index numbers = 5;  // pressure, number of open points, number of points, sum of the gaps, number of gaps
  // Ranks sum their numbers per node.
  const bool several = view.ranks.are_several();
  const auto offset = [&](std::size_t slot) { return numbers * (several ? slots_[slot].node : Index(slot - first)); };
  work.exchanged.setZero(numbers * (several ? nodes_ : Index(last - first)));
  for (const auto& [entry, node, slot] : entries_of_patch_[patch]) {
    if (slot < 0 && !several) continue;
    double* const sums = work.exchanged.data() + (several ? numbers * node : offset(std::size_t(slot)));
    sums[0] = view.nominal_pressure[entry];
    sums[3] = view.gap[entry];
    sums[4] = 1.0;
    // A point without a force may be closed nonetheless, e.g. a vertex with nodal forces of degree 2, where only
    // mid-side nodes carry forces, or a facet whose neighbours carry more: its gap decides.
    const auto add = [&, gap = view.gap[entry]](Index point) {
      const bool closed = view.normal_reaction[point] > 0.0 || gap <= view.rows.gap_rounding[point];
      sums[1] += closed ? 0.0 : 1.0;
      sums[2] += 1.0;
    };
    const Index own = boundary.own_point[std::size_t(entry)];
    if (own >= 0) add(own);
    if (own != -1) continue;
    boundary.visit_recovery(entry, [&](Index point, double weight) {
      if (weight != 0.0) add(point);
    });
  }
  if (several) view.ranks.accumulate(work.exchanged);
  work.state.resize(slots_.size());
  work.pressure.resize(Index(slots_.size()));
  work.gap.resize(Index(slots_.size()));
  for (std::size_t slot = first; slot < last; ++slot) {
    const double* const sums = work.exchanged.data() + offset(slot);
    const auto at = Index(slot);
    work.pressure[at] = sums[0];
    work.gap[at] = sums[3] / sums[4];  // NaN if no rank has it
    work.state[slot] = sums[2] == 0.0 ? node_unknown : sums[0] > 0.0 && sums[1] == 0.0 ? node_pressed : node_open;
  }
}

/// Returns the fraction in contact of the edge from a node in contact to an open one; both are numbers of slots.
double ContactSurface::covered(const Facet& facet, std::size_t from, std::size_t to, const Work& work) const {
  const auto inner = Index(from), outer = Index(to);
  const double gap = work.gap[outer];
  if (std::isnan(gap) || work.state[to] == node_unknown) return 0.0;
  if (!(gap > 0.0)) return 1.0;
  const double edge = (node_positions_.col(inner) - node_positions_.col(outer)).norm();
  return pressed_part_of_edge(work.pressure[inner] * edge / (facet.modulus * gap));
}

double ContactSurface::part_of_segment(const Facet& facet, const Work& work, const FacetArea& integral) const {
  const Points& at = shapes_[facet.shape].border_points;
  double sum = 0.0;
  for (std::size_t k = 0; k + 1 < shapes_[facet.shape].border.size(); ++k) {
    const std::size_t here = border_slot(facet, k), next = border_slot(facet, k + 1);
    const double from = at(0, Index(k)), to = at(0, Index(k) + 1);
    const bool presses = work.state[here] == node_pressed, next_presses = work.state[next] == node_pressed;
    if (presses && next_presses) {
      sum += integral.segment(from, to);
    } else if (presses) {
      sum += integral.segment(from, from + covered(facet, here, next, work) * (to - from));
    } else if (next_presses) {
      sum += integral.segment(to - covered(facet, next, here, work) * (to - from), to);
    }
  }
  return sum;
}

double ContactSurface::part_of_polygon(const Facet& facet, const Work& work, const FacetArea& integral) const {
  const FacetShape& shape = shapes_[facet.shape];
  const std::size_t count = shape.border.size();
  std::array<Eigen::Vector2d, most_corners> corners;
  std::size_t found = 0;
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t here = border_slot(facet, k), next = border_slot(facet, (k + 1) % count);
    const Eigen::Vector2d at = shape.border_points.col(Index(k));
    const Eigen::Vector2d way = shape.border_points.col(Index((k + 1) % count)) - at;
    const bool presses = work.state[here] == node_pressed;
    if (presses) corners[found++] = at;
    if (presses == (work.state[next] == node_pressed)) continue;
    corners[found++] = at + (presses ? covered(facet, here, next, work) : 1.0 - covered(facet, next, here, work)) * way;
  }
  double sum = 0.0;
  for (std::size_t k = 1; k + 1 < found; ++k) sum += integral.triangle(corners[0], corners[k], corners[k + 1]);
  return sum;
}

/// Nodes without a contact point, being supported, count as in contact if all others of the facet are.
void ContactSurface::add_part(const Facet& facet, const ContactView& view, const Work& work, Area& sum) const {
  bool any = false, all = true;
  for (std::size_t k = 0; k < shapes_[facet.shape].border.size(); ++k) {
    const char state = work.state[border_slot(facet, k)];
    any = any || state == node_pressed;
    all = all && state != node_open;
  }
  if (!any) return;
  const auto part_now = [&](const Vector* displacement) {
    const FacetArea integral = measure(facet, displacement);
    if (all) return integral.whole();
    return shapes_[facet.shape].is_segment ? part_of_segment(facet, work, integral)
                                           : part_of_polygon(facet, work, integral);
  };
  const double nominal = all ? facet.area : part_now(nullptr);
  sum.nominal += nominal;
  sum.now += deforms_ ? part_now(&view.displacement) : nominal;
}

ContactSurface::Area ContactSurface::pressed_area(int pair, const ContactView& view, Work& work) const {
  find_states(pair, view, work);
  Area sum;
  for (std::size_t k = first_facet_[std::size_t(pair)]; k < first_facet_[std::size_t(pair) + 1]; ++k)
    add_part(facets_[k], view, work, sum);
  return sum;
}

}  // namespace ricochet
