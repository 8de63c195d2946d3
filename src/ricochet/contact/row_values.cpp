#include "ricochet/contact/row_values.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

using Values = Eigen::Map<const Eigen::VectorXd>;

/// Values of rows first … last − 1.
Values values_between(const SparseRowMatrix& rows, Index first, Index last) {
  const Index begin = rows.outerIndexPtr()[first];
  return {rows.valuePtr() + begin, rows.outerIndexPtr()[last] - begin};
}

bool reach_the_same(const SparseRowMatrix& one, const SparseRowMatrix& other, Index first, Index last) {
  const Index begin = one.outerIndexPtr()[first], count = one.outerIndexPtr()[last] - begin;
  if (other.outerIndexPtr()[last] - other.outerIndexPtr()[first] != count) return false;
  const int* const columns = one.innerIndexPtr() + begin;
  return std::equal(columns, columns + count, other.innerIndexPtr() + other.outerIndexPtr()[first]);
}

/// Largest value of a row, and largest difference between two rows.
struct RowSizes {
  double size = 0.0, difference = 0.0;
};
RowSizes compare_rows(const SparseRowMatrix& from, const SparseRowMatrix& to, Index row) {
  RowSizes result;
  SparseRowMatrix::InnerIterator one(from, row), other(to, row);
  while (one || other) {
    const bool has_one = one && (!other || one.col() <= other.col()),
               has_other = other && (!one || other.col() <= one.col());
    const double before = has_one ? one.value() : 0.0, after = has_other ? other.value() : 0.0;
    result.size = std::max(result.size, std::abs(before));
    result.difference = std::max(result.difference, std::abs(after - before));
    if (has_one) ++one;
    if (has_other) ++other;
  }
  return result;
}

double change_between(const SparseRowMatrix& from, const SparseRowMatrix& to, Index first, Index last) {
  RowSizes sizes;
  if (reach_the_same(from, to, first, last)) {
    const Values before = values_between(from, first, last), after = values_between(to, first, last);
    if (before.size() > 0) sizes = {before.lpNorm<Eigen::Infinity>(), (after - before).lpNorm<Eigen::Infinity>()};
    first = last;
  }
  for (Index row = first; row < last; ++row) {
    const RowSizes of_row = compare_rows(from, to, row);
    sizes.size = std::max(sizes.size, of_row.size);
    sizes.difference = std::max(sizes.difference, of_row.difference);
  }
  if (sizes.size > 0.0) return sizes.difference / sizes.size;
  return sizes.difference > 0.0 ? 1.0 : 0.0;
}

}  // namespace

Index row_value_count(const ContactRows& rows) {
  return rows.gap_operator.nonZeros() + rows.tangential_trace.nonZeros();
}

Vector row_values(const ContactRows& rows) {
  Vector result(row_value_count(rows));
  const SparseRowMatrix &gap = rows.gap_operator, &slip = rows.tangential_trace;
  result << values_between(gap, 0, gap.rows()), values_between(slip, 0, slip.rows());
  return result;
}

bool set_row_values(const Vector& values, ContactRows& rows) {
  SparseRowMatrix &gap = rows.gap_operator, &slip = rows.tangential_trace;
  const Values gap_values(values.data(), gap.nonZeros()), slip_values(values.data() + gap.nonZeros(), slip.nonZeros());
  if (gap_values == values_between(gap, 0, gap.rows()) && slip_values == values_between(slip, 0, slip.rows()))
    return false;
  std::copy_n(gap_values.data(), gap_values.size(), gap.valuePtr());
  std::copy_n(slip_values.data(), slip_values.size(), slip.valuePtr());
  return true;
}

double change_of_rows(const ContactRows& from, const ContactRows& to, Index point) {
  const Index tangents = from.dimension() - 1;
  return std::max(change_between(from.gap_operator, to.gap_operator, point, point + 1),
                  change_between(from.tangential_trace, to.tangential_trace, point * tangents, (point + 1) * tangents));
}

void PointCopier::copy_rows(const SparseRowMatrix& from, SparseRowMatrix& to, Index first, Index last,
                            RowWriter& writer) {
  if (reach_the_same(from, to, first, last)) {
    const Values values = values_between(from, first, last);
    std::copy_n(values.data(), values.size(), to.valuePtr() + to.outerIndexPtr()[first]);
    return;
  }
  for (Index row = first; row < last; ++row) {
    entries_.clear();
    for (SparseRowMatrix::InnerIterator entry(from, row); entry; ++entry)
      entries_.emplace_back(entry.col(), entry.value());
    writer.set(row, entries_);
  }
}

void PointCopier::copy(const ContactRows& from, ContactRows& to, Index point) {
  const Index tangents = from.dimension() - 1, first = point * tangents, last = first + tangents;
  copy_rows(from.gap_operator, to.gap_operator, point, point + 1, gap_);
  copy_rows(from.tangential_trace, to.tangential_trace, first, last, slip_);
  to.normals.col(point) = from.normals.col(point);
  to.tangents[std::size_t(point)] = from.tangents[std::size_t(point)];
  for (Index k = first; k < last; ++k) to.slips[std::size_t(k)] = from.slips[std::size_t(k)];
}

void PointCopier::finish(ContactRows& to) {
  changed_.resize(std::size_t(to.tangential_trace.rows() + to.gap_operator.rows()));
  gap_.write(to.gap_operator, changed_);
  slip_.write(to.tangential_trace, changed_);
}

}  // namespace ricochet
