#pragma once

#include <functional>

#include "ricochet/base/ranks.hpp"

/// @file Preconditioned conjugate gradients.
namespace ricochet {

/// A preconditioner P ≈ A, symmetric positive definite.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// Computes z = P⁻¹ r, with the same bits for any number of threads.
  virtual void apply(const Vector& r, Vector& z) const = 0;
};

/// Returns aᵀb, summed in a fixed order on all threads.
[[nodiscard]] double dot_product(const Vector& a, const Vector& b);
/// Returns aᵀb for vectors that are consistent on the ranks (d numbers per node), counting each node once.
[[nodiscard]] double dot_product(const Vector& a, const Vector& b, const Ranks& ranks, int d);

/// Conjugate gradient solver. Work space is reused from solve to solve.
class ConjugateGradients {
 public:
  /// Vectors and products are consistent on the ranks, with d numbers per node.
  explicit ConjugateGradients(int d = 1, const Ranks& ranks = one_rank()) : d_(d), ranks_(&ranks) {}

  using Product = std::function<void(const Vector& x, Vector& y)>;
  struct Result {
    int iterations = 0;
    double residual = 0.0;  ///< √(rᵀP⁻¹r) at the end
    bool converged = false;
  };

  /// Returns √(rᵀP⁻¹r): the energy norm of the error A⁻¹r, with P in place of A.
  double norm(const Preconditioner& preconditioner, const Vector& residual);
  /// Updates x until `residual` = b − A x satisfies √(rᵀP⁻¹r) ≤ target, and updates the residual with it. Stops earlier
  /// after `iteration_limit` iterations, if A turns out not to be positive definite, or if numbers are not finite.
  Result solve(const Product& product, const Preconditioner& preconditioner, double target, int iteration_limit,
               Vector& residual, Vector& x);

 private:
  [[nodiscard]] double dot(const Vector& a, const Vector& b) const { return dot_product(a, b, *ranks_, d_); }

  int d_;
  const Ranks* ranks_;
  Vector direction_, image_, preconditioned_;
};

}  // namespace ricochet
