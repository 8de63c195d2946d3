#pragma once

#include <functional>

#include "ricochet/base/ranks.hpp"

/// @file Bounds of the largest eigenvalue of an operator given by its products alone.
namespace ricochet {

struct EigenvalueBounds {
  double lower = 0.0;
  double upper = 0.0;
  Index products = 0;  ///< number of products computed
};

/// Bounds the largest eigenvalue of a symmetric positive semi-definite operator; multiply(x, y) computes y = A x. The
/// Lanczos method from a random start yields a Ritz value θ ≤ λ_max, and after k products, for any spectrum,
///   λ_max ≤ θ/(1−ε)   except with a probability of at most 1.648 √n exp(−√ε (2k−1))
/// (J. Kuczyński, H. Woźniakowski, SIAM J. Matrix Anal. Appl. 13 (1992) 1094–1122, Theorem 4.2). Therefore k is chosen
/// for ε = `spread` and a probability of 1e-9, some 100 products for ε = 0.02, and upper = θ/(1−ε). The start is the
/// same pseudo-random vector in every run, and scaling A by a power of two scales the result without changing other
/// bits.
[[nodiscard]] EigenvalueBounds bound_largest_eigenvalue(Index size,
                                                        const std::function<void(const Vector&, Vector&)>& multiply,
                                                        double spread = 0.02);
/// Version for several ranks, each with d numbers at each of its nodes; products are consistent.
[[nodiscard]] EigenvalueBounds bound_largest_eigenvalue(Index size,
                                                        const std::function<void(const Vector&, Vector&)>& multiply,
                                                        double spread, const Ranks& ranks, int d);

/// Returns a Ritz value θ ≤ λ_max of such an operator after some products, from a guess of the eigenvector (not zero,
/// of any length), which the unit Ritz vector replaces. The Lanczos vectors are orthogonalized against all previous
/// ones, so that products may have small errors, such as those of finite differences if the operator is a derivative.
/// Ritz values are those of the projection of the operator computed from its products.
[[nodiscard]] double improve_largest_eigenvalue(const std::function<void(const Vector&, Vector&)>& multiply,
                                                int products, Vector& guess);

}  // namespace ricochet
