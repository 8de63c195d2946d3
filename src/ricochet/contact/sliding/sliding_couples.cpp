#include "ricochet/contact/sliding/sliding_couples.hpp"

#include <algorithm>

#include "ricochet/contact/sliding/rigid_part.hpp"

namespace ricochet {

bool SlidingCouples::find_forces(const std::vector<SlidingPair::Point>& points, const Vector& normal,
                                 const Vector& tangential, std::vector<char>& forceless) const {
  const Index tangents = nodes_.rows() - 1;
  forceless.resize(points.size());
  std::ranges::transform(points, forceless.begin(), [&](const SlidingPair::Point& point) -> char {
    return normal[point.number] == 0.0 &&
           (tangential.size() == 0 || tangential.segment(point.number * tangents, tangents).isZero(0.0));
  });
  return std::ranges::find(forceless, 0) != forceless.end();
}

void SlidingCouples::add(Index point, const SlidingView& view, const Vector& displacement, const ContactRows& rows,
                         const Vector& normal, const Vector& tangential, Vector& force) {
  const Index d = nodes_.rows(), tangents = d - 1;
  const auto add = [&](Index node, const SlidingVector& value) { force.segment(node * d, d) += value.head(d); };
  for (const auto& [node, value] : view.row) add(node, normal[point] * value);
  rows.visit_normal(point, [&](Index dof, double value) { force[dof] -= value * normal[point]; });
  if (tangential.size() == 0) return;
  SlidingVector friction = SlidingVector::Zero(), across = SlidingVector::Zero();
  friction.head(d) = rows.force(point, normal, tangential) - normal[point] * rows.normal(point);
  const auto act = [&](Index node, double weight) {
    add(node, weight * friction);
    across += weight * current_position(nodes_, node, displacement);
  };
  for (const auto& [node, weight] : view.own) act(node, weight);
  for (const auto& [node, weight] : view.opposite) act(node, -weight);
  positions_.clear();
  for (const auto& [node, weight] : view.own) positions_.push_back(current_position(nodes_, node, displacement));
  forces_of_couple(positions_, d == 2, -across.cross(friction), motions_);
  for (std::size_t j = 0; j < motions_.size(); ++j) add(view.own[j].first, motions_[j]);
  for (Index row = point * tangents; row < (point + 1) * tangents; ++row)
    rows.visit_tangential(row, [&](Index dof, double value) { force[dof] += value * tangential[row]; });
}

}  // namespace ricochet
