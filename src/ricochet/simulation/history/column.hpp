#pragma once

#include <string>
#include <utility>
#include <vector>

#include "ricochet/base/ranks.hpp"

/// @file Columns of the history and of sensors.
namespace ricochet {

/// Name of a column and how its value follows from those of the ranks, each of which holds a part of most quantities.
struct Column {
  std::string name;
  Reduction by = Reduction::sum;

  Column() = default;
  // NOLINTNEXTLINE(google-explicit-constructor): a name alone is a column that is a sum
  Column(std::string of_name, Reduction reduction = Reduction::sum) : name(std::move(of_name)), by(reduction) {}
  Column(const char* of_name, Reduction reduction = Reduction::sum) : name(of_name), by(reduction) {}
};
using Columns = std::vector<Column>;

/// Appends "name_x", "name_y", ….
void add_vector_columns(Columns& columns, const std::string& name, int dimension, Reduction by = Reduction::sum);
[[nodiscard]] std::vector<std::string> names_of(const Columns& columns);
[[nodiscard]] std::vector<Reduction> reductions_of(const Columns& columns);

}  // namespace ricochet
