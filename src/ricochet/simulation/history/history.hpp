#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/fem/cell_rotations.hpp"
#include "ricochet/simulation/history/column_digest.hpp"
#include "ricochet/simulation/history/history_columns.hpp"
#include "ricochet/simulation/history/sensor.hpp"

/// @file One row of numbers per step: energies, works, forces, momenta, counts, probes.
namespace ricochet {

/// Computes, once per row, the quantities that sensors observe.
class Observer {
 public:
  explicit Observer(const SemidiscreteProblem& problem) : problem_(problem) {}
  [[nodiscard]] Observation observe(const State& state);

 private:
  const SemidiscreteProblem& problem_;
  Vector gap_, pressure_, nominal_pressure_;
  Vector area_, stretch_, true_reaction_;  ///< at finite strain (contact_surface.hpp)
};

/// Rows of sensors without the rest of the history: step, time and their columns.
class SensorRecorder {
 public:
  SensorRecorder(const SemidiscreteProblem& problem, std::vector<std::shared_ptr<Sensor>> sensors);

  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  /// The reference stays valid until the next call.
  [[nodiscard]] const std::vector<double>& row(const State& state);

 private:
  const SemidiscreteProblem& problem_;
  Observer observer_;
  std::vector<std::shared_ptr<Sensor>> sensors_;
  std::vector<std::string> columns_;
  std::vector<Reduction> reductions_;
  std::vector<double> row_;
};

/// Index of a column that must exist; throws std::logic_error otherwise.
[[nodiscard]] std::size_t column_index(const std::vector<std::string>& columns, const std::string& name);

/// Bodies of a mesh that have columns of their own; empty if there is one body.
struct HistoryBodies {
  std::vector<std::string> labels = {};  ///< momentum.LABEL_x
  std::vector<int> of_node = {};
};

class HistoryRecorder {
 public:
  HistoryRecorder(const SemidiscreteProblem& problem, const CellRotations& rotation,
                  std::vector<std::shared_ptr<Sensor>> sensors = {}, HistoryBodies bodies = {});

  /// Names of the columns, in the order of a row.
  [[nodiscard]] const std::vector<std::string>& columns() const { return columns_; }
  /// Columns of a history that has not been started.
  [[nodiscard]] static Columns columns_of(const SemidiscreteProblem& problem,
                                          const std::vector<std::shared_ptr<Sensor>>& sensors,
                                          const HistoryBodies& bodies = {});
  /// Row of a state. The reference stays valid until the next call.
  [[nodiscard]] const std::vector<double>& row(const State& state, EnergyAccount& account);

 private:
  void weigh_nodes();
  void weigh_positions();
  void update_free_bodies(const State& state);
  void find_contact_force();
  void find_momenta(const Vector& velocity);
  void sum_of_bodies(const Vector& values);
  void find_contact_state(const Vector& gap);

  const SemidiscreteProblem& problem_;
  const CellRotations& rotation_;
  Observer observer_;
  std::vector<std::shared_ptr<Sensor>> sensors_;
  HistoryBodies bodies_;
  bool finite_strain_;
  std::vector<std::string> columns_;
  std::vector<Reduction> reductions_;
  HistoryRow now_;
  std::vector<double> row_;
  std::vector<char> is_active_;
  /// Momentum and angular momentum are Σ node_weight_ p and Σ node_arm_ × p over the nodes. If M = m ⊗ I, as for a
  /// density, p is the velocity, and the factors are m 1 and m x with the reference positions x, which avoids a product
  /// with M. Otherwise p is M V, and they are 1 and x. At finite strain x are the current positions.
  Vector node_weight_;
  Points node_arm_;
  Vector product_with_mass_;  ///< M 1, M x or M V, where they are needed
  Vector position_;           ///< x
};

/// Digests of all columns, row by row.
class HistoryDigest {
 public:
  void add(const std::vector<double>& row);
  /// Throws Error(invalid_input) if a digest that is loaded has another number of columns.
  void persist(const SnapshotVisitor& visit, std::size_t columns);
  [[nodiscard]] const std::vector<ColumnDigest>& columns() const { return columns_; }
  [[nodiscard]] long rows() const { return rows_; }

 private:
  std::vector<ColumnDigest> columns_;
  long rows_ = 0;
};

}  // namespace ricochet
