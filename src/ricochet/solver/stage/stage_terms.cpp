#include "ricochet/solver/stage/stage_terms.hpp"

#include "ricochet/linear_algebra/diagonal_matrix.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/solver/stage/stage_operator.hpp"

namespace ricochet {

StageTerms::StageTerms(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                       const Vector& displacement)
    : mass_(&problem.mass), is_damped_(coefficients.damping != 0.0 && problem.has_damping()) {
  if (coefficients.stiffness != 0.0) {
    stiffness_ = problem.internal_force->constant_tangent();
    if (stiffness_ == nullptr) {
      tangent_ = std::make_unique<NodeMatrix>(stage_stiffness(problem, coefficients, displacement), problem.dimension);
      stiffness_ = tangent_.get();
    }
    add(coefficients.stiffness, stiffness_);
  }
  add(coefficients.mass, mass_);
  if (!is_damped_) return;
  const Damping& damping = problem.damping;
  add(coefficients.damping, damping.mass_part());
  add(coefficients.damping, damping.stiffness_part());
  if (damping.ground_part().size() == 0) return;
  ground_ = std::make_unique<NodeMatrix>(diagonal_matrix(damping.ground_part()), problem.dimension);
  add(coefficients.damping, ground_.get());
}

void StageTerms::add(double factor, const NodeMatrix* matrix) {
  if (factor != 0.0 && matrix != nullptr) terms_.push_back({factor, matrix});
}

std::vector<NodeMatrix::Term> StageTerms::without_mass() const {
  std::vector<NodeMatrix::Term> result = terms_;
  std::erase_if(result, [&](const NodeMatrix::Term& term) { return term.matrix == mass_; });
  return result;
}

SparseMatrix StageTerms::principal(const std::vector<Index>& nodes) const {
  SparseMatrix result;
  for (const NodeMatrix::Term& term : terms_) {
    SparseMatrix part = term.matrix->principal(nodes);
    part *= term.factor;
    if (result.cols() > 0) add_sparse(result, part).swap(part);
    result.swap(part);
  }
  return result;
}

}  // namespace ricochet
