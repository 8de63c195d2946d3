#include <fmt/format.h>

#include "ricochet/base/text.hpp"
#include "ricochet/contact/contact_surface.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"
#include "ricochet/simulation/history/quantity_sensor.hpp"

namespace ricochet {

namespace {

/// Contact points of a pair.
struct PairPoints {
  std::vector<Index> points;
  bool exchanged;  ///< the force on the body of the case's first group is opposite to that of the rows
};

std::vector<PairPoints> points_of(const ContactBoundary& boundary, const std::vector<SensedPair>& pairs) {
  std::vector<PairPoints> result;
  for (const SensedPair& pair : pairs) {
    PairPoints& of_pair = result.emplace_back(PairPoints{{}, pair.exchanged});
    for (Index point = 0; point < boundary.size(); ++point) {
      if (boundary.pair[std::size_t(point)] == pair.number) of_pair.points.push_back(point);
    }
  }
  return result;
}

/// Returns the force on the bodies of the first groups; rows refer to the bodies that carry the multipliers.
SpaceVector force_on_first(const State& state, const std::vector<PairPoints>& pairs, Index dimension) {
  SpaceVector sum = SpaceVector::Zero(dimension);
  for (const PairPoints& pair : pairs) {
    SpaceVector force = SpaceVector::Zero(dimension);
    for (const Index point : pair.points) {
      if (carries_force(state.forces, point)) force += contact_force(state.forces, point);
    }
    if (pair.exchanged) force = -force;
    sum += force;
  }
  return sum;
}

class PairForceSensor final : public QuantitySensor<PairForceSensor> {
 public:
  PairForceSensor(const SemidiscreteProblem& problem, int contact, const std::vector<SensedPair>& pairs)
      : QuantitySensor("pair_force." + std::to_string(contact), problem),
        problem_(problem),
        pairs_(points_of(problem.contact, pairs)) {}

  static const Quantities& quantities() {
    static const Quantities all{
        {{"", "force", "[force of contact N](#forces-between-bodies) on the body of its `group`",
          ColumnComponents::vector},
         member_value(&PairForceSensor::force_),
         {"contacts between bodies"}}};
    return all;
  }

  void evaluate(const Observation& observation) {
    force_ = force_on_first(observation.state, pairs_, problem_.dimension);
  }

 private:
  const SemidiscreteProblem& problem_;
  std::vector<PairPoints> pairs_;
  SpaceVector force_;
};

class ContactSensor final : public QuantitySensor<ContactSensor> {
 public:
  ContactSensor(const std::string& name, const SemidiscreteProblem& problem, const std::vector<SensedPair>& pairs)
      : QuantitySensor(name + ".", problem),
        problem_(problem),
        sensed_(pairs),
        pairs_(points_of(problem.contact, pairs)) {}

  static const Quantities& quantities() {
    using Self = ContactSensor;
    static const Quantities all{
        {{"force", "force",
          "contact force on the body. Between bodies it is that on the body of `group`; of many pairs it is the sum of "
          "the forces on the first body of each pair",
          ColumnComponents::vector},
         member_value(&Self::force_)},
        {{"centre", "length",
          "centre of pressure, 0 where the contact is open; between bodies it lies on the side that carries the "
          "multipliers",
          ColumnComponents::vector, Reduction::same},
         member_value(&Self::centre_)},
        {{"area", "area",
          "[area in contact](#area-in-contact), in 2D a length; with laws of finite strain that of the deformed "
          "surface"},
         [](const Self& self, Index) { return self.area_.now; }},
        {{"nominal_area", "area", "area in contact of the undeformed surface"},
         [](const Self& self, Index) { return self.area_.nominal; },
         {"with laws of finite strain", [](const Self& self) { return self.problem_.contact.surface->deforms(); }}},
    };
    return all;
  }

  void evaluate(const Observation& observation) {
    const Index d = problem_.dimension;
    const ContactBoundary& contact = problem_.contact;
    const State& state = observation.state;
    force_ = force_on_first(state, pairs_, d);
    centre_ = SpaceVector::Zero(d);
    double pressing = 0.0;
    for (const PairPoints& pair : pairs_) {
      for (const Index point : pair.points) {
        const double normal = state.forces.normal_reaction[point];
        if (!(normal > 0.0)) continue;
        pressing += normal;
        contact.visit_own_nodes(point, [&](Index node, double weight) {
          centre_ += normal * weight * problem_.nodes.col(node);
          if (contact.surface->deforms()) centre_ += normal * weight * state.displacement.segment(node * d, d);
        });
      }
    }
    // A ratio of sums cannot be reduced as a column, so the sensor sums over ranks itself.
    pressing = problem_.ranks->sum(pressing);
    for (double& component : centre_) component = problem_.ranks->sum(component);
    if (pressing > 0.0) centre_ /= pressing;
    const ContactView view{contact,         *state.forces.rows,           state.forces.normal_reaction,
                           observation.gap, observation.nominal_pressure, state.displacement,
                           *problem_.ranks};
    area_ = {};
    for (const SensedPair& pair : sensed_) {
      const ContactSurface::Area of_pair = contact.surface->pressed_area(pair.number, view, work_);
      area_.now += of_pair.now;
      area_.nominal += of_pair.nominal;
    }
  }

 private:
  const SemidiscreteProblem& problem_;
  std::vector<SensedPair> sensed_;
  std::vector<PairPoints> pairs_;
  ContactSurface::Work work_;
  SpaceVector force_, centre_;
  ContactSurface::Area area_;
};

/// Returns the numbers of the pairs of the [[contact]] of a probe.
std::vector<std::size_t> pairs_of(const ProbeContext& probe) {
  std::vector<std::size_t> result;
  for (std::size_t i = 0; i < probe.entry_of_pair.size(); ++i) {
    if (double(probe.entry_of_pair[i]) == probe.values.number("contact")) result.push_back(i);
  }
  return result;
}

std::string describe_contact_forces(const ProbeContext& probe, std::size_t entry) {
  const std::vector<std::size_t> pairs = pairs_of(probe);
  if (pairs.size() != 1)
    return fmt::format(
        "its force is the sum, over {} of contact {}, of the force on the body of the first group; its area is that "
        "of the pressed parts of the sides that carry the multipliers",
        counted(pairs.size(), "pair"), entry);
  const ContactPair& pair = probe.pairs[pairs.front()];
  const std::string on =
      pair.between_bodies() ? fmt::format("the body of \"{}\"", pair.first_group()) : std::string("the body");
  return fmt::format(
      "its force is that of all points of contact {} on {}; its area is that of the pressed part of the facets of "
      "\"{}\"",
      entry, on, pair.group);
}

void check_contact(const ProbeContext& probe, ProbeTargets& targets) {
  const auto entry = std::size_t(probe.values.number("contact"));
  const std::size_t count = probe.entry_is_tied.size();
  if (entry >= count) {
    probe.refuse("contact",
                 fmt::format("there is no contact {}: the case has {} of them, numbered from 0", entry, count));
  }
  if (probe.entry_is_tied[entry]) {
    probe.refuse("contact",
                 fmt::format("contact {} is tied: it has no contact points whose forces could be recorded; use a probe "
                             "with \"group\" for stresses near the surface",
                             entry));
  }
  targets.summed_forces = describe_contact_forces(probe, entry);
}

SensorList make_contact_probe(const ProbeContext& probe, const ProbeTargets&) {
  std::vector<SensedPair> sensed;
  for (const std::size_t i : pairs_of(probe)) sensed.push_back({int(i), probe.pairs[i].exchanged});
  return {make_contact_sensor(probe.name, probe.problem, sensed)};
}

}  // namespace

Registration<ProbeKind> contact_probe() {
  return {.name = "contact",
          .type = {.quantities = ContactSensor::descriptions(), .find = check_contact, .make = make_contact_probe},
          .keys = {typed_key(
              "contact", KeyType::integer, "1", {.range = nonnegative},
              "Number of an entry of [[contact]], counted from 0. Columns: its force on the body NAME.force_x … "
              "(between bodies, on the body of its \"group\"), its centre of pressure NAME.centre_x … (0 while it "
              "is open) and its area in contact NAME.area (a length in 2D).")},
          .alternatives = {{"contact"}}};
}

std::vector<RowQuantity> pair_force_quantities() { return PairForceSensor::descriptions(); }

std::unique_ptr<Sensor> make_contact_sensor(const std::string& name, const SemidiscreteProblem& problem,
                                            const std::vector<SensedPair>& pairs) {
  return std::make_unique<ContactSensor>(name, problem, pairs);
}

std::unique_ptr<Sensor> make_pair_force_sensor(const SemidiscreteProblem& problem, int contact,
                                               const std::vector<SensedPair>& pairs) {
  return std::make_unique<PairForceSensor>(problem, contact, pairs);
}

}  // namespace ricochet
