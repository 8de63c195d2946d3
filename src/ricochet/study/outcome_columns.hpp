#pragma once

#include <string>
#include <vector>

#include "ricochet/study/run_state.hpp"
#include "ricochet/study/table.hpp"

/// @file The columns that a run fills by its own summary. Studies and benchmarks have them.
namespace ricochet {

/// run, status, …: without those of a message.
[[nodiscard]] std::vector<TableColumn> outcome_columns();
/// The cells under them; numbers that the run does not have are empty.
[[nodiscard]] std::vector<TableCell> outcome_cells(const std::string& run, const RunState& state);

/// Why some numbers of a run cannot be trusted, in a few words; empty: nothing is known against them.
[[nodiscard]] std::string doubts_of(const RunSummary& summary);

}  // namespace ricochet
