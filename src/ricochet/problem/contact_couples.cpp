#include "ricochet/problem/contact_couples.hpp"

#include "ricochet/problem/body_rotations.hpp"

namespace ricochet {

ContactCouples::ContactCouples(const SemidiscreteProblem& problem) : problem_(problem) {
  is_held_.assign(std::size_t(problem.nodes.cols()), 0);
  // Bodies that touch each other are not divided among ranks.
  if (problem.ranks->are_several() || !problem.contact.follows_motion() || problem.supports.size() == 0) return;
  const BodyRotations bodies(problem);
  for (std::size_t node = 0; node < is_held_.size(); ++node) {
    const int body = bodies.body_of_node(Index(node));
    if (body >= 0 && bodies.is_held(body)) is_held_[node] = 1;
  }
}

bool ContactCouples::is_held(const ContactRows& rows, Index point) const {
  bool result = false;
  rows.visit_normal(point, [&](Index dof, double value) {
    result = result || (value != 0.0 && is_held_[std::size_t(dof / problem_.dimension)] != 0);
  });
  return result;
}

void ContactCouples::add(const Vector& displacement, const ContactRows& rows, const Vector& normal,
                         const Vector& tangential, Vector& force) {
  if (!problem_.contact.follows_motion()) return;
  const Index tangents = problem_.dimension - 1;
  normal_ = normal;
  tangential_ = tangential;
  for (Index point = 0; point < normal_.size(); ++point) {
    if (!problem_.contact.between_bodies(point) || !is_held(rows, point)) continue;
    normal_[point] = 0.0;
    if (tangential_.size() > 0) tangential_.segment(point * tangents, tangents).setZero();
  }
  problem_.contact.geometry->add_couples(displacement, rows, normal_, tangential_, force);
}

}  // namespace ricochet
