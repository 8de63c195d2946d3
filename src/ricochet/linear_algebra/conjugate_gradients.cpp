#include "ricochet/linear_algebra/conjugate_gradients.hpp"

#include <cmath>

#include "ricochet/base/parallel.hpp"

namespace ricochet {

double dot_product(const Vector& a, const Vector& b) {
  return parallel_sum<double>(a.size(), [&](Index begin, Index end) {
    return a.segment(begin, end - begin).dot(b.segment(begin, end - begin));
  });
}

double dot_product(const Vector& a, const Vector& b, const Ranks& ranks, int d) {
  double sum = dot_product(a, b);
  for (const Index node : ranks.not_owned()) sum -= a.segment(node * d, d).dot(b.segment(node * d, d));
  return ranks.sum(sum);
}

double ConjugateGradients::norm(const Preconditioner& preconditioner, const Vector& residual) {
  preconditioner.apply(residual, preconditioned_);
  return std::sqrt(dot(residual, preconditioned_));
}

ConjugateGradients::Result ConjugateGradients::solve(const Product& product, const Preconditioner& preconditioner,
                                                     double target, int iteration_limit, Vector& residual, Vector& x) {
  Result result;
  preconditioner.apply(residual, preconditioned_);
  double squared = dot(residual, preconditioned_);
  direction_ = preconditioned_;
  while (true) {
    result.residual = std::sqrt(squared);
    result.converged = result.residual <= target;
    if (result.converged || result.iterations == iteration_limit) break;
    product(direction_, image_);
    const double curvature = dot(direction_, image_);
    if (!(curvature > 0.0) || !std::isfinite(squared)) break;
    ++result.iterations;
    const double length = squared / curvature;
    parallel_ranges(x.size(), [&](Index begin, Index end) {
      x.segment(begin, end - begin) += length * direction_.segment(begin, end - begin);
      residual.segment(begin, end - begin) -= length * image_.segment(begin, end - begin);
    });
    preconditioner.apply(residual, preconditioned_);
    const double next = dot(residual, preconditioned_);
    const double factor = next / squared;
    squared = next;
    parallel_ranges(x.size(), [&](Index begin, Index end) {
      direction_.segment(begin, end - begin) =
          preconditioned_.segment(begin, end - begin) + factor * direction_.segment(begin, end - begin);
    });
  }
  return result;
}

}  // namespace ricochet
