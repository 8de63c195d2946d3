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
  using Motion = TangentAssembly::Motion;
  middle_ = motions([&](std::size_t k, bool) { return Motion{equation_[k], 1.0}; });
  path_ = motions([&](std::size_t k, bool contact) { return Motion{equation_[k], contact ? -2.0 : 2.0}; });
  path_of_end_ = motions([&](std::size_t k, bool contact) { return Motion{end_equation_[k], contact ? 2.0 : 0.0}; });
  end_ = motions([&](std::size_t k, bool contact) {
    return contact ? Motion{end_equation_[k], 1.0} : Motion{equation_[k], 2.0};
  });
  own_ = motions([&](std::size_t k, bool) { return Motion{equation_[k], equation_[k] >= 0 ? 1.0 : 0.0}; });
  own_at_end_ = motions([&](std::size_t k, bool contact) { return Motion{end_equation_[k], contact ? 1.0 : 0.0}; });
}

void FiniteStrainTangent::add_forces(const StepIterate& at) {
  const SemidiscreteProblem& problem = at.problem;
  const ViscousForce* const viscous = problem.internal_force->viscous();
  const auto path_tangent = [&](const PathVariation& variation) {
    return viscous != nullptr ? viscous->step_path_tangent(at.branches(), at.rules, variation)
                              : problem.internal_force->path_tangent(at.middle, at.path_increment, at.rules, variation);
  };
  assembly_.add(path_tangent({1.0, 0.0}), 1.0, equation_, middle_);
  const SparseMatrix by_path = path_tangent({0.0, 1.0});
  assembly_.add(by_path, 1.0, equation_, path_);
  assembly_.add(by_path, 1.0, equation_, path_of_end_);
  assembly_.add(problem.mass.to_sparse(), 4.0 / (at.step * at.step), equation_, middle_);
  if (problem.has_damping()) assembly_.add(problem.damping.matrix(), 2.0 / at.step, equation_, middle_);
  if (problem.pressure)
    assembly_.add(problem.pressure->mean_stiffness(at.middle, at.state.time, at.state.time + at.step), 1.0, equation_,
                  middle_);
  if (at.contact_cells == nullptr) return;
  const ViscousForce* const at_end = at.contact_cells->viscous();
  assembly_.add(at_end != nullptr ? at_end->step_tangent(at.end, at.step) : at.contact_cells->tangent(at.end), 1.0,
                end_equation_, end_);
  if (problem.pressure) assembly_.add(problem.pressure->stiffness(at.end), 1.0, end_equation_, end_);
}

void FiniteStrainTangent::add_proximal_terms(const SemidiscreteProblem& problem, double weight) {
  if (undeformed_.rows() == 0) undeformed_ = problem.internal_force->tangent(Vector::Zero(problem.dof_count()));
  assembly_.add(undeformed_, weight, equation_, own_);
  assembly_.add(undeformed_, weight, end_equation_, own_at_end_);
}

void FiniteStrainTangent::add_contact(const StepIterate& at, const Reactions& reactions, ExactTangent& tangent) {
  const StepStart start{at.state.displacement, at.state.time};
  contact_.differentiate(at.problem, {at.state.displacement, at.end, at.state.time + at.step, &start}, *at.stage.rows,
                         reactions);
  // Slips are those of the whole step.
  assembly_.add_contact(contact_, at.stage.conditions, 2.0, {&equation_, &end_equation_}, end_, tangent);
}

void FiniteStrainTangent::assemble(const StepIterate& at, const Reactions& reactions, double proximal_weight,
                                   ExactTangent& tangent) {
  const SemidiscreteProblem& problem = at.problem;
  assembly_.start(count_, problem.dof_count());
  for (std::size_t k = 0; k < equation_.size(); ++k) {
    if (equation_[k] >= 0) assembly_.right_hand_side(equation_[k]) = at.imbalance[Index(k)];
    if (end_equation_[k] >= 0) assembly_.right_hand_side(end_equation_[k]) = at.end_imbalance[Index(k)];
  }
  for (Index i = 0; i < problem.supports.size(); ++i)
    assembly_.set_known(problem.supports.dofs()[std::size_t(i)], at.stage.right_hand_side.prescribed[i]);
  add_forces(at);
  if (proximal_weight > 0.0) add_proximal_terms(problem, proximal_weight);
  if (problem.has_contact_dofs()) add_contact(at, reactions, tangent);
  assembly_.write(tangent);
}

void FiniteStrainTangent::write_increments(const Vector& unknowns, Vector& middle, Vector& end) const {
  middle.resize(Index(middle_.size()));
  end.resize(middle.size());
  for (Index k = 0; k < middle.size(); ++k) {
    middle[k] = assembly_.value(unknowns, middle_, k);
    end[k] = assembly_.value(unknowns, end_, k);
  }
}

}  // namespace ricochet
