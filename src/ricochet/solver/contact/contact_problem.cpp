#include "ricochet/solver/contact/contact_problem.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

[[noreturn]] void fail(const std::string& message) {
  throw Error(ErrorKind::invalid_input, "contact problem: " + message);
}

void require(bool holds, const char* message) {
  if (!holds) fail(message);
}

void require_size(Index found, Index expected, const char* what) {
  if (found != expected) fail(fmt::format("{} entries in {}, but {} are needed", found, what, expected));
}

}  // namespace

ContactProblem::ContactProblem(Index dimension, std::shared_ptr<const ContactOperator> w, Vector q, Vector friction)
    : contact_operator(std::move(w)), offset(std::move(q)), friction_coefficient(std::move(friction)) {
  if (dimension < 1 || dimension > 3) fail(fmt::format("{} rows per point; the number must be 1, 2 or 3", dimension));
  if (offset.size() % dimension != 0) {
    fail(fmt::format("q has {} entries, which is not a multiple of the {} rows of a point", offset.size(), dimension));
  }
  for (Index row = 0; row <= offset.size(); row += dimension) row_offset.push_back(row);
  validate();
}

ContactProblem::ContactProblem(Index dimension, Matrix w, Vector q, double friction)
    : ContactProblem(dimension, make_dense_operator(std::move(w)), q,
                     Vector::Constant(dimension > 0 ? q.size() / dimension : 0, friction)) {}

void ContactProblem::validate() const {
  require(contact_operator != nullptr, "the operator W is missing");
  require(!row_offset.empty() && row_offset.front() == 0, "the first point must begin with row 0");
  for (std::size_t i = 0; i + 1 < row_offset.size(); ++i) {
    const Index size = row_offset[i + 1] - row_offset[i];
    if (size < 1 || size > 3) fail(fmt::format("point {} has {} rows; the number must be 1, 2 or 3", i, size));
  }
  require_size(offset.size(), row_offset.back(), "q");
  if (contact_operator->rows() != row_offset.back())
    fail(fmt::format("W has {} rows, but the points have {}", contact_operator->rows(), row_offset.back()));
  require_size(friction_coefficient.size(), points(), "the friction coefficients");
  if (friction_bound.size() > 0) require_size(friction_bound.size(), points(), "the friction bounds");
  if (offset_rounding.size() > 0) require_size(offset_rounding.size(), rows(), "the rounding of q");
  if (!eligible.empty()) require_size(Index(eligible.size()), points(), "the list of eligible points");
  const auto admissible = [](double value) { return value >= 0.0 && std::isfinite(value); };
  for (Index i = 0; i < points(); ++i) {
    if (!admissible(friction_coefficient[i]))
      fail(fmt::format("the friction coefficient of point {} is {}; it must be zero or positive, and finite", i,
                       friction_coefficient[i]));
    if (!admissible(bound(i)))
      fail(fmt::format("the friction bound of point {} is {}; it must be zero (none) or positive, and finite", i,
                       bound(i)));
  }
}

bool are_first_rows(const std::vector<Index>& row_offset, const std::vector<Index>& rows, bool distinct) {
  const auto out_of_order = [&](Index one, Index next) { return distinct ? one >= next : one > next; };
  if (std::adjacent_find(rows.begin(), rows.end(), out_of_order) != rows.end()) return false;
  return std::ranges::all_of(
      rows, [&](Index row) { return std::binary_search(row_offset.begin(), row_offset.end() - 1, row); });
}

}  // namespace ricochet
