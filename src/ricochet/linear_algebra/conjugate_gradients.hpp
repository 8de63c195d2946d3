#pragma once

#include <functional>
#include <memory>

#include "ricochet/base/ranks.hpp"

/// @file Preconditioned conjugate gradients.
namespace ricochet {

/// A symmetric positive definite P with P ≈ A.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;
  /// z = P⁻¹ r. The same bits for any number of threads.
  virtual void apply(const Vector& r, Vector& z) const = 0;
};

/// aᵀb in a fixed order of sums, by all threads.
[[nodiscard]] double dot_product(const Vector& a, const Vector& b);
/// The same of vectors that are consistent on the ranks (d numbers per node), each node once.
[[nodiscard]] double dot_product(const Vector& a, const Vector& b, const Ranks& ranks, int d);

/// Work space is kept from solve to solve.
class ConjugateGradients {
 public:
  /// Vectors are consistent on the ranks, with d numbers per node; so is what a product gives.
  explicit ConjugateGradients(int d = 1, const Ranks& ranks = one_rank()) : d_(d), ranks_(&ranks) {}

  using Product = std::function<void(const Vector& x, Vector& y)>;
  struct Result {
    int iterations = 0;
    double residual = 0.0;  ///< √(rᵀP⁻¹r) at the end
    bool converged = false;
  };

  /// √(rᵀP⁻¹r): the energy norm of the error A⁻¹r as P sees it.
  double norm(const Preconditioner& preconditioner, const Vector& residual);
  /// Adds to x what takes `residual` = b − A x to √(rᵀP⁻¹r) ≤ target, and follows the residual. Stops short of it after
  /// `iteration_limit` iterations, or where A turns out not to be positive definite or numbers not finite.
  Result solve(const Product& product, const Preconditioner& preconditioner, double target, int iteration_limit,
               Vector& residual, Vector& x);

 private:
  [[nodiscard]] double dot(const Vector& a, const Vector& b) const { return dot_product(a, b, *ranks_, d_); }

  int d_;
  const Ranks* ranks_;
  Vector direction_, image_, preconditioned_;
};

}  // namespace ricochet
