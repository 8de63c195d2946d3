#pragma once

#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/fem/facet_area.hpp"

/// @file Areas of the contact boundary, for output: the area in contact, and the growth of the surface.
///
/// A facet contributes the part of it that is in contact. A node is in contact if its own contact point is, or, as
/// under "p0", if all points are from which its pressure is recovered. A facet of nodes in contact counts as a
/// whole. Between a node in contact, of pressure p, and an open one, of gap g, at a distance h, the contact ends at
/// the part θ of the edge. Near the border of contact of smooth bodies, at a distance s from it, p = ½E* c √s
/// inside and g = ⅔ c s^{3/2} outside (the limit of Hertz' solution, and of every one whose pressure vanishes
/// there; K. L. Johnson, Contact Mechanics, 1985, §4.2), 1/E* the sum of (1 − ν²)/E of both bodies. With s = θh and
/// (1 − θ)h the unknown c cancels:
///   ¾ √θ / (1 − θ)^{3/2} = p h / (E* g).
/// The border is inaccurate by a fraction of one facet, so that the error of the area decreases at least with h.
///
/// With laws of finite strain areas are those of the deformed surface; r_i A_i/a_i, A_i and a_i the areas of the facets
/// around a point before and after deformation, then yields true (Cauchy) instead of nominal pressures.
namespace ricochet {

/// Contact at an instant, as input for a sensor.
struct ContactView {
  const ContactBoundary& boundary;
  const ContactRows& rows;
  const Vector& normal_reaction;   ///< per contact point
  const Vector& gap;               ///< per entry of boundary.nodes
  const Vector& nominal_pressure;  ///< likewise; with several ranks the local contribution
  const Vector& displacement;      ///< d per node of the body
  const Ranks& ranks;
};

class ContactSurface {
 public:
  struct Area {
    double now = 0.0;      ///< of the deformed surface; at small strain equal to `nominal`
    double nominal = 0.0;  ///< of the undeformed surface
  };
  /// Work space of pressed_area(). Only the slots of the pair's patch are set.
  struct Work {
    Vector exchanged;         ///< five sums per slot of the patch; with several ranks per node of the body
    Vector pressure, gap;     ///< per slot; NaN for a gap that no rank has
    std::vector<char> state;  ///< per slot: open, in contact or unknown
  };

  /// Copies all data that it needs.
  ContactSurface(const Body& body, const std::vector<ContactPair>& pairs, const ContactBoundary& boundary);

  /// Whether laws are of finite strain, so that true and nominal pressures differ.
  [[nodiscard]] bool deforms() const { return deforms_; }
  /// Computes a_i/A_i per contact point. Does not allocate after the first call.
  void find_stretch(const Vector& displacement, Vector& area_of_slots, Vector& stretch) const;
  /// Area in contact of a pair's facets, on the side that carries the multipliers; with several ranks that of the local
  /// facets. Collective over the ranks. Does not allocate after the first call.
  [[nodiscard]] Area pressed_area(int pair, const ContactView& view, Work& work) const;

 private:
  struct Facet {
    std::size_t shape;
    std::size_t first_slot, first_position;  ///< of its nodes in slots_of_facets_, and of its geometry in positions_
    double area, modulus;                    ///< E*
  };
  /// Node of a patch of facets whose pairs share their contact points.
  struct Slot {
    Index node;
    double area;  ///< of the facets around it, the node's share
  };
  /// Node of the boundary. With several ranks, a rank may have its contact data but none of the facets around it.
  struct Entry {
    Index entry, node;
    Index slot;  ///< −1 if in no local facet
  };
  class Builder;

  /// Integrator of the area of a facet; undeformed if `displacement` is null.
  [[nodiscard]] FacetArea measure(const Facet& facet, const Vector* displacement) const;
  void find_states(int pair, const ContactView& view, Work& work) const;
  [[nodiscard]] std::size_t border_slot(const Facet& facet, std::size_t k) const {
    return slots_of_facets_[facet.first_slot + std::size_t(shapes_[facet.shape].border[k])];
  }
  [[nodiscard]] double covered(const Facet& facet, std::size_t from, std::size_t to, const Work& work) const;
  [[nodiscard]] double part_of_segment(const Facet& facet, const Work& work, const FacetArea& integral) const;
  [[nodiscard]] double part_of_polygon(const Facet& facet, const Work& work, const FacetArea& integral) const;
  void add_part(const Facet& facet, const ContactView& view, const Work& work, Area& sum) const;

  int dimension_;
  bool deforms_, axisymmetric_;
  std::vector<FacetShape> shapes_;
  std::vector<Facet> facets_;
  std::vector<std::size_t> first_facet_;  ///< per pair, and the end
  std::vector<int> patch_of_pair_;
  std::vector<std::size_t> first_slot_of_patch_;  ///< per patch, and the end
  std::vector<Slot> slots_;
  std::vector<std::vector<Entry>> entries_of_patch_;
  std::vector<std::size_t> slots_of_facets_;
  Points positions_, node_positions_;  ///< positions of the nodes of the geometry, and per slot
  Index nodes_;
  /// Points × slots: c.
  SparseRowMatrix slots_of_points_;
};

/// Solves the equation above for θ, with `ratio` ρ = p h / (E* g); 1 for infinity.
[[nodiscard]] double pressed_part_of_edge(double ratio);

}  // namespace ricochet
