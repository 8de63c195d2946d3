#pragma once

#include <string>
#include <vector>

#include "ricochet/fem/rotation_gauge.hpp"
#include "ricochet/simulation/energy_account.hpp"

/// @file One row of numbers per step: energies, works, forces, momenta, counts, probes.
namespace ricochet {

/// A node that is watched.
struct Probe {
  std::string name;
  Index node = 0;
  double distance = 0.0;    ///< from the point asked for
  Index contact_node = -1;  ///< its (first) entry among the nodes of the contact boundary, or −1
};

class HistoryRecorder {
 public:
  HistoryRecorder(const SemidiscreteProblem& problem, const RotationGauge& rotation, std::vector<Probe> probes);

  /// Names of the columns, in the order of a row.
  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  /// The standard columns alone (no probes), for a body of this dimension: names that a probe cannot have.
  [[nodiscard]] static std::vector<std::string> standard_columns(int dimension);
  /// The row of a state. The reference stays valid until the next call.
  [[nodiscard]] const std::vector<double>& row(const State& state, EnergyAccount& account);

 private:
  template <class Values>
  void add_vector(const Values& values) {
    for (Index k = 0; k < values.size(); ++k) row_.push_back(values[k]);
  }
  void add_contact_force(const State& state);
  void add_momentum(const Vector& velocity);
  void add_contact_state(const State& state);
  void add_probe(const State& state, const Probe& probe);

  const SemidiscreteProblem& problem_;
  const RotationGauge& rotation_;
  std::vector<Probe> probes_;
  std::vector<std::string> columns_;
  std::vector<double> row_;
  /// M times the rigid velocities: translations along the axes, and rotations about the axes through the origin (in 2D
  /// about z). Products of the velocity with them are the momenta, since M is symmetric. dofs × 3 or 6.
  Matrix momentum_of_;
  Vector gap_, pressure_;
  SparseRowMatrix trace_transposed_;  ///< nodes × points
};

/// What a column did over a run.
struct ColumnDigest {
  double first = 0.0, last = 0.0, minimum = 0.0, maximum = 0.0;
  double total_variation = 0.0;  ///< Σ |difference of consecutive rows|
};

/// Digests of all columns, row by row.
class HistoryDigest {
 public:
  void add(const std::vector<double>& row);
  void save(Snapshot& snapshot, const std::string& name) const;
  /// Throws Error(invalid_input) where it is not of so many columns.
  void load(const Snapshot& snapshot, const std::string& name, std::size_t columns);
  [[nodiscard]] const std::vector<ColumnDigest>& columns() const { return columns_; }
  [[nodiscard]] long rows() const { return rows_; }

 private:
  std::vector<ColumnDigest> columns_;
  long rows_ = 0;
};

}  // namespace ricochet
