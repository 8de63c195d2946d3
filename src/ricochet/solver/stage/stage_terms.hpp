#pragma once

#include <memory>
#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/step/stage.hpp"

/// @file Matrices whose sum is the operator of a stage.
namespace ricochet {

/// A = κK(U) + αM + ηC, term by term: those that the problem keeps, and those that are made here.
class StageTerms {
 public:
  /// Keeps references to the problem. An empty displacement denotes the undeformed body.
  StageTerms(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients, const Vector& displacement);

  [[nodiscard]] const std::vector<NodeMatrix::Term>& all() const { return terms_; }
  /// All terms except that of the mass, if any.
  [[nodiscard]] std::vector<NodeMatrix::Term> without_mass() const;
  [[nodiscard]] bool is_damped() const { return is_damped_; }
  /// K; null if it has no part.
  [[nodiscard]] const NodeMatrix* stiffness() const { return stiffness_; }
  /// Rows and columns of A of these nodes, ascending.
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
