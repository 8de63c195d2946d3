#include "ricochet/solver/delassus/massless_contact_nodes.hpp"

#include "ricochet/solver/delassus/factored_stage.hpp"
#include "ricochet/solver/stage/stage_operator.hpp"

namespace ricochet {

MasslessContactNodes::MasslessContactNodes(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                                           FactoredStage& condensed_stage)
    : weight_(coefficients.condensed_weight),
      acting_(coefficients.acting),
      problem_(problem),
      factor_(condensed_stage.factor()),
      dof_at_(condensed_stage.dofs()),
      unknown_(number_dofs(problem, solved_dofs(problem, StageDofs::contact))),
      node_dofs_(contact_node_dofs(problem)),
      columns_(condensed_stage.factor()) {
  for (const auto& body : problem.free_bodies) {
    for (Index k = 0; k < 2 * problem.dimension; ++k) node_dofs_.push_back(body->centre_node() * problem.dimension + k);
  }
  factor_vector_.setZero(factor_.work_size());
}

Index MasslessContactNodes::size() const { return factor_.size(); }

void MasslessContactNodes::clear() {
  columns_.clear();
  compliance_.resize(0, 0);
}

Matrix MasslessContactNodes::compliance() const { return factor_.scale() * compliance_; }

void MasslessContactNodes::find_motion(const ContactRows& rows, const StageSolution& solution, const Vector& increment,
                                       Vector& motion) {
  if (motion.size() != problem_.dof_count()) motion.setZero(problem_.dof_count());
  for (const Index dof : node_dofs_) motion[dof] = increment[dof];
  const double end = weight_ - 2.0, mean = 2.0;
  normal_ = end * solution.normal_reaction + mean * solution.acting_normal();
  tangential_ = end * solution.tangential_reaction;
  if (tangential_.size() > 0) tangential_ += mean * solution.acting_tangential();
  if (normal_.isZero(0.0) && tangential_.isZero(0.0)) return;
  force_.setZero(problem_.dof_count());
  rows.add_force(normal_, tangential_, force_);
  const double scale = 0.5 * factor_.scale();
  for (std::size_t i = 0; i < dof_at_.size(); ++i) factor_vector_[Index(i)] = scale * force_[dof_at_[i]];
  factor_.solve_lower(factor_vector_);
  factor_.solve_upper(factor_vector_);
  for (std::size_t i = 0; i < dof_at_.size(); ++i) motion[dof_at_[i]] -= factor_vector_[Index(i)];
}

}  // namespace ricochet
