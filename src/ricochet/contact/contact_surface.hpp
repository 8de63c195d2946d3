#pragma once

#include <memory>
#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/fem/facet_area.hpp"

/// @file Areas of the contact boundary, for reports: how much of it is pressed, and how much it has grown.
///
/// A facet counts with the part of it that is pressed. A node is pressed where its own contact point presses, or, as
/// under "p0", all points do that its pressure comes from. A facet of pressed nodes counts whole. Between a pressed
/// node, of pressure p, and an open one, of gap g, at a distance h, the contact ends at the part θ of the edge. Near
/// the border of contact of smooth bodies, at a distance s from it, p = ½E* c √s inside and g = ⅔ c s^{3/2} outside
/// (the limit of Hertz' solution, and of every one whose pressure fades there; K. L. Johnson, Contact Mechanics, 1985,
/// §4.2), 1/E* the sum of (1 − ν²)/E of both bodies. With s = θh and (1 − θ)h the unknown c drops out:
///   ¾ √θ / (1 − θ)^{3/2} = p h / (E* g).
/// The border is off by a part of one facet, so the error of the area falls at least with h.
///
/// With laws of finite strain areas are those of the deformed surface; r_i A_i/a_i, A_i and a_i the areas of the facets
/// around a point before and after, then gives true (Cauchy) pressures in place of nominal ones.
namespace ricochet {

/// The contact of an instant, as a sensor sees it.
struct ContactView {
  const ContactBoundary& boundary;
  const ContactRows& rows;
  const Vector& normal_reaction;   ///< per contact point
  const Vector& gap;               ///< per entry of boundary.nodes
  const Vector& nominal_pressure;  ///< likewise; of several ranks a part
  const Vector& displacement;      ///< d per node of the body
  const Ranks& ranks;
};

class ContactSurface {
 public:
  struct Area {
    double now = 0.0;      ///< of the deformed surface; at small strain `nominal`
    double nominal = 0.0;  ///< of the undeformed surface
  };
  /// What pressed_area works in. Of the slots only those of the pair's patch are set.
  struct Work {
    Vector exchanged;         ///< five sums per slot of the patch; of several ranks per node of the body
    Vector pressure, gap;     ///< per slot; a gap that no rank has is NaN
    std::vector<char> state;  ///< per slot: open, pressed or unknown
  };

  /// Keeps copies of all that it needs.
  ContactSurface(const Body& body, const std::vector<ContactPair>& pairs, const ContactBoundary& boundary);

  /// Returns whether laws are of finite strain, so that true and nominal pressures differ.
  [[nodiscard]] bool deforms() const { return deforms_; }
  /// a_i/A_i per contact point. Allocates nothing after the first time.
  void find_stretch(const Vector& displacement, Vector& area_of_slots, Vector& stretch) const;
  /// Area of the pressed part of a pair's facets, on the side that carries the multipliers; of several ranks that of
  /// the facets of this one. All ranks call it together. Allocates nothing after the first time.
  [[nodiscard]] Area pressed_area(int pair, const ContactView& view, Work& work) const;

 private:
  struct Facet {
    std::size_t shape;
    std::size_t first_slot, first_place;  ///< of its nodes in slots_, and of its geometry in places_
    double area, modulus;                 ///< E*
  };
  /// A node of a patch of facets whose pairs share their contact points.
  struct Slot {
    Index node;
    double area;  ///< share of the facets around it
  };
  /// A node of the boundary. Of several ranks one may know of its contact though the facets around it are others'.
  struct Entry {
    Index entry, node;
    Index slot;  ///< −1: in no facet of this rank
  };
  class Builder;

  /// `displacement` null: undeformed.
  [[nodiscard]] FacetArea measure(const Facet& facet, const Vector* displacement) const;
  void find_states(int pair, const ContactView& view, Work& work) const;
  [[nodiscard]] std::size_t border_slot(const Facet& facet, std::size_t k) const {
    return slots_of_facets_[facet.first_slot + static_cast<std::size_t>(shapes_[facet.shape].border[k])];
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
  Points places_, node_places_;  ///< of the geometry, and per slot
  Index nodes_;
  /// Points × slots: c.
  SparseRowMatrix slots_of_points_;
};

/// θ of the equation above for ρ = p h / (E* g); 1 for infinity.
[[nodiscard]] double pressed_part_of_edge(double ratio);

}  // namespace ricochet
