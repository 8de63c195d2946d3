#pragma once

#include <string>
#include <vector>

#include "ricochet/study/study_files.hpp"
#include "ricochet/study/table.hpp"

/// @file Columns of observed orders, and notes on orders that are meaningless.
namespace ricochet {

/// Inserts after each column of errors a column of its orders along the key of the study; `notes` receives their
/// definition, and which of them are meaningless or biased.
void add_order_columns(const Study& study, ResultTable& table, std::vector<std::string>& notes);

/// Returns which of these orders, observed along one key, show that the error no longer decreases, as its remainder
/// does not depend on this key. Smaller values of `key` are finer, as they always are for a step, unless most orders
/// are negative, as along a number of cells.
[[nodiscard]] std::vector<bool> find_stagnant_orders(const std::string& key, const std::vector<double>& orders);

}  // namespace ricochet
