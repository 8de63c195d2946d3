#include "ricochet/contact/row_writer.hpp"

#include <algorithm>

namespace ricochet {

void RowWriter::set(Index row, const Entries& entries) {
  const std::size_t begin = entries_.size();
  entries_.insert(entries_.end(), entries.begin(), entries.end());
  rows_.push_back({row, begin, entries_.size()});
}

bool RowWriter::is_same(const SparseRowMatrix& matrix, const Row& row) const {
  std::size_t at = row.begin;
  for (SparseRowMatrix::InnerIterator entry(matrix, row.number); entry; ++entry, ++at) {
    if (at == row.end || entries_[at].first != entry.col() || entries_[at].second != entry.value()) return false;
  }
  return at == row.end;
}

bool RowWriter::write(SparseRowMatrix& matrix, std::vector<char>& changed) {
  std::erase_if(rows_, [&](const Row& row) { return is_same(matrix, row); });
  const bool any = !rows_.empty();
  if (any) {
    std::ranges::sort(rows_, {}, &Row::number);
    std::size_t count = std::size_t(matrix.nonZeros());
    for (const Row& row : rows_) {
      count += row.end - row.begin;
      count -= std::size_t(matrix.outerIndexPtr()[row.number + 1] - matrix.outerIndexPtr()[row.number]);
      changed[std::size_t(row.number)] = 1;
    }
    next_.resize(matrix.rows(), matrix.cols());
    next_.resizeNonZeros(Index(count));
    auto row = rows_.begin();
    Index at = 0;
    const auto put = [&](Index column, double value) {
      next_.innerIndexPtr()[at] = int(column);
      next_.valuePtr()[at++] = value;
    };
    for (Index number = 0; number < matrix.rows(); ++number) {
      next_.outerIndexPtr()[number] = int(at);
      if (row != rows_.end() && row->number == number) {
        for (std::size_t k = row->begin; k < row->end; ++k) put(entries_[k].first, entries_[k].second);
        ++row;
        continue;
      }
      for (SparseRowMatrix::InnerIterator entry(matrix, number); entry; ++entry) put(entry.col(), entry.value());
    }
    next_.outerIndexPtr()[matrix.rows()] = int(at);
    std::swap(matrix, next_);
  }
  rows_.clear();
  entries_.clear();
  return any;
}

}  // namespace ricochet
