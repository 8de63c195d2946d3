#include "ricochet/solver/condensed_contact.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/linear_algebra/dense_factor.hpp"

namespace ricochet {

CondensedContact::CondensedContact(const SemidiscreteProblem& problem, const std::vector<int>& position,
                                   const Matrix& trailing_factor, double scale)
    : problem_(problem), scale_(scale), friction_(problem.contact.has_friction()) {
  number_rows();
  fill_columns(position, trailing_factor);
  coefficient_ = problem.contact.friction_coefficient;
  bound_ = scale * problem.contact.friction_bound;
  contact_.friction_coefficient = coefficient_;
  contact_.friction_bound = bound_;
  contact_.reaction_scale = scale;
  contact_.offset.setZero(contact_.first.back());
  solver_ = make_contact_solver();
  solver_->analyse(contact_);
}

void CondensedContact::number_rows() {
  const ContactBoundary& contact = problem_.contact;
  contact_.first.assign(1, 0);
  for (Index i = 0; i < contact.size(); ++i) {
    const bool has_friction = contact.friction_coefficient[i] > 0.0 || contact.friction_bound[i] > 0.0;
    contact_.first.push_back(contact_.first.back() + (has_friction ? problem_.dimension : 1));
  }
}

void CondensedContact::fill_columns(const std::vector<int>& position, const Matrix& trailing_factor) {
  const ContactBoundary& contact = problem_.contact;
  columns_.setZero(trailing_factor.rows(), contact_.first.back());
  std::vector<Eigen::Triplet<double>> supported;
  const std::vector<Index>& supported_dofs = problem_.supports.dofs();
  const auto enter = [&](const SparseRowMatrix& matrix, Index row_of_matrix, Index row) {
    for (SparseRowMatrix::InnerIterator entry(matrix, row_of_matrix); entry; ++entry) {
      const int at = position[static_cast<std::size_t>(entry.col())];
      if (at >= 0) columns_(at, row) = entry.value();
      const auto held = std::lower_bound(supported_dofs.begin(), supported_dofs.end(), static_cast<Index>(entry.col()));
      if (held == supported_dofs.end() || *held != entry.col()) continue;
      supported.emplace_back(static_cast<int>(row), static_cast<int>(held - supported_dofs.begin()), entry.value());
    }
  };
  for (Index i = 0; i < contact.size(); ++i) {
    const Index row = contact_.first[static_cast<std::size_t>(i)];
    enter(contact.gap_operator, i, row);
    for (Index k = 1; row + k < contact_.first[static_cast<std::size_t>(i + 1)]; ++k) {
      enter(contact.tangential_trace, i * (problem_.dimension - 1) + k - 1, row + k);
    }
  }
  supported_.resize(contact_.first.back(), problem_.supports.size());
  supported_.setFromTriplets(supported.begin(), supported.end());
  if (columns_.size() > 0) solve_lower_triangular(trailing_factor, columns_);
  Matrix w = gram_matrix(columns_);
  hold_directions_without_trace(w);
  contact_.contact_operator = make_dense_operator(std::move(w));
}

/// Where B_T has no trace in a direction (a support holds the body there), any positive diagonal keeps W definite and
/// makes the friction along it zero.
void CondensedContact::hold_directions_without_trace(Matrix& w) const {
  for (Index i = 0; i < problem_.contact.size(); ++i) {
    const Index row = contact_.first[static_cast<std::size_t>(i)];
    for (Index k = row + 1; k < contact_.first[static_cast<std::size_t>(i + 1)]; ++k) {
      if (w(k, k) == 0.0) w(k, k) = w(row, row);
    }
  }
}

void CondensedContact::find_offsets(const Stage& stage, const Eigen::Ref<Vector>& trailing) {
  contact_.offset.noalias() = columns_.transpose() * trailing;
  if (supported_.nonZeros() > 0) contact_.offset.noalias() += supported_ * stage.prescribed;
  contact_.offset_rounding.resize(contact_.offset.size());
  const Index tangents = problem_.dimension - 1;
  for (Index i = 0; i < problem_.contact.size(); ++i) {
    const Index row = contact_.first[static_cast<std::size_t>(i)];
    const Index count = contact_.first[static_cast<std::size_t>(i + 1)] - row - 1;
    contact_.offset[row] += stage.gap_offset[i] / stage.gap_factor;
    contact_.offset_rounding[row] = stage.gap_offset_rounding[i] / stage.gap_factor;
    if (count == 0) continue;
    if (stage.slip_offset.size() == 0) {
      contact_.offset_rounding.segment(row + 1, count).setZero();
      continue;
    }
    contact_.offset.segment(row + 1, count) += stage.slip_offset.segment(i * tangents, tangents) / stage.slip_factor;
    contact_.offset_rounding.segment(row + 1, count).setConstant(stage.slip_offset_rounding[i] / stage.slip_factor);
  }
}

void CondensedContact::solve(const Stage& stage, Eigen::Ref<Vector> trailing, StageSolution& solution) {
  const Index points = problem_.contact.size();
  solution.normal_reaction.setZero(points);
  if (friction_) solution.tangential_reaction.setZero(points * (problem_.dimension - 1));
  solution.contact_status.assign(static_cast<std::size_t>(points), ContactStatus::open);
  solution.iterations = 0;
  if (std::none_of(stage.eligible.begin(), stage.eligible.end(), [](char e) { return e != 0; })) return;
  if (stage.compliance.size() > 0)
    throw Error(ErrorKind::invalid_input, "contact compliance is not available in this version");
  find_offsets(stage, trailing);
  choose_friction(stage);
  solve_contact();
  const Vector& reaction = contact_solution_.reaction;
  for (Index row = 0; row < reaction.size(); ++row) {
    if (reaction[row] != 0.0) trailing += reaction[row] * columns_.col(row);
  }
  solution.iterations = contact_solution_.iterations;
  solution.contact_status = contact_solution_.status;
  const Index tangents = problem_.dimension - 1;
  for (Index i = 0; i < points; ++i) {
    const Index row = contact_.first[static_cast<std::size_t>(i)];
    solution.normal_reaction[i] = reaction[row] / scale_;
    for (Index k = 1; row + k < contact_.first[static_cast<std::size_t>(i + 1)]; ++k)
      solution.tangential_reaction[i * tangents + k - 1] = -reaction[row + k] / scale_;
  }
}

/// With friction in stages that have a slip rate, and at points where they do not leave it out.
void CondensedContact::choose_friction(const Stage& stage) {
  contact_.eligible = stage.eligible;
  if (!friction_) return;
  contact_.friction_coefficient = coefficient_;
  contact_.friction_bound = bound_;
  for (Index i = 0; i < coefficient_.size(); ++i) {
    const bool left_out = !stage.frictionless.empty() && stage.frictionless[static_cast<std::size_t>(i)] != 0;
    if (stage.slip_offset.size() > 0 && !left_out) continue;
    contact_.friction_coefficient[i] = 0.0;
    contact_.friction_bound[i] = 0.0;
  }
}

void CondensedContact::solve_contact() {
  const Timer timer;
  solver_->solve(contact_, {}, contact_solution_);
  solver_seconds_ += timer.seconds();
  if (observer_) observer_(contact_, contact_solution_);
  if (!contact_solution_.solved()) throw_not_solved();
}

void CondensedContact::throw_not_solved() const {
  const bool tresca = ((bound_.array() > 0.0) && (coefficient_.array() == 0.0)).any();
  const char* const advice = tresca ? "; with a friction_bound alone a step need not have a solution: give a friction "
                                      "coefficient beside it"
                                    : "";
  throw Error(
      ErrorKind::not_converged,
      fmt::format("the contact problem{} of {} points was not solved in {} iterations (relative residual {:.3g}): "
                  "{}{}",
                  friction_ ? " with friction" : "", problem_.contact.size(), contact_solution_.iterations,
                  contact_solution_.residual, contact_solution_.reason, advice));
}

}  // namespace ricochet
