#pragma once

#include <functional>

#include "ricochet/base/ranks.hpp"

/// @file Bounds of the largest eigenvalue of an operator that is known by its products alone.
namespace ricochet {

struct EigenvalueBounds {
  double lower = 0.0;
  double upper = 0.0;
  Index products = 0;  ///< that it took
};

/// Of a symmetric positive semi-definite operator, multiply(x, y) is y = A x. Lanczos' method from a random start gives
/// a Ritz value θ ≤ λ_max, and after k products, whatever the spectrum is,
///   λ_max ≤ θ/(1−ε)   but for a probability of at most 1.648 √n exp(−√ε (2k−1))
/// (J. Kuczyński, H. Woźniakowski, SIAM J. Matrix Anal. Appl. 13 (1992) 1094–1122, Theorem 4.2). So k is chosen for
/// ε = `spread` and a probability of 1e-9, some 100 products for ε = 0.02, and upper = θ/(1−ε). The start is the same
/// pseudo-random vector in every run, and an A scaled by a power of two gives the same bits scaled.
[[nodiscard]] EigenvalueBounds bound_largest_eigenvalue(Index size,
                                                        const std::function<void(const Vector&, Vector&)>& multiply,
                                                        double spread = 0.02);
/// Of several ranks each has d numbers at each of its nodes; products are consistent.
[[nodiscard]] EigenvalueBounds bound_largest_eigenvalue(Index size,
                                                        const std::function<void(const Vector&, Vector&)>& multiply,
                                                        double spread, const Ranks& ranks, int d);

/// A Ritz value θ ≤ λ_max of such an operator from some products, from a guess of the eigenvector, which need not have
/// unit length and is not zero; leaves the unit Ritz vector there. Lanczos' method with vectors that are made
/// orthogonal to all before, so that products may have small errors: those of differences, where the operator is a
/// derivative. The values are those of the projection of the operator on its products.
[[nodiscard]] double improve_largest_eigenvalue(const std::function<void(const Vector&, Vector&)>& multiply,
                                                int products, Vector& guess);

}  // namespace ricochet
