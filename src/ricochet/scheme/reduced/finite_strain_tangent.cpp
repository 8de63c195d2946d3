#include "ricochet/scheme/reduced/finite_strain_tangent.hpp"

namespace ricochet {

void FiniteStrainTangent::analyse(const SemidiscreteProblem& problem) {
  const auto dofs = std::size_t(problem.dof_count());
  equation_.assign(dofs, -1);
  end_equation_.assign(dofs, -1);
  int count = 0;
  for (std::size_t k = 0; k < dofs; ++k)
    if (!problem.supports.contains(Index(k)) && !problem.is_tied_dof(Index(k))) equation_[k] = count++;
  for (const Index dof : problem.contact_dofs) end_equation_[std::size_t(dof)] = count++;
  count_ = count;
  const auto motions = [&](const auto& of) {
    Motions result(dofs);
    for (std::size_t k = 0; k < dofs; ++k) result[k] = of(k, end_equation_[k] >= 0);
    return result;
  };
  using Motion = std::pair<int, double>;
  middle_ = motions([&](std::size_t k, bool) { return Motion(equation_[k], 1.0); });
  path_ = motions([&](std::size_t k, bool contact) { return Motion(equation_[k], contact ? -2.0 : 2.0); });
  path_of_end_ = motions([&](std::size_t k, bool contact) { return Motion(end_equation_[k], contact ? 2.0 : 0.0); });
  end_ = motions(
      [&](std::size_t k, bool contact) { return contact ? Motion(end_equation_[k], 1.0) : Motion(equation_[k], 2.0); });
  own_ = motions([&](std::size_t k, bool) { return Motion(equation_[k], equation_[k] >= 0 ? 1.0 : 0.0); });
  own_at_end_ = motions([&](std::size_t k, bool contact) { return Motion(end_equation_[k], contact ? 1.0 : 0.0); });
  known_.assign(dofs, 0.0);
}

/// Adds factor · matrix · motions of its columns to the equations of its rows; known motions go to the right-hand side.
void FiniteStrainTangent::add(const SparseMatrix& matrix, double factor, const std::vector<int>& rows,
                              const Motions& columns) {
  for (Index column = 0; column < matrix.outerSize(); ++column) {
    const auto [unknown, weight] = columns[std::size_t(column)];
    if (weight == 0.0) continue;
    for (SparseMatrix::InnerIterator entry(matrix, column); entry; ++entry) {
      const int row = rows[std::size_t(entry.row())];
      if (row < 0) continue;
      const double value = factor * weight * entry.value();
      if (unknown >= 0) {
        entries_.emplace_back(row, unknown, value);
      } else {
        right_[row] -= value * known_[std::size_t(column)];
      }
    }
  }
}

void FiniteStrainTangent::add_forces(const StepIterate& at) {
  const SemidiscreteProblem& problem = at.problem;
  const ViscousForce* const viscous = problem.internal_force->viscous();
  const auto path_tangent = [&](const PathVariation& variation) {
    return viscous != nullptr ? viscous->step_path_tangent(at.branches(), at.rules, variation)
                              : problem.internal_force->path_tangent(at.middle, at.path_increment, at.rules, variation);
  };
  add(path_tangent({1.0, 0.0}), 1.0, equation_, middle_);
  const SparseMatrix by_path = path_tangent({0.0, 1.0});
  add(by_path, 1.0, equation_, path_);
  add(by_path, 1.0, equation_, path_of_end_);
  add(problem.mass.to_sparse(), 4.0 / (at.step * at.step), equation_, middle_);
  if (problem.has_damping()) add(problem.damping.matrix(), 2.0 / at.step, equation_, middle_);
  if (problem.pressure)
    add(problem.pressure->mean_stiffness(at.middle, at.state.time, at.state.time + at.step), 1.0, equation_, middle_);
  if (at.contact_cells == nullptr) return;
  const ViscousForce* const at_end = at.contact_cells->viscous();
  add(at_end != nullptr ? at_end->step_tangent(at.end, at.step) : at.contact_cells->tangent(at.end), 1.0, end_equation_,
      end_);
  if (problem.pressure) add(problem.pressure->stiffness(at.end), 1.0, end_equation_, end_);
}

void FiniteStrainTangent::add_proximal_terms(const SemidiscreteProblem& problem, double weight) {
  if (undeformed_.rows() == 0) undeformed_ = problem.internal_force->tangent(Vector::Zero(problem.dof_count()));
  add(undeformed_, weight, equation_, own_);
  add(undeformed_, weight, end_equation_, own_at_end_);
}

/// Rows of reactions as forces in both sets of equations.
SparseRowMatrix FiniteStrainTangent::forces_of(const SparseRowMatrix& rows) const {
  Triplets entries;
  for (Index row = 0; row < rows.rows(); ++row) {
    for (SparseRowMatrix::InnerIterator entry(rows, row); entry; ++entry) {
      for (const std::vector<int>* const equations : {&equation_, &end_equation_}) {
        const int equation = (*equations)[std::size_t(entry.col())];
        if (equation >= 0) entries.emplace_back(int(row), equation, entry.value());
      }
    }
  }
  SparseRowMatrix result(rows.rows(), count_);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

/// Derivatives by unknowns, from those by u₁; known motions are added to the offset.
SparseRowMatrix FiniteStrainTangent::motions_of(const SparseRowMatrix& rows, Vector& offset) const {
  Triplets entries;
  for (Index row = 0; row < rows.rows(); ++row) {
    for (SparseRowMatrix::InnerIterator entry(rows, row); entry; ++entry) {
      const auto [unknown, weight] = end_[std::size_t(entry.col())];
      if (unknown >= 0) {
        entries.emplace_back(int(row), unknown, weight * entry.value());
      } else {
        offset[row] += weight * entry.value() * known_[std::size_t(entry.col())];
      }
    }
  }
  SparseRowMatrix result(rows.rows(), count_);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

void FiniteStrainTangent::add_contact(const StepIterate& at, const Reactions& reactions, ExactTangent& tangent) {
  const ContactConditions& conditions = at.stage.conditions;
  const StepStart start{at.state.displacement, at.state.time};
  contact_.differentiate(at.problem, start, at.end, at.state.time + at.step, *at.stage.rows, reactions);
  for (const std::vector<int>* const equations : {&equation_, &end_equation_})
    add(contact_.force(), -1.0, *equations, end_);
  tangent.gap = conditions.gap.offset;
  tangent.gap_rounding = conditions.gap.rounding;
  tangent.normal_force = forces_of(contact_.normal_rows());
  tangent.normal_motion = motions_of(contact_.gap(), tangent.gap);
  // Slips are those of the whole step.
  const bool has_friction = conditions.slip.offset.size() > 0;
  const double scale = has_friction ? 2.0 / conditions.slip.factor : 0.0;
  tangent.slip = scale * conditions.slip.offset;
  tangent.slip_rounding = scale * conditions.slip.rounding;
  tangent.tangential_force = forces_of(contact_.tangential_rows());
  if (has_friction) tangent.tangential_motion = motions_of(contact_.slip(), tangent.slip);
}

void FiniteStrainTangent::assemble(const StepIterate& at, const Reactions& reactions, double proximal_weight,
                                   ExactTangent& tangent) {
  const SemidiscreteProblem& problem = at.problem;
  entries_.clear();
  right_.setZero(count_);
  for (std::size_t k = 0; k < equation_.size(); ++k) {
    if (equation_[k] >= 0) right_[equation_[k]] = at.imbalance[Index(k)];
    if (end_equation_[k] >= 0) right_[end_equation_[k]] = at.end_imbalance[Index(k)];
  }
  for (Index i = 0; i < problem.supports.size(); ++i)
    known_[std::size_t(problem.supports.dofs()[std::size_t(i)])] = at.stage.right_hand_side.prescribed[i];
  add_forces(at);
  if (proximal_weight > 0.0) add_proximal_terms(problem, proximal_weight);
  if (problem.has_contact_dofs()) add_contact(at, reactions, tangent);
  tangent.matrix.resize(count_, count_);
  tangent.matrix.setFromTriplets(entries_.begin(), entries_.end());
  tangent.right_hand_side = right_;
}

void FiniteStrainTangent::write_increments(const Vector& unknowns, Vector& middle, Vector& end) const {
  middle.resize(Index(middle_.size()));
  end.resize(middle.size());
  const auto value = [&](const std::pair<int, double>& motion, std::size_t dof) {
    return motion.second * (motion.first >= 0 ? unknowns[motion.first] : known_[dof]);
  };
  for (std::size_t k = 0; k < middle_.size(); ++k) {
    middle[Index(k)] = value(middle_[k], k);
    end[Index(k)] = value(end_[k], k);
  }
}

}  // namespace ricochet
