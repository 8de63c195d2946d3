#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/contact/contact_surface.hpp"
#include "ricochet/io/fields/field_source.hpp"

namespace ricochet {

namespace {

/// Nodal fields; outside the contact boundary pressure and traction are 0, the gap is NaN and the status −1. At a node
/// with two obstacles they are the larger pressure, the smaller gap and the larger status. Pressures and tractions
/// refer to the deformed surface; at finite strain the nominal ones differ from them.
class ContactFields final : public FieldSource {
 public:
  explicit ContactFields(const FieldContext& context)
      : space_(*context.body.space),
        problem_(context.problem),
        has_friction_(context.problem.contact.has_friction()),
        deforms_(has_finite_strain(context.body)) {
    const Index nodes = space_.node_count();
    const auto count = std::size_t(nodes);
    gap_.assign(count, 0.0);
    status_.assign(count, 0);
    add_stresses(context, "contact_pressure", "friction_traction", stresses_);
    if (context.is_requested("gap")) fields_.push_back({"gap", FieldLocation::nodes, 1, false, nodes, gap_.data()});
    if (context.is_requested("contact_status"))
      fields_.push_back({"contact_status", FieldLocation::nodes, 1, true, nodes, status_.data()});
    if (deforms_) add_stresses(context, "nominal_contact_pressure", "nominal_friction_traction", nominal_);
  }

  [[nodiscard]] std::vector<Field> fields() const override { return fields_; }
  void evaluate(const State& state) override;

 private:
  struct Stresses {
    std::vector<double> pressure, traction;
    bool is_requested = false;
  };

  [[nodiscard]] std::size_t number(Index node) const { return std::size_t(space_.number[std::size_t(node)]); }
  void add_stresses(const FieldContext& context, const char* pressure, const char* traction, Stresses& stresses) {
    const Index nodes = space_.node_count();
    stresses.pressure.assign(std::size_t(nodes), 0.0);
    stresses.traction.assign(std::size_t(3 * nodes), 0.0);
    stresses.is_requested = context.any_is_requested({pressure, traction});
    if (context.is_requested(pressure))
      fields_.push_back({pressure, FieldLocation::nodes, 1, false, nodes, stresses.pressure.data()});
    if (context.is_requested(traction) && has_friction_)
      fields_.push_back({traction, FieldLocation::nodes, 3, false, nodes, stresses.traction.data()});
  }
  void find_true_reactions(const State& state);
  void evaluate(const ContactRows& rows, const Vector& normal, const Vector& tangential, Stresses& stresses);
  void evaluate_friction(const ContactRows& rows, const Vector& tangential, std::vector<double>& traction);
  void add_up_pressures();
  void agree_on_status();

  const DisplacementSpace& space_;
  const SemidiscreteProblem& problem_;
  bool has_friction_, deforms_;
  std::vector<Field> fields_;
  Stresses stresses_, nominal_;
  std::vector<double> gap_;
  std::vector<int> status_;
  Vector node_gap_, node_pressure_, node_traction_;
  Index entries_per_node_ = 1;  ///< maximum number of entries of the contact boundary per node
  Vector per_node_;
  Vector area_, stretch_, true_normal_, true_tangential_;
};

void ContactFields::evaluate(const State& state) {
  std::ranges::fill(gap_, std::numeric_limits<double>::quiet_NaN());
  std::ranges::fill(status_, -1);
  const ContactBoundary& contact = problem_.contact;
  problem_.node_gaps(state.displacement, state.time, node_gap_);
  const StepForces& forces = state.forces;
  if (deforms_) {
    evaluate(*forces.rows, forces.normal_reaction, forces.tangential_reaction, nominal_);
    find_true_reactions(state);
    evaluate(*forces.rows, true_normal_, true_tangential_, stresses_);
  } else {
    evaluate(*forces.rows, forces.normal_reaction, forces.tangential_reaction, stresses_);
  }
  for (Index i = 0; i < node_gap_.size(); ++i) {
    const std::size_t node = number(contact.nodes[std::size_t(i)]);
    gap_[node] = std::fmin(gap_[node], node_gap_[i]);  // the number, if one of the two is NaN
    status_[node] = std::max(status_[node], 0);
    // A node has the status of its own contact point or, without one, of the points from which its pressure is
    // recovered.
    const auto include_status = [&](Index point) {
      const auto at = std::size_t(point);
      if (at < state.contact_status.size()) status_[node] = std::max(status_[node], int(state.contact_status[at]));
    };
    const Index own = contact.own_point[std::size_t(i)];
    if (own >= 0) include_status(own);
    if (own != -1) continue;
    contact.visit_recovery(i, [&](Index point, double value) {
      if (value != 0.0) include_status(point);
    });
  }
  agree_on_status();
}

/// Divides reactions by the area stretch a/A, so that recovery with undeformed areas yields true pressures.
void ContactFields::find_true_reactions(const State& state) {
  problem_.contact.surface->find_stretch(state.displacement, area_, stretch_);
  true_normal_ = state.forces.normal_reaction.cwiseQuotient(stretch_);
  true_tangential_ = state.forces.tangential_reaction;
  const Index tangents = problem_.dimension - 1;
  for (Index row = 0; row < true_tangential_.size(); ++row) true_tangential_[row] /= stretch_[row / tangents];
}

void ContactFields::evaluate(const ContactRows& rows, const Vector& normal, const Vector& tangential,
                             Stresses& stresses) {
  if (!stresses.is_requested) return;
  const ContactBoundary& contact = problem_.contact;
  std::ranges::fill(stresses.pressure, 0.0);
  contact.recover_pressure(normal, node_pressure_);
  add_up_pressures();
  for (Index i = 0; i < node_pressure_.size(); ++i) {
    double& pressure = stresses.pressure[number(contact.nodes[std::size_t(i)])];
    pressure = std::max(pressure, node_pressure_[i]);
  }
  if (has_friction_) evaluate_friction(rows, tangential, stresses.traction);
}

/// Sums over ranks, each of which has the part of its own points. Entries of a node are the same on all of its ranks,
/// in the same order.
void ContactFields::add_up_pressures() {
  const Ranks& ranks = *problem_.ranks;
  if (!ranks.are_several()) return;
  const std::vector<Index>& nodes = problem_.contact.nodes;
  Index most = 1, same = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    same = i > 0 && nodes[i] == nodes[i - 1] ? same + 1 : 1;
    most = std::max(most, same);
  }
  entries_per_node_ = Index(ranks.maximum(double(most)));
  per_node_.setZero(space_.node_count() * entries_per_node_);
  const auto index = [&](std::size_t i) {
    same = i > 0 && nodes[i] == nodes[i - 1] ? same + 1 : 0;
    return nodes[i] * entries_per_node_ + same;
  };
  for (std::size_t i = 0; i < nodes.size(); ++i) per_node_[index(i)] = node_pressure_[Index(i)];
  ranks.accumulate(per_node_);
  for (std::size_t i = 0; i < nodes.size(); ++i) node_pressure_[Index(i)] = per_node_[index(i)];
}

/// Uses the largest status of the ranks, as for several contacts.
void ContactFields::agree_on_status() {
  const Ranks& ranks = *problem_.ranks;
  if (!ranks.are_several()) return;
  constexpr int kinds = 4;  // open, and the states of a point
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

/// Computes the friction traction on the body, in stress units: −t r_T of the points, recovered at the nodes like
/// pressures.
void ContactFields::evaluate_friction(const ContactRows& rows, const Vector& tangential,
                                      std::vector<double>& traction) {
  const ContactBoundary& contact = problem_.contact;
  const int d = problem_.dimension;
  node_traction_.setZero(problem_.dof_count());
  for (std::size_t i = 0; i < contact.nodes.size() && tangential.size() > 0; ++i) {
    // On the opposite body the traction has the opposite sign.
    const double sign = contact.is_opposite[i] != 0 ? 1.0 : -1.0;
    contact.visit_recovery(Index(i), [&](Index point, double value) {
      node_traction_.segment(contact.nodes[i] * d, d) += sign * value * rows.along_tangents(point, tangential);
    });
  }
  problem_.ranks->accumulate(node_traction_);
  copy_vector(space_, node_traction_, traction);
}

}  // namespace

std::unique_ptr<FieldSource> make_contact_fields(const FieldContext& context) {
  return std::make_unique<ContactFields>(context);
}

}  // namespace ricochet
