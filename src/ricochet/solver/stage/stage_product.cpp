#include "ricochet/solver/stage/stage_product.hpp"

#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/solver/stage/stage_terms.hpp"

namespace ricochet {

namespace {

/// Number of blocks of a pattern stored whole.
double count_blocks(const NodePattern& pattern) {
  double result = 0.0;
  for (const RowGroup& group : pattern.groups) result += double(group.rows * (2 * group.two_sided + group.one_sided));
  return result;
}

}  // namespace

bool keeps_mass_apart(const SemidiscreteProblem& problem, const NodeMatrix& stiffness) {
  const NodeMatrix& mass = problem.mass;
  const double own = count_blocks(stiffness.pattern());
  const double joined = count_blocks(joined_pattern({&stiffness.pattern(), &mass.pattern()}));
  // A pair of nodes coupled by the mass alone has the entries of m ⊗ I.
  const double per_pair = mass.is_scalar() ? 1.0 / problem.dimension : 1.0;
  const double more = problem.ranks->sum(per_pair * (joined - own));
  return more > (most_growth_by_mass - 1.0) * problem.ranks->sum(own);
}

StageProduct::StageProduct(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                           const Vector& displacement) {
  const StageTerms terms(problem, coefficients, displacement);
  const bool has_both = terms.stiffness() != nullptr && coefficients.mass != 0.0;
  if (has_both && !terms.is_damped() && keeps_mass_apart(problem, *terms.stiffness())) {
    mass_ = &problem.mass;
    mass_factor_ = coefficients.mass;
    matrix_ = NodeMatrix(terms.without_mass());
  } else {
    matrix_ = NodeMatrix(terms.all());
  }
}

void StageProduct::multiply(const Vector& x, Vector& y) const {
  matrix_.multiply(x, y);
  if (mass_ == nullptr) return;
  mass_->multiply(x, inertia_);
  y += mass_factor_ * inertia_;
}

SparseMatrix StageProduct::with_mass(const SparseMatrix& stiffness, SparseMatrix inertia) const {
  inertia *= mass_factor_;
  return add_sparse(stiffness, inertia);
}

SparseMatrix StageProduct::principal(const std::vector<Index>& nodes) const {
  if (mass_ == nullptr) return matrix_.principal(nodes);
  return with_mass(matrix_.principal(nodes), mass_->principal(nodes));
}

SparseMatrix StageProduct::columns(const std::vector<Index>& nodes) const {
  if (mass_ == nullptr) return matrix_.columns(nodes);
  return with_mass(matrix_.columns(nodes), mass_->columns(nodes));
}

Vector StageProduct::diagonal_blocks() const {
  if (mass_ == nullptr) return matrix_.diagonal_blocks();
  return matrix_.diagonal_blocks() + mass_factor_ * mass_->diagonal_blocks();
}

Vector StageProduct::diagonal() const {
  if (mass_ == nullptr) return matrix_.diagonal();
  return matrix_.diagonal() + mass_factor_ * mass_->diagonal();
}

}  // namespace ricochet
