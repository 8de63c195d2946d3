#include "ricochet/solver/condensed_contact.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/linear_algebra/dense_factor.hpp"

namespace ricochet {

CondensedContact::CondensedContact(const SemidiscreteProblem& problem, const std::vector<int>& position,
                                   const Matrix& trailing_factor, double scale)
    : problem_(problem), scale_(scale), friction_(problem.contact.has_friction()) {
  number_rows();
  fill_columns(position, trailing_factor);
  coefficient_ = problem.contact.friction_coefficient;
  bound_ = scale * problem.contact.friction_bound;
}

void CondensedContact::number_rows() {
  const ContactBoundary& contact = problem_.contact;
  first_.assign(1, 0);
  for (Index i = 0; i < contact.size(); ++i) {
    const bool has_friction = contact.friction_coefficient[i] > 0.0 || contact.friction_bound[i] > 0.0;
    first_.push_back(first_.back() + (has_friction ? problem_.dimension : 1));
  }
}

void CondensedContact::fill_columns(const std::vector<int>& position, const Matrix& trailing_factor) {
  const ContactBoundary& contact = problem_.contact;
  columns_.setZero(trailing_factor.rows(), first_.back());
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
    const Index row = first_[static_cast<std::size_t>(i)];
    enter(contact.gap_operator, i, row);
    for (Index k = 1; row + k < first_[static_cast<std::size_t>(i + 1)]; ++k) {
      enter(contact.tangential_trace, i * (problem_.dimension - 1) + k - 1, row + k);
    }
  }
  supported_.resize(first_.back(), problem_.supports.size());
  supported_.setFromTriplets(supported.begin(), supported.end());
  operator_.setZero(first_.back(), first_.back());
  if (columns_.size() == 0) return;  // no contact, or none of its dofs in this stage
  solve_lower_triangular(trailing_factor, columns_);
  operator_ = gram_matrix(columns_);
  hold_directions_without_trace();
}

/// Where B_T has no trace in a direction (a support holds the body there), any positive diagonal keeps W definite and
/// makes the friction along it zero.
void CondensedContact::hold_directions_without_trace() {
  for (Index i = 0; i < problem_.contact.size(); ++i) {
    const Index row = first_[static_cast<std::size_t>(i)];
    for (Index k = row + 1; k < first_[static_cast<std::size_t>(i + 1)]; ++k) {
      if (operator_(k, k) == 0.0) operator_(k, k) = operator_(row, row);
    }
  }
}

void CondensedContact::find_offsets(const Stage& stage, const Eigen::Ref<Vector>& trailing) {
  offset_.noalias() = columns_.transpose() * trailing;
  if (supported_.nonZeros() > 0) offset_.noalias() += supported_ * stage.prescribed;
  offset_rounding_.resize(offset_.size());
  const Index tangents = problem_.dimension - 1;
  for (Index i = 0; i < problem_.contact.size(); ++i) {
    const Index row = first_[static_cast<std::size_t>(i)];
    const Index count = first_[static_cast<std::size_t>(i + 1)] - row - 1;
    offset_[row] += stage.gap_offset[i] / stage.gap_factor;
    offset_rounding_[row] = stage.gap_offset_rounding[i] / stage.gap_factor;
    if (count == 0) continue;
    if (stage.slip_offset.size() == 0) {
      offset_rounding_.segment(row + 1, count).setZero();
      continue;
    }
    offset_.segment(row + 1, count) += stage.slip_offset.segment(i * tangents, tangents) / stage.slip_factor;
    offset_rounding_.segment(row + 1, count).setConstant(stage.slip_offset_rounding[i] / stage.slip_factor);
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
  friction_ ? solve_with_friction(stage, solution) : solve_frictionless(stage, solution);
  const Vector& reaction = friction_ ? coulomb_solution_.reaction : frictionless_.reaction;
  for (Index row = 0; row < reaction.size(); ++row) {
    if (reaction[row] != 0.0) trailing += reaction[row] * columns_.col(row);
  }
}

void CondensedContact::solve_frictionless(const Stage& stage, StageSolution& solution) {
  active_set_.solve({&operator_, &offset_, &offset_rounding_, &stage.eligible}, frictionless_);
  if (!frictionless_.solved) {
    // Conditions that depend on one another (an unstable space of multipliers) leave W singular: reactions are then not
    // unique, and Gauss-Seidel still finds some.
    solve_coulomb(stage);
    frictionless_.reaction = coulomb_solution_.reaction;
    frictionless_.iterations += coulomb_solution_.iterations;
  }
  solution.iterations = frictionless_.iterations;
  solution.normal_reaction = frictionless_.reaction / scale_;
  for (Index i = 0; i < problem_.contact.size(); ++i) {
    if (solution.normal_reaction[i] > 0.0) solution.contact_status[static_cast<std::size_t>(i)] = ContactStatus::closed;
  }
}

/// With friction in stages that have a slip rate, and at points where they do not leave it out.
void CondensedContact::solve_coulomb(const Stage& stage) {
  stage_coefficient_ = coefficient_;
  stage_bound_ = bound_;
  for (Index i = 0; i < coefficient_.size(); ++i) {
    const bool left_out = !stage.frictionless.empty() && stage.frictionless[static_cast<std::size_t>(i)] != 0;
    if (stage.slip_offset.size() > 0 && !left_out) continue;
    stage_coefficient_[i] = 0.0;
    stage_bound_[i] = 0.0;
  }
  coulomb_.solve(
      {&operator_, &offset_, &offset_rounding_, &first_, &stage.eligible, &stage_coefficient_, &stage_bound_},
      coulomb_solution_);
  if (coulomb_solution_.solved) return;
  const bool tresca = ((bound_.array() > 0.0) && (coefficient_.array() == 0.0)).any();
  const char* const advice = tresca ? "; with a friction_bound alone a step need not have a solution: give a friction "
                                      "coefficient beside it"
                                    : "";
  throw Error(
      ErrorKind::not_converged,
      fmt::format("the contact problem{} of {} points was not solved in {} iterations (relative residual {:.3g}): "
                  "{}{}",
                  friction_ ? " with friction" : "", problem_.contact.size(), coulomb_solution_.iterations,
                  coulomb_solution_.residual, coulomb_solution_.reason, advice));
}

void CondensedContact::solve_with_friction(const Stage& stage, StageSolution& solution) {
  solve_coulomb(stage);
  solution.iterations = coulomb_solution_.iterations;
  solution.contact_status = coulomb_solution_.status;
  const Index tangents = problem_.dimension - 1;
  for (Index i = 0; i < problem_.contact.size(); ++i) {
    const Index row = first_[static_cast<std::size_t>(i)];
    solution.normal_reaction[i] = coulomb_solution_.reaction[row] / scale_;
    for (Index k = 1; row + k < first_[static_cast<std::size_t>(i + 1)]; ++k) {
      solution.tangential_reaction[i * tangents + k - 1] = -coulomb_solution_.reaction[row + k] / scale_;
    }
  }
}

}  // namespace ricochet
