#pragma once

#include <string>
#include <vector>

#include "ricochet/study/study_files.hpp"
#include "ricochet/study/table.hpp"

/// @file Columns of observed orders, and what is to be said of orders that are none.
namespace ricochet {

/// Behind each column of errors that of its orders along the key of the study; `notes` gets what they are, which of
/// them mean nothing, and which are biased.
void add_order_columns(const Study& study, ResultTable& table, std::vector<std::string>& notes);

/// Which of these orders, found along one key, say that the error no longer falls: what is left of it does not come
/// from this key. Smaller values of `key` are the finer ones, unless most orders say otherwise, as those along a number
/// of cells do; of a step they always are.
[[nodiscard]] std::vector<bool> find_idle_orders(const std::string& key, const std::vector<double>& orders);

}  // namespace ricochet
