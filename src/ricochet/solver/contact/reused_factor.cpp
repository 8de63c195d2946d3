#include "ricochet/solver/contact/reused_factor.hpp"

#include <algorithm>

#include "ricochet/linear_algebra/dense_kernels.hpp"

namespace ricochet {

void assemble_contact_matrix(const ContactSystem& system, const std::vector<ContactUnknown>& unknowns, Vector& column,
                             Matrix& matrix) {
  const Matrix& w = *system.dense();
  const auto count = Index(unknowns.size());
  if (matrix.rows() != count) matrix.resize(count, count);
  for (Index j = 0; j < count; ++j) {
    const ContactUnknown& unknown = unknowns[std::size_t(j)];
    column.setZero(w.rows());
    add_columns(w.rows(), unknown.size, w.data() + unknown.row * w.rows(), w.rows(), unknown.trial.data(),
                column.data());
    double* to = matrix.data() + j * count;
    for (const ContactUnknown& row : unknowns) *to++ = test_motion(row, column.data());
    matrix(j, j) += unknown.diagonal;
  }
}

bool ReusedFactor::compute(const Matrix& matrix, const std::vector<ContactUnknown>& unknowns) {
  unknowns_ = unknowns;
  is_factored_ = factor_.compute(matrix);
  if (!is_factored_) unknowns_.clear();
  return is_factored_;
}

bool ReusedFactor::map_rows(const ContactSystem& system, const std::vector<ContactUnknown>& unknowns) {
  for (ContactUnknown& unknown : unknowns_) {
    unknown.row = system.system_row(unknown.problem_row);
    // There are no tangents if a stage leaves friction out.
    if (unknown.row < 0 || system.system_row(unknown.problem_row + unknown.size - 1) < 0) return false;
  }
  if (!is_factored_) {
    Matrix matrix;
    assemble_contact_matrix(system, unknowns_, motion_, matrix);
    is_factored_ = factor_.compute(matrix);
    if (!is_factored_) return false;
  }
  present_ = unknowns;
  same_ = present_ == unknowns_;
  compliance_.assign(std::size_t(system.rows()), 1.0);
  for (const ContactPoint& point : system.points()) {
    for (Index k = 0; k < point.size; ++k) compliance_[std::size_t(point.row + k)] = 1.0 / point.diagonal;
  }
  return true;
}

void ReusedFactor::persist(const SnapshotVisitor& visit, const std::vector<Index>& row_offset) {
  if (visit.loads()) {
    is_factored_ = false;
    unknowns_.clear();
  }
  std::vector<Index> rows, sizes;
  for (const ContactUnknown& unknown : unknowns_) {
    rows.push_back(unknown.problem_row);
    sizes.push_back(unknown.size);
  }
  visit("unknowns.rows", rows);
  visit("unknowns.sizes", sizes, {1, 3});
  if (visit.loads()) {
    visit.require(are_first_rows(row_offset, rows, false) && sizes.size() == rows.size(), "unknowns",
                  "do not belong to points of this problem");
    unknowns_.assign(rows.size(), {});
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto point = std::ranges::lower_bound(row_offset, rows[i]);
      visit.require(sizes[i] <= point[1] - point[0], "unknowns", "have more rows than their points");
      unknowns_[i].problem_row = rows[i];
      unknowns_[i].size = sizes[i];
    }
  }
  visit.numbers("unknowns.values", unknowns_);
}

/// Unknowns are in the order of their points.
bool ReusedFactor::keeps_row(Index problem_row) const {
  const auto found = std::ranges::lower_bound(unknowns_, problem_row, {}, &ContactUnknown::problem_row);
  return found != unknowns_.end() && found->problem_row == problem_row;
}

void ReusedFactor::apply(const Vector& right, Vector& z) const {
  if (same_) {
    factor_.solve(right, z);
    return;
  }
  const auto add = [](const ContactUnknown& unknown, const std::array<double, 3>& direction, double factor,
                      Vector& to) {
    for (Index k = 0; k < unknown.size; ++k) to[unknown.row + k] += factor * direction[std::size_t(k)];
  };
  motion_.setZero(Index(compliance_.size()));
  for (std::size_t i = 0; i < present_.size(); ++i) add(present_[i], present_[i].test, right[Index(i)], motion_);
  earlier_right_.setZero(Index(unknowns_.size()));
  for (std::size_t j = 0; j < unknowns_.size(); ++j) {
    const ContactUnknown& unknown = unknowns_[j];
    earlier_right_[Index(j)] = test_motion(unknown, motion_.data());
  }
  // The tests of a point are orthonormal: the part orthogonal to them remains.
  for (std::size_t j = 0; j < unknowns_.size(); ++j) {
    add(unknowns_[j], unknowns_[j].test, -earlier_right_[Index(j)], motion_);
  }
  factor_.solve(earlier_right_, earlier_solution_);
  reaction_.resize(motion_.size());
  for (Index row = 0; row < motion_.size(); ++row) reaction_[row] = compliance_[std::size_t(row)] * motion_[row];
  for (std::size_t j = 0; j < unknowns_.size(); ++j) {
    add(unknowns_[j], unknowns_[j].trial, earlier_solution_[Index(j)], reaction_);
  }
  z.resize(right.size());
  for (std::size_t i = 0; i < present_.size(); ++i) z[Index(i)] = test_motion(present_[i], reaction_.data());
}

}  // namespace ricochet
