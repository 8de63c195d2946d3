#include "ricochet/contact/contact_surface.hpp"
#include "ricochet/simulation/history/sensor.hpp"

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
      if (boundary.pair[static_cast<std::size_t>(point)] == pair.number) of_pair.points.push_back(point);
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

class PairForceSensor final : public Sensor {
 public:
  PairForceSensor(const SemidiscreteProblem& problem, int contact, bool exchanged)
      : name_("pair_force." + std::to_string(contact)),
        problem_(problem),
        pairs_(points_of(problem.contact, {SensedPair{contact, exchanged}})) {}

  [[nodiscard]] Columns columns() const override {
    Columns columns;
    add_vector_columns(columns, name_, problem_.dimension);
    return columns;
  }

  void observe(const Observation& observation, std::vector<double>& row) override {
    append(force_on_first(observation.state, pairs_, problem_.dimension), row);
  }

 private:
  std::string name_;
  const SemidiscreteProblem& problem_;
  std::vector<PairPoints> pairs_;
};

class ContactSensor final : public Sensor {
 public:
  ContactSensor(std::string name, const SemidiscreteProblem& problem, const std::vector<SensedPair>& pairs)
      : name_(std::move(name)), problem_(problem), sensed_(pairs), pairs_(points_of(problem.contact, pairs)) {}

  [[nodiscard]] Columns columns() const override {
    Columns columns;
    add_vector_columns(columns, name_ + ".force", problem_.dimension);
    add_vector_columns(columns, name_ + ".centre", problem_.dimension, Reduction::same);
    columns.emplace_back(name_ + ".area");
    if (problem_.contact.surface->deforms()) columns.emplace_back(name_ + ".nominal_area");
    return columns;
  }

  void observe(const Observation& observation, std::vector<double>& row) override {
    const Index d = problem_.dimension;
    const ContactBoundary& contact = problem_.contact;
    const State& state = observation.state;
    const SpaceVector force = force_on_first(state, pairs_, d);
    SpaceVector centre = SpaceVector::Zero(d);
    double pressing = 0.0;
    for (const PairPoints& pair : pairs_) {
      for (const Index point : pair.points) {
        const double normal = state.forces.normal_reaction[point];
        if (!(normal > 0.0)) continue;
        pressing += normal;
        contact.visit_own_nodes(point, [&](Index node, double weight) {
          centre += normal * weight * problem_.nodes.col(node);
          if (contact.surface->deforms()) centre += normal * weight * state.displacement.segment(node * d, d);
        });
      }
    }
    // A ratio of sums cannot be reduced as a column, so the sensor sums over ranks itself.
    pressing = problem_.ranks->sum(pressing);
    for (double& component : centre) component = problem_.ranks->sum(component);
    if (pressing > 0.0) centre /= pressing;
    append(force, row);
    append(centre, row);
    const ContactView view{contact,         *state.forces.rows,           state.forces.normal_reaction,
                           observation.gap, observation.nominal_pressure, state.displacement,
                           *problem_.ranks};
    ContactSurface::Area area;
    for (const SensedPair& pair : sensed_) {
      const ContactSurface::Area of_pair = contact.surface->pressed_area(pair.number, view, work_);
      area.now += of_pair.now;
      area.nominal += of_pair.nominal;
    }
    row.push_back(area.now);
    if (contact.surface->deforms()) row.push_back(area.nominal);
  }

 private:
  std::string name_;
  const SemidiscreteProblem& problem_;
  std::vector<SensedPair> sensed_;
  std::vector<PairPoints> pairs_;
  ContactSurface::Work work_;
};

}  // namespace

std::unique_ptr<Sensor> make_contact_sensor(const std::string& name, const SemidiscreteProblem& problem,
                                            const std::vector<SensedPair>& pairs) {
  return std::make_unique<ContactSensor>(name, problem, pairs);
}

std::unique_ptr<Sensor> make_pair_force_sensor(const SemidiscreteProblem& problem, int contact, bool exchanged) {
  return std::make_unique<PairForceSensor>(problem, contact, exchanged);
}

}  // namespace ricochet
