#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/io/history_file.hpp"
#include "ricochet/io/summary.hpp"

/// @file Errors of histories relative to another run, and orders of convergence.
namespace ricochet {

/// Results of a run over time.
struct RunHistory {
  RunSummary summary;  ///< states the instants of the columns
  HistoryTable table;
};

/// A quantity that is compared: one column, or the components of a vector.
struct ComparedQuantity {
  std::string name;
  std::vector<std::string> columns;
};

/// Finds a column of the history, or a vector by its columns' names without _x, _y, _z. Throws Error(usage) if there is
/// none, and suggests the one that was probably meant.
[[nodiscard]] ComparedQuantity find_compared(const std::string& name, const HistoryTable& table);

/// Returns the quantities in which runs usually differ: kinetic energy, contact force, displacements of probes at
/// points.
[[nodiscard]] std::vector<ComparedQuantity> usual_compared(const HistoryTable& table);

/// Returns ‖v − r‖ / ‖r‖, with ‖v‖² = ∫ |v|² dt by the trapezoidal rule over the rows of the run, and the reference r
/// interpolated linearly between its rows. Rows outside the reference are left out. None if the run lacks a column,
/// there are fewer than two rows, or ‖r‖ = 0.
[[nodiscard]] std::optional<double> relative_error(const ComparedQuantity& quantity, const RunHistory& run,
                                                   const RunHistory& reference);

/// Returns log(e₁/e₂) / log(h₁/h₂). None if this is undefined: an error or a step is 0, or the steps are equal.
[[nodiscard]] std::optional<double> observed_order(double error_1, double error_2, double step_1, double step_2);

}  // namespace ricochet
