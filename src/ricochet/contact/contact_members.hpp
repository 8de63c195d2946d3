#pragma once

#include <concepts>

#include "ricochet/contact/curved_contact.hpp"

/// @file The members of a contact boundary, listed once for visitors that send them (base/archive.hpp), cut them
/// (contact_cut.hpp) and gather them (solver/gathered/point_messages.hpp). A new member needs a place here; tests count
/// them.
namespace ricochet {

/// Either a value or a constant one: a visitor may read the members or change them.
template <class Value, class Type>
concept PossiblyConst = std::same_as<std::remove_const_t<Value>, Type>;

/// Tangents: d−1 per point; entries: the contact nodes of ContactBoundary::nodes.
enum class ContactAxis { none, point, tangent, entry, node, dof, facet };

/// Meaning of a member's indices and values, by which it is divided.
struct ContactAxes {
  using IsMemberRule = void;  ///< for Archive, which does not need it
  /// Items whose data the member contains, one number, matrix, column of a dense matrix or row of a sparse matrix each.
  /// The member may also be empty.
  ContactAxis along = ContactAxis::none;
  /// Items to which the values of a member refer: its integers are their numbers, and the columns of a sparse matrix
  /// are theirs.
  ContactAxis of = ContactAxis::none;
};

template <class Visitor, PossiblyConst<ContactRows> Rows>
void persist(Visitor& visit, Rows& rows) {
  using enum ContactAxis;
  visit(ContactAxes{point}, rows.normals, rows.tangents, rows.gap_rounding, rows.gap, rows.revision);
  visit(ContactAxes{tangent}, rows.slips);
  visit(ContactAxes{point, dof}, rows.gap_operator);
  visit(ContactAxes{tangent, dof}, rows.tangential_trace);
  visit(ContactAxes{}, rows.sliding_state);
}

/// Visits all members except `geometry` and `surface`. Those that only contact between bodies has, which cannot be
/// divided, have no axes.
template <class Visitor, PossiblyConst<ContactBoundary> Boundary>
void persist(Visitor& visit, Boundary& contact) {
  using enum ContactAxis;
  visit(ContactAxes{}, contact.dimension, contact.reachable_nodes, contact.touches_itself,
        contact.has_friction_elsewhere, contact.unpaired_gap, contact.opposite_node, contact.opposite_projection,
        contact.rows);
  visit(ContactAxes{none, facet}, contact.facets);
  visit(ContactAxes{point}, contact.pair, contact.initial_gap, contact.weights, contact.friction_coefficient,
        contact.friction_bound, contact.rows_follow, contact.net, contact.large_sliding);
  visit(ContactAxes{point, node}, contact.trace, contact.own_trace);
  visit(ContactAxes{entry}, contact.node_pair, contact.is_opposite, contact.node_normals, contact.node_initial_gap);
  visit(ContactAxes{entry, node}, contact.nodes);
  visit(ContactAxes{entry, point}, contact.own_point, contact.pressure_recovery);
}

template <class Visitor>
void persist(Visitor& visit, CurvedContactData::Point& point) {
  visit.all(point.number, point.obstacle, point.is_free);
}
template <class Visitor>
void persist(Visitor& visit, CurvedContactData::Node& node) {
  visit.all(node.entry, node.node, node.obstacle);
}
/// Visits all members except the obstacles.
template <class Visitor>
void persist(Visitor& visit, CurvedContactData& data) {
  using enum ContactAxis;
  visit(ContactAxes{}, data.points, data.nodes);
  visit(ContactAxes{node}, data.node_positions);
  visit(ContactAxes{entry}, data.node_normals);
  visit(ContactAxes{point, node}, data.trace);
}

}  // namespace ricochet
