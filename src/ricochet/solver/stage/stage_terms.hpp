#pragma once

#include <memory>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/problem/stage.hpp"

/// @file The matrices that the operator of a stage is a sum of.
namespace ricochet {

/// A = κK(U) + αM + ηC, term by term: those that the problem keeps, and those that are made here.
class StageTerms {
 public:
  /// Keeps references to the problem. Displacement empty: of the undeformed body.
  StageTerms(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients, const Vector& displacement);

  [[nodiscard]] const std::vector<NodeMatrix::Term>& all() const { return terms_; }
  /// All but that of the mass, where there is one.
  [[nodiscard]] std::vector<NodeMatrix::Term> without_mass() const;
  [[nodiscard]] bool is_damped() const { return is_damped_; }
  /// K; null where it has no part.
  [[nodiscard]] const NodeMatrix* stiffness() const { return stiffness_; }
  /// The rows and columns of these nodes, ascending, of A.
  [[nodiscard]] SparseMatrix principal(const std::vector<Index>& nodes) const;

 private:
  void add(double factor, const NodeMatrix* matrix);

  const NodeMatrix* mass_;
  const NodeMatrix* stiffness_ = nullptr;
  bool is_damped_;
  std::unique_ptr<const NodeMatrix> tangent_, ground_;
  std::vector<NodeMatrix::Term> terms_;
};

}  // namespace ricochet
