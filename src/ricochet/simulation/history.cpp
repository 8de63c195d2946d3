#include "ricochet/simulation/history.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "ricochet/base/parallel.hpp"

namespace ricochet {

namespace {

constexpr std::array<const char*, 3> axis_suffix{"_x", "_y", "_z"};

void add_vector_columns(std::vector<std::string>& columns, const std::string& name, int dimension) {
  for (int k = 0; k < dimension; ++k) columns.push_back(name + axis_suffix[static_cast<std::size_t>(k)]);
}

/// A vector of space, never on the heap.
using SpaceVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;

/// The force of a contact point on the body: r_N n − t r_T.
SpaceVector contact_force(const ContactBoundary& contact, const StepForces& forces, Index point) {
  SpaceVector force = forces.normal_reaction[point] * contact.normals.col(point);
  const Index tangents = contact.dimension - 1;
  if (forces.tangential_reaction.size() > 0) {
    force.noalias() -= contact.tangents[static_cast<std::size_t>(point)] *
                       forces.tangential_reaction.segment(point * tangents, tangents);
  }
  return force;
}

/// One number for each rigid motion.
struct RigidVector {
  Eigen::Matrix<double, 6, 1> values = Eigen::Matrix<double, 6, 1>::Zero();
  RigidVector& operator+=(const RigidVector& other) {
    values += other.values;
    return *this;
  }
};

/// M times the rigid velocities, see HistoryRecorder::momentum_of_.
Matrix momenta_of_rigid_velocities(const SemidiscreteProblem& problem) {
  const int d = problem.dimension;
  const int rotations = d == 2 ? 1 : 3;
  Matrix result(problem.dof_count(), d + rotations);
  Vector velocity(problem.dof_count()), momentum;
  for (int k = 0; k < d + rotations; ++k) {
    for (Index node = 0; node < problem.nodes.cols(); ++node) {
      Eigen::Vector3d position = Eigen::Vector3d::Zero();
      position.head(d) = problem.nodes.col(node);
      const Eigen::Vector3d rigid =
          k < d ? Eigen::Vector3d(Eigen::Vector3d::Unit(k)) : Eigen::Vector3d::Unit(d == 2 ? 2 : k - d).cross(position);
      velocity.segment(node * d, d) = rigid.head(d);
    }
    problem.mass.multiply(velocity, momentum);
    result.col(k) = momentum;
  }
  return result;
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
      columns_(standard_columns(problem.dimension)),
      momentum_of_(momenta_of_rigid_velocities(problem)),
      trace_transposed_(problem.contact.trace.transpose()) {
  for (const Probe& probe : probes_) {
    add_vector_columns(columns_, probe.name + ".displacement", problem.dimension);
    add_vector_columns(columns_, probe.name + ".velocity", problem.dimension);
    if (probe.contact_node < 0) continue;
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
  add_contact_force(state);
  add_momentum(account.velocity());
  add_contact_state(state);
  for (const Probe& probe : probes_) add_probe(state, probe);
  return row_;
}

void HistoryRecorder::add_contact_force(const State& state) {
  SpaceVector force = SpaceVector::Zero(problem_.dimension);
  for (Index i = 0; i < problem_.contact.size(); ++i) force += contact_force(problem_.contact, state.forces, i);
  add_vector(force);
}

void HistoryRecorder::add_momentum(const Vector& velocity) {
  // Linear, then angular: the order of the columns.
  add_vector(parallel_sum<RigidVector>(velocity.size(), [&](Index first, Index last) {
               RigidVector part;
               for (Index k = 0; k < momentum_of_.cols(); ++k) {
                 part.values[k] =
                     momentum_of_.col(k).segment(first, last - first).dot(velocity.segment(first, last - first));
               }
               return part;
             }).values.head(momentum_of_.cols()));
}

void HistoryRecorder::add_contact_state(const State& state) {
  row_.push_back(rotation_.largest(state.displacement));
  problem_.node_gaps(state.displacement, state.time, gap_);
  pressure_.noalias() = problem_.contact.pressure_recovery * state.forces.normal_reaction;
  // Points without friction neither stick nor slip.
  double active = 0.0;
  double sticking = 0.0;
  double slipping = 0.0;
  for (const ContactStatus status : state.contact_status) {
    active += status != ContactStatus::open ? 1.0 : 0.0;
    sticking += status == ContactStatus::stick ? 1.0 : 0.0;
    slipping += status == ContactStatus::slip ? 1.0 : 0.0;
  }
  const double penetration = gap_.size() > 0 ? std::max(0.0, -gap_.minCoeff()) : 0.0;
  for (const double value : {active, sticking, slipping, penetration, static_cast<double>(state.iterations)})
    row_.push_back(value);
}

void HistoryRecorder::add_probe(const State& state, const Probe& probe) {
  const int d = problem_.dimension;
  const ContactBoundary& contact = problem_.contact;
  add_vector(state.displacement.segment(probe.node * d, d));
  add_vector(state.velocity.segment(probe.node * d, d));
  if (probe.contact_node < 0) return;
  // The force on the node, from all points of this obstacle whose trace reaches it.
  const int pair = contact.node_pair[static_cast<std::size_t>(probe.contact_node)];
  SpaceVector force = SpaceVector::Zero(d);
  for (SparseRowMatrix::InnerIterator entry(trace_transposed_, probe.node); entry; ++entry) {
    if (problem_.obstacle_of_point(entry.col()) != problem_.obstacles[static_cast<std::size_t>(pair)]) continue;
    force += entry.value() * contact_force(contact, state.forces, entry.col());
  }
  const SpaceVector normal = contact.node_normals.col(probe.contact_node);
  const double normal_force = normal.dot(force);
  for (const double value : {gap_[probe.contact_node], pressure_[probe.contact_node], normal_force}) {
    row_.push_back(value);
  }
  force -= normal_force * normal;
  add_vector(force);
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

void HistoryDigest::save(Snapshot& snapshot, const std::string& name) const {
  Vector numbers(static_cast<Index>(5 * columns_.size()));
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    const ColumnDigest& digest = columns_[i];
    numbers.segment<5>(static_cast<Index>(5 * i)) << digest.first, digest.last, digest.minimum, digest.maximum,
        digest.total_variation;
  }
  snapshot.save(name + ".columns", numbers);
  snapshot.save(name + ".rows", std::int64_t{rows_});
}

void HistoryDigest::load(const Snapshot& snapshot, const std::string& name, std::size_t columns) {
  const Vector& numbers = snapshot.reals(name + ".columns", static_cast<Index>(5 * columns));
  columns_.clear();
  for (Index i = 0; i < numbers.size(); i += 5)
    columns_.push_back({numbers[i], numbers[i + 1], numbers[i + 2], numbers[i + 3], numbers[i + 4]});
  rows_ = snapshot.integer(name + ".rows");
}

}  // namespace ricochet
