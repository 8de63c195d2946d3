#pragma once

#include <functional>
#include <memory>

#include "ricochet/base/types.hpp"

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

/// Work space is kept from solve to solve.
class ConjugateGradients {
 public:
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
  Vector direction_, image_, preconditioned_;
};

}  // namespace ricochet
