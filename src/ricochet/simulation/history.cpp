#include "ricochet/simulation/history.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace ricochet {

namespace {

constexpr std::array<const char*, 3> axis_suffix{"_x", "_y", "_z"};

void add_vector_columns(std::vector<std::string>& columns, const std::string& name, int dimension) {
  for (int k = 0; k < dimension; ++k) columns.push_back(name + axis_suffix[static_cast<std::size_t>(k)]);
}

}  // namespace

std::vector<std::string> HistoryRecorder::standard_columns(int dimension) {
  std::vector<std::string> columns{"step",           "time",
                                   "kinetic_energy", "elastic_energy",
                                   "load_potential", "algorithmic_energy",
                                   "total_energy",   "load_work",
                                   "contact_work",   "friction_work",
                                   "support_work",   "obstacle_work",
                                   "damping_work",   "numerical_dissipation",
                                   "energy_residual"};
  add_vector_columns(columns, "contact_force", dimension);
  add_vector_columns(columns, "momentum", dimension);
  if (dimension == 2) columns.emplace_back("angular_momentum_z");
  if (dimension == 3) add_vector_columns(columns, "angular_momentum", 3);
  for (const char* name :
       {"max_rotation", "active_contacts", "sticking", "slipping", "max_penetration", "iterations"}) {
    columns.emplace_back(name);
  }
  return columns;
}

HistoryRecorder::HistoryRecorder(const SemidiscreteProblem& problem, const RotationGauge& rotation,
                                 std::vector<Probe> probes)
    : problem_(problem),
      rotation_(rotation),
      probes_(std::move(probes)),
      columns_(standard_columns(problem.dimension)) {
  for (const Probe& probe : probes_) {
    add_vector_columns(columns_, probe.name + ".displacement", problem.dimension);
    add_vector_columns(columns_, probe.name + ".velocity", problem.dimension);
    if (probe.contact_point < 0) continue;
    for (const char* name : {".gap", ".pressure", ".reaction_normal"}) columns_.push_back(probe.name + name);
    add_vector_columns(columns_, probe.name + ".reaction_tangential", problem.dimension);
  }
  row_.reserve(columns_.size());
}

const std::vector<double>& HistoryRecorder::row(const State& state, EnergyAccount& account) {
  const Energies energies = account.energies(state);
  const Works& works = account.works();
  row_.assign({static_cast<double>(state.step), state.time, energies.kinetic, energies.elastic, energies.load_potential,
               energies.algorithmic, energies.total(), works.load, works.contact, works.friction, works.support,
               works.obstacle, works.damping, works.numerical_dissipation, account.residual(energies)});
  add_force_and_momentum(state, account.momentum());
  add_contact_state(state);
  for (const Probe& probe : probes_) add_probe(state, probe);
  return row_;
}

void HistoryRecorder::add_force_and_momentum(const State& state, const Vector& momentum) {
  const int d = problem_.dimension;
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (Index i = 0; i < problem_.contact.size(); ++i) {
    force.head(d) += state.forces.normal_reaction[i] * problem_.contact.normals.col(i);
  }
  add_vector(force.head(d));
  Eigen::Vector3d linear = Eigen::Vector3d::Zero();
  Eigen::Vector3d angular = Eigen::Vector3d::Zero();
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d nodal = Eigen::Vector3d::Zero();
  for (Index node = 0; node < problem_.nodes.cols(); ++node) {
    position.head(d) = problem_.nodes.col(node);
    nodal.head(d) = momentum.segment(node * d, d);
    linear += nodal;
    angular += position.cross(nodal);
  }
  add_vector(linear.head(d));
  add_vector(d == 2 ? angular.tail(1) : angular.head(3));
}

void HistoryRecorder::add_contact_state(const State& state) {
  row_.push_back(rotation_.largest(state.displacement));
  problem_.gaps(state.displacement, gap_);
  pressure_.noalias() = problem_.contact.pressure_recovery * state.forces.normal_reaction;
  double active = 0.0;
  double penetration = 0.0;
  for (Index i = 0; i < gap_.size(); ++i) {
    active += state.forces.normal_reaction[i] > 0.0 ? 1.0 : 0.0;
    penetration = std::max(penetration, -gap_[i]);
  }
  // Points without friction neither stick nor slip.
  for (const double value : {active, 0.0, 0.0, penetration, static_cast<double>(state.iterations)})
    row_.push_back(value);
}

void HistoryRecorder::add_probe(const State& state, const Probe& probe) {
  const int d = problem_.dimension;
  add_vector(state.displacement.segment(probe.node * d, d));
  add_vector(state.velocity.segment(probe.node * d, d));
  if (probe.contact_point < 0) return;
  for (const double value :
       {gap_[probe.contact_point], pressure_[probe.contact_point], state.forces.normal_reaction[probe.contact_point]}) {
    row_.push_back(value);
  }
  row_.insert(row_.end(), static_cast<std::size_t>(d), 0.0);  // no friction
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

}  // namespace ricochet
