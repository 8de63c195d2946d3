#pragma once

#include <Eigen/Core>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/simulation/history/column.hpp"
#include "ricochet/simulation/history/energy_account.hpp"

/// @file Quantities of history.csv that do not belong to a probe or to a body that moves freely.
namespace ricochet {

/// Values of a row that its quantities are read from. Rows are computed by HistoryRecorder. In 2D, vectors are padded
/// by zeros; numbers of points are floating-point numbers, as columns are.
struct HistoryRow {
  const SemidiscreteProblem* problem = nullptr;
  const State* state = nullptr;
  Energies energies;
  const Works* works = nullptr;
  double energy_residual = 0.0, unsettled_gap = 0.0;
  Eigen::Vector3d contact_force = Eigen::Vector3d::Zero();
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero(), angular_momentum = Eigen::Vector3d::Zero();
  std::vector<double> body_momenta;  ///< d entries of each body
  double rotation = 0.0, penetration = 0.0;
  double active = 0.0, sticking = 0.0, slipping = 0.0, left_out = 0.0;  ///< numbers of contact points

  /// Sets the state, its energies and the works until then.
  void set_state(const State& now, EnergyAccount& account);
};

/// All quantities, in the order of their columns.
[[nodiscard]] const std::vector<ValuedQuantity<HistoryRow>>& history_quantities();

/// Returns the names of the columns of every history of a body of this dimension.
[[nodiscard]] std::vector<std::string> standard_column_names(int dimension);
/// Returns those that any history may have, in 2D or 3D, except those of bodies.
[[nodiscard]] std::vector<std::string> history_column_names();
/// Returns those of a group.
[[nodiscard]] std::vector<std::string> column_names_of(ColumnGroup group);

/// Returns the terms of the energy balance by the names of their columns, also those that are zero in this problem.
[[nodiscard]] std::vector<std::pair<std::string, double>> balance_of(const State& state, EnergyAccount& account);

}  // namespace ricochet
