#include "ricochet/contact/row_values.hpp"

#include <algorithm>
#include <cmath>

namespace ricochet {

namespace {

using Values = Eigen::Map<const Eigen::VectorXd>;

/// Of rows first … last − 1.
Values values_between(const SparseRowMatrix& rows, Index first, Index last) {
  const Index begin = rows.outerIndexPtr()[first];
  return {rows.valuePtr() + begin, rows.outerIndexPtr()[last] - begin};
}

double change_between(const SparseRowMatrix& from, const SparseRowMatrix& to, Index first, Index last) {
  const Values before = values_between(from, first, last), after = values_between(to, first, last);
  if (before.size() == 0) return 0.0;
  const double size = before.lpNorm<Eigen::Infinity>(), change = (after - before).lpNorm<Eigen::Infinity>();
  if (size > 0.0) return change / size;
  return change > 0.0 ? 1.0 : 0.0;
}

void copy_between(const SparseRowMatrix& from, SparseRowMatrix& to, Index first, Index last) {
  const Values values = values_between(from, first, last);
  std::copy_n(values.data(), values.size(), to.valuePtr() + to.outerIndexPtr()[first]);
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

bool take_row_values(const Vector& values, ContactRows& rows) {
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

void copy_point(const ContactRows& from, ContactRows& to, Index point) {
  const Index tangents = from.dimension() - 1, first = point * tangents, last = first + tangents;
  copy_between(from.gap_operator, to.gap_operator, point, point + 1);
  copy_between(from.tangential_trace, to.tangential_trace, first, last);
  to.normals.col(point) = from.normals.col(point);
  to.tangents[static_cast<std::size_t>(point)] = from.tangents[static_cast<std::size_t>(point)];
  for (Index k = first; k < last; ++k) to.slips[static_cast<std::size_t>(k)] = from.slips[static_cast<std::size_t>(k)];
}

}  // namespace ricochet
