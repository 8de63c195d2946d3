#pragma once

#include "ricochet/contact/contact_boundary.hpp"

/// @file Restriction of a contact boundary to some points and nodes, as a boundary of its own.
namespace ricochet {

struct ContactCut {
  std::vector<Index> points;        ///< of the whole boundary, ascending
  std::vector<Index> entries;       ///< of ContactBoundary::nodes, ascending
  std::vector<Index> node_number;   ///< per node of the whole space: its number in the part, or −1
  std::vector<Index> facet_number;  ///< per facet of the whole mesh: its number in the part, or −1
  Index nodes = 0;                  ///< number of nodes in the space of the part
};

/// Restricts a boundary. The rows of the points must involve nodes of the part only. The pressure recovery of nodes is
/// restricted to the points of the part; it sums to the whole over parts that contain each point once. Throws
/// Error(invalid_input) for contact between bodies and with free rigid bodies.
[[nodiscard]] ContactBoundary cut_contact(const ContactBoundary& whole, const ContactCut& part);

}  // namespace ricochet
