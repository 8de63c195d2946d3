#pragma once

#include "ricochet/contact/contact_boundary.hpp"

/// @file Some points and nodes of a contact boundary, as a boundary of their own.
namespace ricochet {

struct ContactCut {
  std::vector<Index> points;       ///< of the whole boundary, ascending
  std::vector<Index> entries;      ///< of ContactBoundary::nodes, ascending
  std::vector<Index> place_of;     ///< per node of the whole space: its number here, or −1
  std::vector<Index> facet_place;  ///< per facet of the whole mesh: its number here, or −1
  Index nodes = 0;                 ///< of the space here
};

/// The rows of the points reach nodes that are here. Nodes of the boundary know the pressure of the points that are
/// here; from parts that have all points, each once, it adds up. Throws Error(invalid_input) where the contact is one
/// between bodies.
[[nodiscard]] ContactBoundary cut_contact(const ContactBoundary& whole, const ContactCut& part);

/// The same of a trace, points × nodes.
[[nodiscard]] SparseRowMatrix cut_trace(const SparseRowMatrix& whole, const ContactCut& part);

}  // namespace ricochet
