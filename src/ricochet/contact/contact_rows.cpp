#include "ricochet/contact/contact_rows.hpp"

namespace ricochet {

SpaceVector ContactRows::along_tangents(Index point, const Vector& components) const {
  const Index count = normals.rows() - 1;
  return tangents[std::size_t(point)] * components.segment(point * count, count);
}

SpaceVector ContactRows::force(Index point, const Vector& normal, const Vector& tangential) const {
  SpaceVector force = normal[point] * normals.col(point);
  const Index count = normals.rows() - 1;
  if (tangential.size() > 0) force.noalias() -= tangents[std::size_t(point)] * tangential.segment(point * count, count);
  return force;
}

void ContactRows::add_force(const Vector& normal, const Vector& tangential, Vector& force) const {
  // Row by row: few points carry a force, and this avoids allocations.
  for (Index i = 0; i < normal.size(); ++i) {
    if (normal[i] != 0.0) visit_normal(i, [&](Index dof, double value) { force[dof] += value * normal[i]; });
  }
  for (Index i = 0; i < tangential.size(); ++i) {
    if (tangential[i] != 0.0)
      visit_tangential(i, [&](Index dof, double value) { force[dof] -= value * tangential[i]; });
  }
}

void project_motion(const ContactRows& rows, ObstacleMotion& motion) {
  if (motion.in_space.size() == 0) return;
  const Index tangents = rows.dimension() - 1;
  for (Index i = 0; i < rows.size(); ++i) {
    motion.normal[i] = rows.normals.col(i).dot(motion.in_space.col(i));
    for (Index k = 0; k < tangents; ++k) {
      const Index row = i * tangents + k;
      const bool slips = rows.slips[std::size_t(row)] != 0;
      motion.tangential[row] = slips ? rows.tangents[std::size_t(i)].col(k).dot(motion.in_space.col(i)) : 0.0;
    }
  }
}

void motion_from_obstacles(const ContactRows& rows, const Vector& values, const ObstacleMotion& motion,
                           Vector& gap_change) {
  rows.normal_motion(values, gap_change);
  if (motion.normal.size() > 0) gap_change -= motion.normal;
}

void slip_on_obstacles(const ContactRows& rows, const Vector& values, const ObstacleMotion& motion, Vector& slip) {
  rows.tangential_motion(values, slip);
  if (motion.tangential.size() > 0) slip -= motion.tangential;
}

}  // namespace ricochet
