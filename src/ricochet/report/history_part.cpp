#include "ricochet/report/history_part.hpp"

#include <algorithm>

namespace ricochet {

namespace {

std::vector<double> all_rows(const HistoryTable& history) {
  std::vector<double> table;
  for (const std::string& name : history.names) {
    const std::vector<double>& column = history.columns.at(name);
    table.insert(table.end(), column.begin(), column.end());
  }
  return table;
}

}  // namespace

std::vector<double> thinned(const std::vector<double>& column, std::size_t rows) {
  std::vector<double> result;
  for (std::size_t begin = 0; begin < column.size(); begin += rows) {
    const auto first = column.begin() + std::ptrdiff_t(begin);
    const auto last = column.begin() + std::ptrdiff_t(std::min(begin + rows, column.size()));
    auto [least, largest] = std::minmax_element(first, last);
    if (largest < least) std::swap(least, largest);
    result.push_back(*least);
    result.push_back(*largest);
  }
  return result;
}

HistoryPart pack_history(const HistoryTable& history, std::size_t most_bytes, PackedArrays& arrays) {
  const auto columns = Index(history.names.size());
  const auto rows = Index(history.columns.at(history.names.front()).size());
  HistoryPart part;
  // Doubles hardly compress.
  std::vector<double> table = all_rows(history);
  if (base64_size(8 * table.size()) < 4 * most_bytes) {
    PackedArrays alone;
    part.table = alone.add_reals(table, columns, rows);
    if (alone.page_bytes() <= most_bytes) {
      part.table = arrays.add_reals(table, columns, rows);
      return part;
    }
  }
  const auto pairs = std::max<Index>(Index(most_bytes) * 3 / 4 / (16 * columns), 1);
  part.rows_per_pair = std::max<Index>((rows + pairs - 1) / pairs, 3);
  table.clear();
  for (const std::string& name : history.names) {
    const std::vector<double> column = thinned(history.columns.at(name), std::size_t(part.rows_per_pair));
    table.insert(table.end(), column.begin(), column.end());
  }
  part.table = arrays.add_reals(table, columns, Index(table.size()) / columns);
  return part;
}

}  // namespace ricochet
