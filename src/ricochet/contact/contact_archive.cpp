#include "ricochet/contact/contact_archive.hpp"

namespace ricochet {

void transfer(Archive& archive, ContactRows& rows) {
  archive.all(rows.normals, rows.tangents, rows.slips, rows.gap_rounding, rows.gap_operator, rows.tangential_trace,
              rows.gap, rows.revision, rows.sliding_state);
  bool rotates = rows.rotating_trace != nullptr;
  archive(rotates);
  if (!rotates) return;
  SparseRowMatrix trace = archive.reads() ? SparseRowMatrix() : *rows.rotating_trace;
  archive(trace);
  if (archive.reads()) rows.rotating_trace = std::make_shared<const SparseRowMatrix>(std::move(trace));
}
void transfer(Archive& archive, ContactBoundary& contact) {
  archive.all(contact.dimension, contact.facets, contact.pair, contact.initial_gap, contact.weights,
              contact.friction_coefficient, contact.friction_bound, contact.trace, contact.own_trace, contact.net,
              contact.large_sliding, contact.reachable_nodes, contact.touches_itself, contact.has_friction_elsewhere,
              contact.unpaired_gap, contact.opposite_node, contact.nodes, contact.node_pair, contact.is_opposite,
              contact.own_point, contact.node_normals, contact.node_initial_gap, contact.opposite_projection,
              contact.pressure_recovery);
}
void transfer(Archive& archive, CurvedContactData::Point& point) {
  archive.all(point.number, point.obstacle, point.is_free);
}
void transfer(Archive& archive, CurvedContactData::Node& node) {
  archive.all(node.entry, node.node, node.obstacle);
}

}  // namespace ricochet
