#include "ricochet/linear_algebra/largest_eigenvalue.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/linear_algebra/conjugate_gradients.hpp"

namespace ricochet {

namespace {

constexpr double failure_probability = 1e-9;

/// Returns a vector distributed uniformly on the unit sphere.
Vector start_vector(Index size, const Ranks& ranks, int d) {
  std::mt19937_64 generator(20110901 + std::uint64_t(ranks.rank()));
  std::normal_distribution<double> normal;
  Vector start(size);
  for (Index i = 0; i < size; ++i) start[i] = normal(generator);
  for (const Index node : ranks.not_owned()) start.segment(node * d, d).setZero();
  ranks.accumulate(start);
  return start / std::sqrt(dot_product(start, start, ranks, d));
}

}  // namespace

EigenvalueBounds bound_largest_eigenvalue(Index size, const std::function<void(const Vector&, Vector&)>& multiply,
                                          double spread) {
  return bound_largest_eigenvalue(size, multiply, spread, one_rank(), 1);
}

EigenvalueBounds bound_largest_eigenvalue(Index size, const std::function<void(const Vector&, Vector&)>& multiply,
                                          double spread, const Ranks& ranks, int d) {
  EigenvalueBounds bounds;
  const double all = ranks.sum(double(size - d * Index(ranks.not_owned().size())));
  if (all == 0.0) return bounds;
  const double odds = 1.648 * std::sqrt(all) / failure_probability;
  const auto dot = [&](const Vector& one, const Vector& other) { return dot_product(one, other, ranks, d); };
  const auto enough = Index(std::ceil(0.5 * (1.0 + std::log(odds) / std::sqrt(spread))));
  Vector previous = Vector::Zero(size);
  Vector current = start_vector(size, ranks, d);
  Vector next(size);
  std::vector<double> diagonal, beside;  // of the tridiagonal projection
  // No reorthogonalization: rounding repeats Ritz values that have converged but creates none outside the spectrum.
  while (true) {
    multiply(current, next);
    ++bounds.products;
    diagonal.push_back(dot(current, next));
    if (!beside.empty()) next -= beside.back() * previous;
    next -= diagonal.back() * current;
    const double length = std::sqrt(dot(next, next));
    const double largest = *std::ranges::max_element(diagonal);
    // An invariant subspace is exhausted: it contains a part of every eigenvector.
    const bool exhausted = !(length > 64.0 * std::numeric_limits<double>::epsilon() * largest);
    if (bounds.products == enough || exhausted) break;
    beside.push_back(length);
    std::swap(previous, current);
    current = next / length;
  }
  // Eigen's iteration converges only for matrices scaled near 1. A power of two changes no bit.
  int exponent = 0;
  std::frexp(*std::ranges::max_element(diagonal), &exponent);
  for (double& entry : diagonal) entry = std::ldexp(entry, -exponent);
  for (double& entry : beside) entry = std::ldexp(entry, -exponent);
  const auto count = Index(diagonal.size());
  const std::optional<Vector> values = tridiagonal_eigenvalues(Eigen::Map<const Vector>(diagonal.data(), count),
                                                               Eigen::Map<const Vector>(beside.data(), count - 1));
  if (!values) {
    throw Error(ErrorKind::not_converged,
                "the largest eigenvalue of the stiffness was not found: it is possibly not finite");
  }
  bounds.lower = std::ldexp((*values)[count - 1], exponent);
  bounds.upper = bounds.lower / (1.0 - spread);
  return bounds;
}

double improve_largest_eigenvalue(const std::function<void(const Vector&, Vector&)>& multiply, int products,
                                  Vector& guess) {
  Matrix basis(guess.size(), products);
  Matrix projected = Matrix::Zero(products, products);  // its lower triangle
  Vector current = guess / guess.norm(), next(guess.size());
  Index count = 0;
  while (true) {
    basis.col(count) = current;
    ++count;
    multiply(current, next);
    const auto previous = basis.leftCols(count);
    const Vector along = previous.transpose() * next;
    projected.row(count - 1).head(count) = along.transpose();
    const double before = next.norm();
    next -= previous * along;
    next -= previous * (previous.transpose() * next).eval();
    const double length = next.norm();
    if (count == products || !(length > 64.0 * std::numeric_limits<double>::epsilon() * before)) break;
    current = next / length;
  }
  int exponent = 0;  // scaling as in bound_largest_eigenvalue
  std::frexp(projected.diagonal().cwiseAbs().maxCoeff(), &exponent);
  projected = (projected.topLeftCorner(count, count) * std::ldexp(1.0, -exponent)).eval();
  const SymmetricEigen eigen = symmetric_eigen(projected);
  guess = basis.leftCols(count) * eigen.vectors.col(count - 1);
  return std::ldexp(eigen.values[count - 1], exponent);
}

}  // namespace ricochet
