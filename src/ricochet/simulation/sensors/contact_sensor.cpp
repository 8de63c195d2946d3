#include "ricochet/simulation/sensor.hpp"

namespace ricochet {

namespace {

class ContactSensor final : public Sensor {
 public:
  ContactSensor(std::string name, const SemidiscreteProblem& problem, int contact)
      : name_(std::move(name)), problem_(problem) {
    for (Index point = 0; point < problem.contact.size(); ++point) {
      if (problem.contact.pair[static_cast<std::size_t>(point)] == contact) points_.push_back(point);
    }
  }

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
    SpaceVector force = SpaceVector::Zero(d), centre = SpaceVector::Zero(d);
    double pressing = 0.0, area = 0.0;
    for (const Index point : points_) {
      if (carries_force(state.forces, point)) force += contact_force(state.forces, point);
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
};

}  // namespace

std::unique_ptr<Sensor> make_contact_sensor(const std::string& name, const SemidiscreteProblem& problem, int contact) {
  return std::make_unique<ContactSensor>(name, problem, contact);
}

}  // namespace ricochet
