#include "ricochet/simulation/sensor.hpp"

namespace ricochet {

namespace {

std::vector<Index> points_of(const ContactBoundary& boundary, int contact) {
  std::vector<Index> result;
  for (Index point = 0; point < boundary.size(); ++point) {
    if (boundary.pair[static_cast<std::size_t>(point)] == contact) result.push_back(point);
  }
  return result;
}

/// On the body of the contact's first group: rows have the force on that which carries the multipliers.
SpaceVector force_on_first(const State& state, const std::vector<Index>& points, bool exchanged, Index dimension) {
  SpaceVector force = SpaceVector::Zero(dimension);
  for (const Index point : points) {
    if (carries_force(state.forces, point)) force += contact_force(state.forces, point);
  }
  if (exchanged) force = -force;
  return force;
}

class PairForceSensor final : public Sensor {
 public:
  PairForceSensor(const SemidiscreteProblem& problem, int contact, bool exchanged)
      : name_("pair_force." + std::to_string(contact)),
        problem_(problem),
        points_(points_of(problem.contact, contact)),
        exchanged_(exchanged) {}

  [[nodiscard]] Columns columns() const override {
    Columns columns;
    add_vector_columns(columns, name_, problem_.dimension);
    return columns;
  }

  void observe(const Observation& observation, std::vector<double>& row) override {
    append(force_on_first(observation.state, points_, exchanged_, problem_.dimension), row);
  }

 private:
  std::string name_;
  const SemidiscreteProblem& problem_;
  std::vector<Index> points_;
  bool exchanged_;
};

class ContactSensor final : public Sensor {
 public:
  ContactSensor(std::string name, const SemidiscreteProblem& problem, int contact, bool exchanged)
      : name_(std::move(name)),
        problem_(problem),
        points_(points_of(problem.contact, contact)),
        exchanged_(exchanged) {}

  [[nodiscard]] Columns columns() const override {
    Columns columns;
    add_vector_columns(columns, name_ + ".force", problem_.dimension);
    add_vector_columns(columns, name_ + ".centre", problem_.dimension, Reduction::same);
    columns.emplace_back(name_ + ".area");
    return columns;
  }

  void observe(const Observation& observation, std::vector<double>& row) override {
    const Index d = problem_.dimension;
    const ContactBoundary& contact = problem_.contact;
    const State& state = observation.state;
    const SpaceVector force = force_on_first(state, points_, exchanged_, d);
    SpaceVector centre = SpaceVector::Zero(d);
    double pressing = 0.0, area = 0.0;
    for (const Index point : points_) {
      const double normal = state.forces.normal_reaction[point];
      if (!(normal > 0.0)) continue;
      pressing += normal;
      area += contact.weights[point];
      contact.visit_own_nodes(point,
                              [&](Index node, double weight) { centre += normal * weight * problem_.nodes.col(node); });
    }
    // A ratio of sums: the sensor sees to it itself.
    pressing = problem_.ranks->sum(pressing);
    for (double& component : centre) component = problem_.ranks->sum(component);
    if (pressing > 0.0) centre /= pressing;
    append(force, row);
    append(centre, row);
    row.push_back(area);
  }

 private:
  std::string name_;
  const SemidiscreteProblem& problem_;
  std::vector<Index> points_;
  bool exchanged_;
};

}  // namespace

std::unique_ptr<Sensor> make_contact_sensor(const std::string& name, const SemidiscreteProblem& problem, int contact,
                                            bool exchanged) {
  return std::make_unique<ContactSensor>(name, problem, contact, exchanged);
}

std::unique_ptr<Sensor> make_pair_force_sensor(const SemidiscreteProblem& problem, int contact, bool exchanged) {
  return std::make_unique<PairForceSensor>(problem, contact, exchanged);
}

}  // namespace ricochet
