#include "ricochet/io/result_fields.hpp"

#include <algorithm>
#include <limits>

namespace ricochet {

ResultFields::ResultFields(const DisplacementSpace& space, const SemidiscreteProblem& problem)
    : space_(space), problem_(problem) {
  const Index nodes = space.node_count();
  const auto count = static_cast<std::size_t>(nodes);
  const auto add = [&](const char* name, int components, std::vector<double>& field) {
    field.assign(count * static_cast<std::size_t>(components), 0.0);
    layout_.push_back({name, components, false, nodes});
    values_.push_back(field.data());
  };
  add("displacement", 3, displacement_);
  add("velocity", 3, velocity_);
  add("contact_pressure", 1, pressure_);
  if (problem.contact.has_friction()) add("friction_traction", 3, traction_);
  add("gap", 1, gap_);
  status_.assign(count, -1);
  layout_.push_back({"contact_status", 1, true, nodes});
  values_.push_back(status_.data());
}

const std::vector<const void*>& ResultFields::evaluate(const State& state) {
  take_vector(state.displacement, displacement_);
  take_vector(state.velocity, velocity_);
  contact_fields(state);
  if (problem_.contact.has_friction()) friction_field(state);
  return values_;
}

/// Three components, also in the plane.
void ResultFields::take_vector(const Vector& values, std::vector<double>& field) const {
  const Index d = problem_.dimension;
  for (Index node = 0; node < problem_.nodes.cols(); ++node) {
    double* const to = field.data() + 3 * number(node);
    for (Index k = 0; k < d; ++k) to[k] = values[node * d + k];
  }
}

void ResultFields::contact_fields(const State& state) {
  std::fill(pressure_.begin(), pressure_.end(), 0.0);
  std::fill(gap_.begin(), gap_.end(), std::numeric_limits<double>::quiet_NaN());
  std::fill(status_.begin(), status_.end(), -1);
  const ContactBoundary& contact = problem_.contact;
  problem_.node_gaps(state.displacement, state.time, node_gap_);
  node_pressure_ = contact.pressure_recovery * state.forces.normal_reaction;
  for (Index i = 0; i < node_gap_.size(); ++i) {
    const std::size_t node = number(contact.nodes[static_cast<std::size_t>(i)]);
    pressure_[node] = std::max(pressure_[node], node_pressure_[i]);
    gap_[node] = status_[node] < 0 ? node_gap_[i] : std::min(gap_[node], node_gap_[i]);
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
    for (SparseRowMatrix::InnerIterator entry(contact.pressure_recovery, i); entry; ++entry) {
      if (entry.value() != 0.0) take(entry.col());
    }
  }
}

/// The friction traction on the body, in stress units: −t r_T of the points, recovered at the nodes like pressures.
void ResultFields::friction_field(const State& state) {
  const ContactBoundary& contact = problem_.contact;
  const int d = problem_.dimension;
  node_traction_.setZero(problem_.dof_count());
  for (std::size_t i = 0; i < contact.nodes.size() && state.forces.tangential_reaction.size() > 0; ++i) {
    for (SparseRowMatrix::InnerIterator entry(contact.pressure_recovery, static_cast<Index>(i)); entry; ++entry) {
      node_traction_.segment(contact.nodes[i] * d, d) -=
          entry.value() * contact.tangents[static_cast<std::size_t>(entry.col())] *
          state.forces.tangential_reaction.segment(entry.col() * (d - 1), d - 1);
    }
  }
  take_vector(node_traction_, traction_);
}

}  // namespace ricochet
