#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/base/types.hpp"

/// @file Quantities of a row of a history, and their columns. A quantity is one object: its name, unit, reduction,
/// documentation, value and condition. Lists of columns, rows, reserved names and the tables of docs/results.md follow
/// from it.
namespace ricochet {

/// Columns of a quantity.
enum class ColumnComponents : char {
  one,     ///< a single one
  vector,  ///< "_x", "_y", in 3D "_z"
  axial,   ///< of a rotation: "_z" in 2D, "_x", "_y" and "_z" in 3D
  bodies,  ///< those of a vector for each body, whose label replaces BODY in the name of the quantity
};

/// Quantities that are used together.
enum class ColumnGroup : char {
  none,
  energy,   ///< energies of a state
  work,     ///< cumulative works
  balance,  ///< other terms of the energy balance
};

/// Documentation of a quantity, and the reduction of the parts that ranks hold to its value.
struct RowQuantity {
  std::string name;
  std::string unit;  ///< the kind of unit, as for keys of a case file; "steps" of a number of steps
  std::string text;  ///< its meaning, in Markdown
  ColumnComponents components = ColumnComponents::one;
  Reduction reduction = Reduction::sum;
  ColumnGroup group = ColumnGroup::none;
  std::string condition_text = {};  ///< set by `documentation_of`: the runs that have it, in words; empty: all
};

/// Runs that have a quantity.
template <class Source>
struct Condition {
  const char* words = "";                         ///< in Markdown; "": all
  bool (*holds)(const Source& source) = nullptr;  ///< null: always, or where there are bodies or pairs to have columns
};

/// RowQuantity with its value, from a source that has computed what several of them need.
template <class Source>
struct ValuedQuantity : RowQuantity {
  /// `component` is the number of an axis; for the one component of an axial vector in 2D it is 2.
  std::function<double(const Source& source, Index component)> value;
  Condition<Source> condition = {};

  [[nodiscard]] bool exists(const Source& source) const {
    return condition.holds == nullptr || condition.holds(source);
  }
};

/// Returns the documentation of quantities.
template <class Source>
[[nodiscard]] std::vector<RowQuantity> documentation_of(const std::vector<ValuedQuantity<Source>>& quantities) {
  std::vector<RowQuantity> result;
  for (const ValuedQuantity<Source>& quantity : quantities)
    result.emplace_back(quantity).condition_text = quantity.condition.words;
  return result;
}

/// Name of a column, and the reduction of the parts that ranks hold to its value.
struct Column {
  std::string name;
  Reduction reduction = Reduction::sum;
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
    if (quantity.exists(source)) add_columns(quantity, prefix, dimension, columns, bodies);
  }
}
/// Appends their values.
template <class Source>
void append_values(const std::vector<ValuedQuantity<Source>>& quantities, const Source& source, Index dimension,
                   std::vector<double>& row, std::size_t bodies = 0) {
  for (const ValuedQuantity<Source>& quantity : quantities) {
    if (!quantity.exists(source)) continue;
    const auto range = component_range(quantity.components, dimension, Index(bodies));
    for (Index k = range.first; k < range.second; ++k) row.push_back(quantity.value(source, k));
  }
}

}  // namespace ricochet
