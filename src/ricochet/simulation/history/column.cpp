#include "ricochet/simulation/history/column.hpp"

namespace ricochet {

void add_columns(const RowQuantity& quantity, const std::string& prefix, int dimension, Columns& columns,
                 const std::vector<std::string>& bodies) {
  if (quantity.components == ColumnComponents::bodies) {
    RowQuantity own = quantity;
    own.components = ColumnComponents::vector;
    for (const std::string& body : bodies) {
      own.name = quantity.name;
      own.name.replace(own.name.find("BODY"), 4, body);
      add_columns(own, prefix, dimension, columns);
    }
    return;
  }
  const auto range = component_range(quantity.components, dimension);
  for (Index k = range.first; k < range.second; ++k) {
    std::string name = prefix + quantity.name;
    if (quantity.components != ColumnComponents::one) name += std::string("_") + "xyz"[k];
    columns.push_back({std::move(name), quantity.reduction});
  }
}

std::vector<std::string> names_of(const Columns& columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) names.push_back(column.name);
  return names;
}

std::vector<Reduction> reductions_of(const Columns& columns) {
  std::vector<Reduction> result;
  for (const Column& column : columns) result.push_back(column.reduction);
  return result;
}

}  // namespace ricochet
