#include "ricochet/scheme/response/restoring_impulses.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

/// Positive root of ½ w p² + a p = c. The difference of two equal numbers would be 0 if points separate fast and little
/// was lost, and the logarithm of 0 is not finite.
double positive_root(double w, double a, double c) {
  const double s = std::sqrt(a * a + 2.0 * w * c);
  return a > 0.0 ? 2.0 * c / (a + s) : (s - a) / w;
}

}  // namespace

Vector restoring_impulses(const Matrix& w, const Vector& approach, const Vector& lost) {
  Vector p(approach.size());
  for (Index i = 0; i < p.size(); ++i) p[i] = positive_root(w(i, i), approach[i], lost[i]);
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  double last = std::numeric_limits<double>::infinity();
  const auto residual = [&](const Vector& at) { return Vector(at.cwiseProduct(approach + 0.5 * (w * at)) - lost); };
  // Relative to the terms that the residual is the sum of: if p is large, they cancel.
  const auto size = [&](const Vector& at, const Vector& error) {
    const Vector terms = at.cwiseProduct(approach.cwiseAbs() + 0.5 * (w.cwiseAbs() * at)) + lost;
    return error.cwiseQuotient(terms).lpNorm<Eigen::Infinity>();
  };
  // Change of the function to be minimized, from p to p exp(change), without logarithms of dimensional numbers.
  const auto rise = [&](const Vector& next, const Vector& change) {
    return approach.dot(next - p) + 0.25 * (next - p).dot(w * (next + p)) - lost.dot(change);
  };
  constexpr int most_iterations = 100;
  constexpr double good_enough = 1e-12;  // if no step makes it smaller
  for (int k = 0; k < most_iterations; ++k) {
    const Vector error = residual(p);
    const double worst = size(p, error);
    if (worst <= rounding || (worst <= 32.0 * rounding && worst >= last)) return p;
    last = worst;
    // d error / d ln p, which is positive definite: diag(c) + ½ diag(p) W diag(p) where error = 0.
    Matrix tangent = 0.5 * p.asDiagonal() * w * p.asDiagonal();
    tangent.diagonal() += (error + lost).cwiseMax(lost);
    Vector change = -SmallCholesky(tangent).solve(error);
    change *= std::min(1.0, 3.0 / change.lpNorm<Eigen::Infinity>());
    Vector next = p.cwiseProduct(Vector(change.array().exp()));
    for (int halving = 0; halving < 30 && rise(next, change) > 0.0 && size(next, residual(next)) >= worst; ++halving) {
      change *= 0.5;
      next = p.cwiseProduct(Vector(change.array().exp()));
    }
    if (next == p && worst <= good_enough) return p;
    p = next;
  }
  throw Error(ErrorKind::not_converged, "the impulses that restore the energy of contact were not found");
}

}  // namespace ricochet
