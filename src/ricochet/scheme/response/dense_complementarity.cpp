#include "ricochet/scheme/response/dense_complementarity.hpp"

#include <limits>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"

namespace ricochet {

namespace {

/// Returns r = H⁻¹ b on these points, zero at the others.
Vector solve_on(const Matrix& h, const Vector& b, const std::vector<char>& presses) {
  std::vector<Index> points;
  for (Index i = 0; i < b.size(); ++i) {
    if (presses[std::size_t(i)] != 0) points.push_back(i);
  }
  Vector r = Vector::Zero(b.size());
  if (points.empty()) return r;
  const SmallCholesky factor(h(points, points));
  if (!factor.positive_definite())
    throw Error(ErrorKind::not_converged, "the response of the contact points is not positive definite");
  r(points) = factor.solve(b(points));
  return r;
}

}  // namespace

Vector dense_complementarity(const Matrix& h, const Vector& b, const std::vector<char>& first) {
  constexpr int patience = 3, most_exchanges = 100000;
  std::vector<char> presses = first;
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int left = patience;
  for (int exchange = 0; exchange < most_exchanges; ++exchange) {
    const Vector r = solve_on(h, b, presses), y = h * r - b;
    const Vector rounding = 8.0 * std::numeric_limits<double>::epsilon() * (h.cwiseAbs() * r.cwiseAbs() + b.cwiseAbs());
    std::vector<std::size_t> wrong;
    for (Index i = 0; i < b.size(); ++i) {
      const bool pressing = presses[std::size_t(i)] != 0;
      if (pressing ? r[i] * h(i, i) < -rounding[i] : y[i] < -rounding[i]) wrong.push_back(std::size_t(i));
    }
    if (wrong.empty()) return r.cwiseMax(0.0);
    if (wrong.size() < fewest) {
      fewest = wrong.size();
      left = patience;
    } else if (left-- <= 0) {
      wrong.erase(wrong.begin(), wrong.end() - 1);
    }
    for (const std::size_t i : wrong) presses[i] ^= 1;
  }
  throw Error(ErrorKind::not_converged, "the contact forces were not found");
}

}  // namespace ricochet
