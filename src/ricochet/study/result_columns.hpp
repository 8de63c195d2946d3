#pragma once

#include <string>
#include <vector>

#include "ricochet/study/run_state.hpp"
#include "ricochet/study/table.hpp"

/// @file Columns that the summary of a run fills, in the tables of studies and benchmarks.
namespace ricochet {

/// Returns the columns run, status, …, without those of messages.
[[nodiscard]] std::vector<TableColumn> result_columns();
/// Returns the cells of these columns; numbers that the run does not have are empty.
[[nodiscard]] std::vector<TableCell> result_cells(const std::string& run, const RunState& state);

/// Returns, in a few words, why some numbers of a run cannot be trusted; empty if there is no such reason.
[[nodiscard]] std::string doubts_of(const RunSummary& summary);

}  // namespace ricochet
