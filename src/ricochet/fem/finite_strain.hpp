#pragma once

#include <array>
#include <cmath>

#include "ricochet/fem/material_law.hpp"

/// @file Tensor functions for laws of finite strain. Not part of the public interface.
namespace ricochet {

// Products and inverses of 3 × 3 matrices are written out: compilers keep those of Eigen as calls, which
// take most of the time of a cell.

/// A B.
inline Tensor product(const Tensor& a, const Tensor& b) {
  Tensor result;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) result(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  }
  return result;
}
/// Aᵀ B.
inline Tensor transposed_product(const Tensor& a, const Tensor& b) {
  Tensor result;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) result(i, j) = a(0, i) * b(0, j) + a(1, i) * b(1, j) + a(2, i) * b(2, j);
  }
  return result;
}
inline double determinant(const Tensor& a) {
  return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) - a(0, 1) * (a(1, 0) * a(2, 2) - a(1, 2) * a(2, 0)) +
         a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
}
/// C⁻¹ of C = I + 2E.
inline Tensor inverse_metric(const Tensor& strain) {
  const double a = 1.0 + 2.0 * strain(0, 0), b = 1.0 + 2.0 * strain(1, 1), c = 1.0 + 2.0 * strain(2, 2);
  const double d = 2.0 * strain(1, 2), e = 2.0 * strain(0, 2), f = 2.0 * strain(0, 1);
  const double xx = b * c - d * d, xy = d * e - f * c, xz = f * d - b * e;
  const double scale = 1.0 / (a * xx + f * xy + e * xz);
  Tensor result;
  result(0, 0) = scale * xx;
  result(1, 1) = scale * (a * c - e * e);
  result(2, 2) = scale * (a * b - f * f);
  result(0, 1) = result(1, 0) = scale * xy;
  result(0, 2) = result(2, 0) = scale * xz;
  result(1, 2) = result(2, 1) = scale * (e * f - a * d);
  return result;
}

/// Green's strain ½(H + Hᵀ + HᵀH) of a displacement gradient.
inline Tensor green_strain(const Tensor& gradient) {
  Tensor result = transposed_product(gradient, gradient);
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i <= j; ++i) {
      const double entry = 0.5 * (gradient(i, j) + gradient(j, i) + result(i, j));
      result(i, j) = entry;
      result(j, i) = entry;
    }
  }
  return result;
}

inline Tensor deviator_of(const Tensor& a) {
  Tensor result = a;
  result.diagonal().array() -= a.trace() / 3.0;
  return result;
}

/// det(I + A) − 1 − tr A, of second order, to the precision of its terms.
inline double determinant_remainder(const Tensor& a) {
  const double second = a(0, 0) * a(1, 1) - a(0, 1) * a(1, 0) + a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1) +
                        a(2, 2) * a(0, 0) - a(2, 0) * a(0, 2);
  return second + determinant(a);
}

/// det(I + A) − 1, to the precision of A.
inline double determinant_change(const Tensor& a) { return a.trace() + determinant_remainder(a); }

/// x − ln(1 + x), to the precision of x: with t = x/(2+x), ln(1+x) = 2(t + t³/3 + t⁵/5 + …).
inline double logarithm_remainder(double x) {
  if (!(std::abs(x) < 0.1)) return x - std::log1p(x);
  const double t = x / (2.0 + x), square = t * t;
  double sum = 0.0;
  for (int k = 17; k >= 3; k -= 2) sum = 1.0 / k + square * sum;
  return x * t - 2.0 * t * square * sum;
}

/// J − 1 as a function of s = J² − 1.
inline double volume_change(double s) { return s / (1.0 + std::sqrt(1.0 + s)); }

/// Indices (i, j) of the components of a StressTangent.
inline constexpr std::array<std::array<int, 2>, 6> tangent_components{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}}};

/// Reads the components of a symmetric tensor, such as the internal strain of a branch.
inline Tensor read_tensor(const double* from) {
  Tensor result;
  for (std::size_t k = 0; k < tangent_components.size(); ++k) {
    const auto [i, j] = tangent_components[k];
    result(i, j) = result(j, i) = from[k];
  }
  return result;
}

/// Adds factor · A ⊗ B, A and B symmetric.
inline void add_dyad(const Tensor& a, const Tensor& b, double factor, StressTangent& result) {
  for (int p = 0; p < 6; ++p) {
    const auto [i, j] = tangent_components[std::size_t(p)];
    for (int q = 0; q < 6; ++q) {
      const auto [k, l] = tangent_components[std::size_t(q)];
      result(p, q) += factor * a(i, j) * b(k, l);
    }
  }
}

/// Adds factor · A ⊙ A, (A ⊙ A)_ijkl = ½(A_ik A_jl + A_il A_jk): for A = I the identity on symmetric tensors.
inline void add_symmetric_product(const Tensor& a, double factor, StressTangent& result) {
  for (int p = 0; p < 6; ++p) {
    const auto [i, j] = tangent_components[std::size_t(p)];
    for (int q = 0; q < 6; ++q) {
      const auto [k, l] = tangent_components[std::size_t(q)];
      result(p, q) += 0.5 * factor * (a(i, k) * a(j, l) + a(i, l) * a(j, k));
    }
  }
}

/// Volumetric energy (K/4)(J² − 1 − 2 ln J) and its derivatives, as functions of s = J² − 1.
struct VolumetricEnergy {
  double modulus = 0.0;

  [[nodiscard]] double energy(double s) const { return 0.25 * modulus * logarithm_remainder(s); }
  /// Factor of C⁻¹ in S.
  [[nodiscard]] double stress_factor(double s) const { return 0.5 * modulus * s; }
  void add_tangent(double s, const Tensor& inverse, StressTangent& result) const {
    add_dyad(inverse, inverse, modulus * (1.0 + s), result);
    add_symmetric_product(inverse, -modulus * s, result);
  }
};

}  // namespace ricochet
