#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/base/types.hpp"

/// @file Quantities of a row of a history, and their columns. A quantity is one object: its name, unit, reduction,
/// documentation and value. Lists of columns, rows, reserved names and the tables of docs/results.md follow from it.
namespace ricochet {

/// Columns of a quantity.
enum class ColumnComponents : char {
  one,     ///< a single one
  vector,  ///< "_x", "_y", in 3D "_z"
  axial,   ///< of a rotation: "_z" in 2D, "_x", "_y" and "_z" in 3D
  bodies,  ///< those of a vector for each body, whose label replaces BODY in the name
};

/// Quantities that are used together.
enum class ColumnGroup : char {
  none,
  energy,   ///< energies of a state
  work,     ///< cumulative works
  balance,  ///< other terms of the energy balance
};

/// Documentation of a quantity and how its value follows from those of the ranks.
struct RowQuantity {
  std::string name;
  std::string unit;  ///< the kind of unit, as for keys of a case file
  std::string text;  ///< its meaning, in Markdown
  ColumnComponents components = ColumnComponents::one;
  Reduction by = Reduction::sum;
  std::string where = {};  ///< runs that have it, in words; empty: all
  ColumnGroup group = ColumnGroup::none;
};

/// RowQuantity with its value, from a source that has computed what several of them need.
template <class Source>
struct ValuedQuantity : RowQuantity {
  /// `component` counts axes; that of an axial vector in 2D is 2.
  std::function<double(const Source& source, Index component)> value;
  bool (*exists)(const Source& source) = nullptr;  ///< null: always
};

/// Name of a column and how its value follows from those of the ranks, each of which holds a part of most quantities.
struct Column {
  std::string name;
  Reduction by = Reduction::sum;
};
using Columns = std::vector<Column>;

[[nodiscard]] std::vector<std::string> names_of(const Columns& columns);
[[nodiscard]] std::vector<Reduction> reductions_of(const Columns& columns);

/// Range of the components of a quantity, the last one excluded.
[[nodiscard]] inline std::pair<Index, Index> component_range(ColumnComponents components, Index dimension,
                                                             Index bodies = 1) {
  if (components == ColumnComponents::one) return {0, 1};
  if (components == ColumnComponents::axial) return {dimension == 2 ? 2 : 0, 3};
  return {0, dimension * (components == ColumnComponents::bodies ? bodies : 1)};
}

/// Appends the columns of a quantity.
void add_columns(const RowQuantity& quantity, const std::string& prefix, int dimension, Columns& columns,
                 const std::vector<std::string>& bodies = {});
/// Appends those of the quantities that exist.
template <class Source>
void add_columns(const std::vector<ValuedQuantity<Source>>& quantities, const Source& source, const std::string& prefix,
                 int dimension, Columns& columns, const std::vector<std::string>& bodies = {}) {
  for (const ValuedQuantity<Source>& quantity : quantities) {
    if (quantity.exists == nullptr || quantity.exists(source))
      add_columns(quantity, prefix, dimension, columns, bodies);
  }
}
/// Appends their values.
template <class Source>
void append_values(const std::vector<ValuedQuantity<Source>>& quantities, const Source& source, Index dimension,
                   std::vector<double>& row, std::size_t bodies = 0) {
  for (const ValuedQuantity<Source>& quantity : quantities) {
    if (quantity.exists != nullptr && !quantity.exists(source)) continue;
    const auto range = component_range(quantity.components, dimension, static_cast<Index>(bodies));
    for (Index k = range.first; k < range.second; ++k) row.push_back(quantity.value(source, k));
  }
}

}  // namespace ricochet
