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

/// Returns the columns with those of the sensors after them.
Columns with_columns_of(const std::vector<std::shared_ptr<Sensor>>& sensors, Columns columns) {
  for (const auto& sensor : sensors) {
    for (Column& column : sensor->columns()) columns.push_back(std::move(column));
  }
  return columns;
}

}  // namespace

std::size_t column_index(const std::vector<std::string>& columns, const std::string& name) {
  const auto found = std::ranges::find(columns, name);
  if (found == columns.end()) throw std::logic_error("no column " + name);
  return std::size_t(found - columns.begin());
}

Columns HistoryRecorder::columns_of(const SemidiscreteProblem& problem,
                                    const std::vector<std::shared_ptr<Sensor>>& sensors, const HistoryBodies& bodies) {
  HistoryRow row;
  row.problem = &problem;
  Columns columns;
  add_columns(history_quantities(), row, "", problem.dimension, columns, bodies.labels);
  return with_columns_of(sensors, std::move(columns));
}

HistoryRecorder::HistoryRecorder(const SemidiscreteProblem& problem, const CellRotations& rotation,
                                 std::vector<std::shared_ptr<Sensor>> sensors, HistoryBodies bodies)
    : problem_(problem),
      rotation_(rotation),
      observer_(problem),
      sensors_(std::move(sensors)),
      bodies_(std::move(bodies)),
      finite_strain_(!problem.internal_force->is_linear()),
      columns_(names_of(columns_of(problem, sensors_, bodies_))),
      reductions_(reductions_of(columns_of(problem, sensors_, bodies_))) {
  now_.problem = &problem;
  now_.body_momenta.resize(bodies_.labels.size() * std::size_t(problem.dimension));
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
  now_.set_state(state, account);
  find_contact_force();
  find_momenta(account.velocity(state));
  const Observation observation = observer_.observe(state);
  find_contact_state(observation.gap);
  row_.clear();
  append_values(history_quantities(), now_, problem_.dimension, row_, bodies_.labels.size());
  for (const auto& sensor : sensors_) sensor->observe(observation, row_);
  problem_.ranks->reduce(row_, reductions_);
  return row_;
}

void HistoryRecorder::find_contact_force() {
  SpaceVector force = SpaceVector::Zero(problem_.dimension);
  // Forces between bodies cancel.
  for (Index i = 0; i < problem_.contact.size(); ++i)
    force += problem_.contact.net[i] * contact_force(now_.state->forces, i);
  now_.contact_force.head(problem_.dimension) = force;
}

void HistoryRecorder::find_momenta(const Vector& velocity) {
  const State& state = *now_.state;
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
  now_.momentum = sum.linear;
  now_.angular_momentum = sum.angular;
  if (!bodies_.labels.empty()) sum_of_bodies(values);
}

void HistoryRecorder::sum_of_bodies(const Vector& values) {
  const auto d = std::size_t(problem_.dimension);
  std::ranges::fill(now_.body_momenta, 0.0);
  for (Index node = 0; node < node_weight_.size(); ++node) {
    if (problem_.is_of_free_body(node)) break;
    double* const own = now_.body_momenta.data() + d * std::size_t(bodies_.of_node[std::size_t(node)]);
    for (std::size_t k = problem_.axisymmetric ? 1 : 0; k < d; ++k)
      own[k] += node_weight_[node] * values[node * problem_.dimension + Index(k)];
  }
}

void HistoryRecorder::find_contact_state(const Vector& gap) {
  now_.rotation = rotation_.largest(now_.state->displacement);
  // Points without friction neither stick nor slip.
  now_.active = now_.sticking = now_.slipping = 0.0;
  for (const ContactStatus status : now_.state->contact_status) {
    now_.active += status != ContactStatus::open ? 1.0 : 0.0;
    now_.sticking += status == ContactStatus::stick ? 1.0 : 0.0;
    now_.slipping += status == ContactStatus::slip ? 1.0 : 0.0;
  }
  now_.penetration = 0.0;
  for (const double value : gap) now_.penetration = std::max(now_.penetration, -value);  // false for NaN
  if (!problem_.contact.touches_itself) return;
  is_active_.assign(std::size_t(problem_.contact.size()), 1);
  problem_.contact.geometry->deactivate_points(is_active_);
  now_.left_out = double(std::ranges::count(is_active_, 0));
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
  const Columns columns = with_columns_of(sensors_, {{"step", Reduction::same}, {"time", Reduction::same}});
  columns_ = names_of(columns);
  reductions_ = reductions_of(columns);
  row_.reserve(columns_.size());
}

const std::vector<double>& SensorRecorder::row(const State& state) {
  row_.assign({double(state.step), state.time});
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
