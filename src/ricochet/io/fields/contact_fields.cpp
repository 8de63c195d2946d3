#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/io/fields/field_source.hpp"

namespace ricochet {

namespace {

/// At the nodes; off the contact boundary pressure and traction are 0, the gap is NaN and the status −1. Where two
/// obstacles meet at a node, the larger pressure, the smaller gap and the larger status are given.
class ContactFields final : public FieldSource {
 public:
  explicit ContactFields(const FieldContext& context)
      : space_(*context.body.space), problem_(context.problem), has_friction_(context.problem.contact.has_friction()) {
    const Index nodes = space_.node_count();
    const auto count = static_cast<std::size_t>(nodes);
    pressure_.assign(count, 0.0);
    traction_.assign(3 * count, 0.0);
    gap_.assign(count, 0.0);
    status_.assign(count, 0);
    if (context.wants("contact_pressure"))
      fields_.push_back({"contact_pressure", FieldPlace::nodes, 1, false, nodes, pressure_.data()});
    if (context.wants("friction_traction") && has_friction_)
      fields_.push_back({"friction_traction", FieldPlace::nodes, 3, false, nodes, traction_.data()});
    if (context.wants("gap")) fields_.push_back({"gap", FieldPlace::nodes, 1, false, nodes, gap_.data()});
    if (context.wants("contact_status"))
      fields_.push_back({"contact_status", FieldPlace::nodes, 1, true, nodes, status_.data()});
  }

  [[nodiscard]] std::vector<Field> fields() const override { return fields_; }
  void evaluate(const State& state) override;

 private:
  [[nodiscard]] std::size_t number(Index node) const {
    return static_cast<std::size_t>(space_.number[static_cast<std::size_t>(node)]);
  }
  void evaluate_friction(const State& state);

  const DisplacementSpace& space_;
  const SemidiscreteProblem& problem_;
  bool has_friction_;
  std::vector<Field> fields_;
  std::vector<double> pressure_, traction_, gap_;
  std::vector<int> status_;
  Vector node_gap_, node_pressure_, node_traction_;
};

void ContactFields::evaluate(const State& state) {
  std::fill(pressure_.begin(), pressure_.end(), 0.0);
  std::fill(gap_.begin(), gap_.end(), std::numeric_limits<double>::quiet_NaN());
  std::fill(status_.begin(), status_.end(), -1);
  const ContactBoundary& contact = problem_.contact;
  problem_.node_gaps(state.displacement, state.time, node_gap_);
  contact.recover_pressure(state.forces.normal_reaction, node_pressure_);
  for (Index i = 0; i < node_gap_.size(); ++i) {
    const std::size_t node = number(contact.nodes[static_cast<std::size_t>(i)]);
    pressure_[node] = std::max(pressure_[node], node_pressure_[i]);
    gap_[node] = std::fmin(gap_[node], node_gap_[i]);  // of a number and NaN the number
    status_[node] = std::max(status_[node], 0);
    // A node does what its own contact point does, or, without one, what those do that its pressure comes from.
    const auto take = [&](Index point) {
      const auto at = static_cast<std::size_t>(point);
      if (at < state.contact_status.size())
        status_[node] = std::max(status_[node], static_cast<int>(state.contact_status[at]));
    };
    const Index own = contact.own_point[static_cast<std::size_t>(i)];
    if (own >= 0) {
      take(own);
      continue;
    }
    contact.visit_recovery(i, [&](Index point, double value) {
      if (value != 0.0) take(point);
    });
  }
  if (has_friction_) evaluate_friction(state);
}

/// The friction traction on the body, in stress units: −t r_T of the points, recovered at the nodes like pressures.
void ContactFields::evaluate_friction(const State& state) {
  const ContactBoundary& contact = problem_.contact;
  const int d = problem_.dimension;
  node_traction_.setZero(problem_.dof_count());
  for (std::size_t i = 0; i < contact.nodes.size() && state.forces.tangential_reaction.size() > 0; ++i) {
    // On the other body the traction is the opposite one.
    const double sign = contact.is_opposite[i] != 0 ? 1.0 : -1.0;
    contact.visit_recovery(static_cast<Index>(i), [&](Index point, double value) {
      node_traction_.segment(contact.nodes[i] * d, d) +=
          sign * value * state.forces.rows->along_tangents(point, state.forces.tangential_reaction);
    });
  }
  take_vector(space_, node_traction_, traction_);
}

}  // namespace

std::unique_ptr<FieldSource> make_contact_fields(const FieldContext& context) {
  return std::make_unique<ContactFields>(context);
}

}  // namespace ricochet
