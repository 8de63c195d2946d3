#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ricochet/io/history_file.hpp"
#include "ricochet/io/summary.hpp"

/// @file Errors of histories against another run, and orders of convergence.
namespace ricochet {

/// A run over time.
struct RunHistory {
  RunSummary summary;  ///< gives the instants of the columns
  HistoryTable table;
};

/// A quantity that is compared: one column, or the components of a vector.
struct ComparedQuantity {
  std::string name;
  std::vector<std::string> columns;
};

/// A column of the history, or a vector by its columns' names without _x, _y, _z. Throws Error(usage) where there is
/// none, with the one that was probably meant.
[[nodiscard]] ComparedQuantity find_compared(const std::string& name, const HistoryTable& table);

/// What tells runs apart: kinetic energy, contact force, displacements of probes at points.
[[nodiscard]] std::vector<ComparedQuantity> usual_compared(const HistoryTable& table);

/// ‖v − r‖ / ‖r‖, with ‖v‖² = ∫ |v|² dt by the trapezoidal rule over the rows of the run, and r, the reference,
/// linear between its rows. Rows that the reference does not reach are left out. Nothing where the run lacks a column,
/// there are fewer than two rows, or ‖r‖ = 0.
[[nodiscard]] std::optional<double> relative_error(const ComparedQuantity& quantity, const RunHistory& run,
                                                   const RunHistory& reference);

/// log(e₁/e₂) / log(h₁/h₂). Nothing where that is no number: an error or a step is 0, or the steps are the same.
[[nodiscard]] std::optional<double> observed_order(double error_1, double error_2, double step_1, double step_2);

}  // namespace ricochet
