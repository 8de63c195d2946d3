#include "ricochet/simulation/history/history.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "ricochet/base/parallel.hpp"
#include "ricochet/contact/contact_surface.hpp"

namespace ricochet {

namespace {

struct Momenta {
  Eigen::Vector3d linear = Eigen::Vector3d::Zero(), angular = Eigen::Vector3d::Zero();
  Momenta& operator+=(const Momenta& other) {
    linear += other.linear;
    angular += other.angular;
    return *this;
  }
};

/// Σ weight · value and Σ arm × value over some nodes.
template <int d>
Momenta momenta_of(const Vector& weight, const Points& arm, const Vector& values, Index first, Index last) {
  Momenta result;
  for (Index node = first; node < last; ++node) {
    const Eigen::Matrix<double, d, 1> value = values.segment<d>(node * d), at = arm.col(node).template head<d>();
    result.linear.template head<d>() += weight[node] * value;
    if constexpr (d == 2) {
      result.angular[2] += at[0] * value[1] - at[1] * value[0];
    } else {
      result.angular += at.cross(value);
    }
  }
  return result;
}

}  // namespace

std::size_t column_index(const std::vector<std::string>& columns, const std::string& name) {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) throw std::logic_error("no column " + name);
  return static_cast<std::size_t>(found - columns.begin());
}

Columns HistoryRecorder::standard_columns(int dimension) {
  Columns columns{{"step", Reduction::same}, {"time", Reduction::same}, "kinetic_energy", "elastic_energy",
                  "load_potential",          "algorithmic_energy",      "total_energy"};
  for (const char* const work : work_columns) columns.emplace_back(work);
  for (const char* const name : {"numerical_dissipation", "energy_residual"}) columns.emplace_back(name);
  add_vector_columns(columns, "contact_force", dimension);
  add_vector_columns(columns, "momentum", dimension);
  if (dimension == 2) columns.emplace_back("angular_momentum_z");
  if (dimension == 3) add_vector_columns(columns, "angular_momentum", 3);
  columns.emplace_back("max_rotation", Reduction::maximum);
  for (const char* const name : {"active_contacts", "sticking", "slipping"}) columns.emplace_back(name);
  columns.emplace_back("max_penetration", Reduction::maximum);
  columns.emplace_back("iterations", Reduction::same);
  return columns;
}

Columns HistoryRecorder::finite_strain_columns() {
  return {"integration_error", {"newton_rounds", Reduction::same}};
}

Columns HistoryRecorder::relaxation_columns() {
  return {"viscous_dissipation"};
}

Columns HistoryRecorder::sliding_columns(bool touches_itself) {
  Columns columns = {"re_pairing_work", {"unsettled_gap", Reduction::maximum}};
  if (touches_itself) columns.emplace_back("left_out_points");
  return columns;
}

Columns HistoryRecorder::columns_of(const SemidiscreteProblem& problem,
                                    const std::vector<std::shared_ptr<Sensor>>& sensors, const HistoryBodies& bodies) {
  Columns columns = standard_columns(problem.dimension);
  for (const std::string& label : bodies.labels) add_vector_columns(columns, "momentum." + label, problem.dimension);
  if (!problem.internal_force->is_linear()) {
    for (const Column& column : finite_strain_columns()) columns.push_back(column);
  }
  if (problem.internal_force->viscous() != nullptr) {
    for (const Column& column : relaxation_columns()) columns.push_back(column);
  }
  if (problem.contact.has_sliding_pairs()) {
    for (const Column& column : sliding_columns(problem.contact.touches_itself)) columns.push_back(column);
  }
  for (const auto& sensor : sensors) {
    for (const Column& column : sensor->columns()) columns.push_back(column);
  }
  return columns;
}

HistoryRecorder::HistoryRecorder(const SemidiscreteProblem& problem, const CellRotations& rotation,
                                 std::vector<std::shared_ptr<Sensor>> sensors, HistoryBodies bodies)
    : problem_(problem),
      rotation_(rotation),
      observer_(problem),
      sensors_(std::move(sensors)),
      bodies_(std::move(bodies)),
      body_momentum_(bodies_.labels.size() * static_cast<std::size_t>(problem.dimension)),
      finite_strain_(!problem.internal_force->is_linear()),
      columns_(names_of(columns_of(problem, sensors_, bodies_))),
      reductions_(reductions_of(columns_of(problem, sensors_, bodies_))) {
  row_.reserve(columns_.size());
  weigh_nodes();
}

void HistoryRecorder::weigh_nodes() {
  const NodeMatrix& mass = problem_.mass;
  node_weight_.setOnes(problem_.nodes.cols());
  position_ = problem_.nodes.reshaped();
  if (mass.is_scalar()) {
    mass.multiply(Vector::Ones(problem_.dof_count()), product_with_mass_);
    for (Index node = 0; node < node_weight_.size(); ++node)
      node_weight_[node] = product_with_mass_[node * problem_.dimension];
  }
  // Rotations of rigid bodies do not contribute to the momentum of their nodes.
  for (const auto& body : problem_.free_bodies) node_weight_[body->rotation_node()] = 0.0;
  weigh_positions();
}

/// Sets the positions of rigid bodies to the current ones, also at small strain of the others.
void HistoryRecorder::update_free_bodies(const State& state) {
  const Index d = problem_.dimension;
  for (const auto& body : problem_.free_bodies)
    position_.segment(body->centre_node() * d, d) = body->centre(state.displacement);
}

void HistoryRecorder::weigh_positions() {
  if (problem_.mass.is_scalar()) {
    problem_.mass.multiply(position_, product_with_mass_);
    node_arm_ = product_with_mass_.reshaped(problem_.dimension, problem_.nodes.cols());
  } else {
    node_arm_ = position_.reshaped(problem_.dimension, problem_.nodes.cols());
  }
  for (const auto& body : problem_.free_bodies) node_arm_.col(body->rotation_node()).setZero();
}

const std::vector<double>& HistoryRecorder::row(const State& state, EnergyAccount& account) {
  const Energies energies = account.energies(state);
  const Works& works = account.works();
  row_.assign({static_cast<double>(state.step), state.time, energies.kinetic, energies.elastic, energies.load_potential,
               energies.algorithmic, energies.total(), works.load, works.contact, works.friction, works.support,
               works.obstacle, works.damping, works.numerical_dissipation, account.residual(energies)});
  add_contact_force(state);
  add_momentum(state, account.velocity(state));
  const Observation observation = observer_.observe(state);
  add_contact_state(observation);
  row_.insert(row_.end(), body_momentum_.begin(), body_momentum_.end());
  if (finite_strain_) {
    row_.push_back(works.integration_error);
    row_.push_back(state.newton_iterations);
  }
  if (problem_.internal_force->viscous() != nullptr) row_.push_back(works.viscous_dissipation);
  if (problem_.contact.has_sliding_pairs()) row_.insert(row_.end(), {works.re_pairing, account.unsettled_gap()});
  if (problem_.contact.touches_itself) row_.push_back(left_out_points());
  for (const auto& sensor : sensors_) sensor->observe(observation, row_);
  problem_.ranks->reduce(row_, reductions_);
  return row_;
}

double HistoryRecorder::left_out_points() {
  is_active_.assign(static_cast<std::size_t>(problem_.contact.size()), 1);
  problem_.contact.geometry->deactivate_points(is_active_);
  return static_cast<double>(std::count(is_active_.begin(), is_active_.end(), 0));
}

void HistoryRecorder::add_contact_force(const State& state) {
  SpaceVector force = SpaceVector::Zero(problem_.dimension);
  // Forces between bodies cancel.
  for (Index i = 0; i < problem_.contact.size(); ++i) force += problem_.contact.net[i] * contact_force(state.forces, i);
  append(force, row_);
}

void HistoryRecorder::add_momentum(const State& state, const Vector& velocity) {
  if (finite_strain_) {
    position_ = problem_.nodes.reshaped() + state.displacement;
    weigh_positions();
  } else if (!problem_.free_bodies.empty()) {
    update_free_bodies(state);
    weigh_positions();
  }
  if (!problem_.mass.is_scalar()) problem_.mass.multiply(velocity, product_with_mass_);
  const Vector& values = problem_.mass.is_scalar() ? velocity : product_with_mass_;
  Momenta sum = parallel_sum<Momenta>(node_weight_.size(), [&](Index first, Index last) {
    return problem_.dimension == 2 ? momenta_of<2>(node_weight_, node_arm_, values, first, last)
                                   : momenta_of<3>(node_weight_, node_arm_, values, first, last);
  });
  for (const auto& body : problem_.free_bodies) {
    const SpaceVector own = body->angular_momentum(state.displacement, velocity);
    sum.angular.tail(own.size()) += own;
  }
  if (problem_.axisymmetric) {  // cancel over the ring
    sum.linear[0] = 0.0;
    sum.angular.setZero();
  }
  // Appended in the order of the columns.
  append(sum.linear.head(problem_.dimension), row_);
  append(problem_.dimension == 2 ? sum.angular.tail(1) : sum.angular.head(3), row_);
  if (!bodies_.labels.empty()) sum_of_bodies(values);
}

void HistoryRecorder::sum_of_bodies(const Vector& values) {
  const auto d = static_cast<std::size_t>(problem_.dimension);
  std::fill(body_momentum_.begin(), body_momentum_.end(), 0.0);
  for (Index node = 0; node < node_weight_.size(); ++node) {
    if (problem_.is_of_free_body(node)) break;
    double* const own =
        body_momentum_.data() + d * static_cast<std::size_t>(bodies_.of_node[static_cast<std::size_t>(node)]);
    for (std::size_t k = problem_.axisymmetric ? 1 : 0; k < d; ++k)
      own[k] += node_weight_[node] * values[node * problem_.dimension + static_cast<Index>(k)];
  }
}

void HistoryRecorder::add_contact_state(const Observation& observation) {
  const State& state = observation.state;
  row_.push_back(rotation_.largest(state.displacement));
  // Points without friction neither stick nor slip.
  double active = 0.0;
  double sticking = 0.0;
  double slipping = 0.0;
  for (const ContactStatus status : state.contact_status) {
    active += status != ContactStatus::open ? 1.0 : 0.0;
    sticking += status == ContactStatus::stick ? 1.0 : 0.0;
    slipping += status == ContactStatus::slip ? 1.0 : 0.0;
  }
  double penetration = 0.0;
  for (const double gap : observation.gap) penetration = std::max(penetration, -gap);  // false for NaN
  for (const double value : {active, sticking, slipping, penetration, static_cast<double>(state.iterations)})
    row_.push_back(value);
}

Observation Observer::observe(const State& state) {
  problem_.node_gaps(state.displacement, state.time, gap_);
  const ContactBoundary& contact = problem_.contact;
  contact.recover_pressure(state.forces.normal_reaction, nominal_pressure_);
  if (contact.surface == nullptr || !contact.surface->deforms())
    return {state, gap_, nominal_pressure_, nominal_pressure_};
  contact.surface->find_stretch(state.displacement, area_, stretch_);
  true_reaction_ = state.forces.normal_reaction.cwiseQuotient(stretch_);
  contact.recover_pressure(true_reaction_, pressure_);
  return {state, gap_, pressure_, nominal_pressure_};
}

SensorRecorder::SensorRecorder(const SemidiscreteProblem& problem, std::vector<std::shared_ptr<Sensor>> sensors)
    : problem_(problem), observer_(problem), sensors_(std::move(sensors)) {
  Columns columns{{"step", Reduction::same}, {"time", Reduction::same}};
  for (const auto& sensor : sensors_) {
    for (const Column& column : sensor->columns()) columns.push_back(column);
  }
  columns_ = names_of(columns);
  reductions_ = reductions_of(columns);
  row_.reserve(columns_.size());
}

const std::vector<double>& SensorRecorder::row(const State& state) {
  row_.assign({static_cast<double>(state.step), state.time});
  const Observation observation = observer_.observe(state);
  for (const auto& sensor : sensors_) sensor->observe(observation, row_);
  problem_.ranks->reduce(row_, reductions_);
  return row_;
}

void HistoryDigest::add(const std::vector<double>& row) {
  if (rows_ == 0) {
    columns_.clear();
    for (const double value : row) columns_.push_back({value, value, value, value, 0.0});
  }
  for (std::size_t i = 0; i < row.size(); ++i) {
    ColumnDigest& digest = columns_[i];
    digest.total_variation += std::abs(row[i] - digest.last);
    digest.last = row[i];
    digest.minimum = std::min(digest.minimum, row[i]);
    digest.maximum = std::max(digest.maximum, row[i]);
  }
  ++rows_;
}

void HistoryDigest::persist(const SnapshotVisitor& visit, std::size_t columns) {
  if (visit.loads()) columns_.resize(columns);
  visit.numbers("columns", columns_);
  visit("rows", rows_);
}

}  // namespace ricochet
