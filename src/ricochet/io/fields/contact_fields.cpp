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
  void add_up_pressures();
  void agree_on_status();

  const DisplacementSpace& space_;
  const SemidiscreteProblem& problem_;
  bool has_friction_;
  std::vector<Field> fields_;
  std::vector<double> pressure_, traction_, gap_;
  std::vector<int> status_;
  Vector node_gap_, node_pressure_, node_traction_;
  Index entries_per_node_ = 1;  ///< of the contact boundary, at most
  Vector per_node_;
};

void ContactFields::evaluate(const State& state) {
  std::fill(pressure_.begin(), pressure_.end(), 0.0);
  std::fill(gap_.begin(), gap_.end(), std::numeric_limits<double>::quiet_NaN());
  std::fill(status_.begin(), status_.end(), -1);
  const ContactBoundary& contact = problem_.contact;
  problem_.node_gaps(state.displacement, state.time, node_gap_);
  contact.recover_pressure(state.forces.normal_reaction, node_pressure_);
  add_up_pressures();
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
    if (own >= 0) take(own);
    if (own != -1) continue;
    contact.visit_recovery(i, [&](Index point, double value) {
      if (value != 0.0) take(point);
    });
  }
  agree_on_status();
  if (has_friction_) evaluate_friction(state);
}

/// Each rank knows what its own points do. Entries of a node are the same ones on all of its ranks, in one order.
void ContactFields::add_up_pressures() {
  const Ranks& ranks = *problem_.ranks;
  if (!ranks.are_several()) return;
  const std::vector<Index>& nodes = problem_.contact.nodes;
  Index most = 1, same = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    same = i > 0 && nodes[i] == nodes[i - 1] ? same + 1 : 1;
    most = std::max(most, same);
  }
  entries_per_node_ = static_cast<Index>(ranks.maximum(static_cast<double>(most)));
  per_node_.setZero(space_.node_count() * entries_per_node_);
  const auto place = [&](std::size_t i) {
    same = i > 0 && nodes[i] == nodes[i - 1] ? same + 1 : 0;
    return nodes[i] * entries_per_node_ + same;
  };
  for (std::size_t i = 0; i < nodes.size(); ++i) per_node_[place(i)] = node_pressure_[static_cast<Index>(i)];
  ranks.accumulate(per_node_);
  for (std::size_t i = 0; i < nodes.size(); ++i) node_pressure_[static_cast<Index>(i)] = per_node_[place(i)];
}

/// The largest of those of the ranks, as of several contacts.
void ContactFields::agree_on_status() {
  const Ranks& ranks = *problem_.ranks;
  if (!ranks.are_several()) return;
  constexpr int kinds = 4;  // open, and what a point may do
  per_node_.setZero(space_.node_count() * kinds);
  for (Index node = 0; node < space_.node_count(); ++node) {
    const int status = status_[number(node)];
    if (status >= 0) per_node_[node * kinds + status] = 1.0;
  }
  ranks.accumulate(per_node_);
  for (Index node = 0; node < space_.node_count(); ++node) {
    for (int status = 0; status < kinds; ++status) {
      if (per_node_[node * kinds + status] > 0.0) status_[number(node)] = status;
    }
  }
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
  problem_.ranks->accumulate(node_traction_);
  take_vector(space_, node_traction_, traction_);
}

}  // namespace

std::unique_ptr<FieldSource> make_contact_fields(const FieldContext& context) {
  return std::make_unique<ContactFields>(context);
}

}  // namespace ricochet
