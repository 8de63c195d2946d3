#pragma once

#include "ricochet/base/packs.hpp"
#include "ricochet/fem/isotropic_elasticity.hpp"

/// @file Symmetric tensors whose components are doubles, or packs of them with one per point; used to write laws.
/// Included by source files only (packs.hpp). Not part of the public interface.
namespace ricochet {

/// Symmetric tensor in 3D.
template <class N>
struct SpaceTensor {
  using Number = N;
  static constexpr int components = 6;
  Number xx, yy, zz, xy, yz, zx;
};
/// Symmetric tensor in 2D sections: no shear across the plane.
template <class N>
struct PlaneTensor {
  using Number = N;
  static constexpr int components = 4;
  Number xx, yy, zz, xy;
};

/// Calls work(index, component) for the components, in the order above.
template <class N, class Work>
RICOCHET_PART_OF_CALLER void for_each_component(SpaceTensor<N>& a, const Work& work) {
  work(0, a.xx), work(1, a.yy), work(2, a.zz), work(3, a.xy), work(4, a.yz), work(5, a.zx);
}
template <class N, class Work>
RICOCHET_PART_OF_CALLER void for_each_component(PlaneTensor<N>& a, const Work& work) {
  work(0, a.xx), work(1, a.yy), work(2, a.zz), work(3, a.xy);
}

/// Loads a tensor from components stored as packs of W contiguous numbers.
template <class T>
RICOCHET_PART_OF_CALLER T load_tensor(const double* from) {
  constexpr int width = lane_count<typename T::Number>;
  T result;
  for_each_component(
      result, [&](int k, auto& component) RICOCHET_LAMBDA_OF_CALLER { component = load<width>(from + k * width); });
  return result;
}
template <class T>
RICOCHET_PART_OF_CALLER void store_tensor(double* to, const T& of) {
  constexpr int width = lane_count<typename T::Number>;
  T value = of;
  for_each_component(
      value, [&](int k, auto& component) RICOCHET_LAMBDA_OF_CALLER { store<width>(to + k * width, component); });
}

// Sums, differences and multiples.
template <class N, class Work>
RICOCHET_PART_OF_CALLER SpaceTensor<N> each_component(const SpaceTensor<N>& a, const SpaceTensor<N>& b,
                                                      const Work& work) {
  return {work(a.xx, b.xx), work(a.yy, b.yy), work(a.zz, b.zz), work(a.xy, b.xy), work(a.yz, b.yz), work(a.zx, b.zx)};
}
template <class N, class Work>
RICOCHET_PART_OF_CALLER PlaneTensor<N> each_component(const PlaneTensor<N>& a, const PlaneTensor<N>& b,
                                                      const Work& work) {
  return {work(a.xx, b.xx), work(a.yy, b.yy), work(a.zz, b.zz), work(a.xy, b.xy)};
}
template <class T, class N = typename T::Number>
RICOCHET_PART_OF_CALLER T operator+(const T& a, const T& b) {
  return each_component(a, b, [](const N& x, const N& y) RICOCHET_LAMBDA_OF_CALLER { return x + y; });
}
template <class T, class N = typename T::Number>
RICOCHET_PART_OF_CALLER T operator-(const T& a, const T& b) {
  return each_component(a, b, [](const N& x, const N& y) RICOCHET_LAMBDA_OF_CALLER { return x - y; });
}
template <class T, class N = typename T::Number>
RICOCHET_PART_OF_CALLER T operator*(double factor, const T& a) {
  return each_component(a, a, [factor](const N& x, const N&) RICOCHET_LAMBDA_OF_CALLER { return factor * x; });
}

template <class T>
RICOCHET_PART_OF_CALLER typename T::Number trace(const T& a) {
  return a.xx + a.yy + a.zz;
}

/// A : B.
template <class N>
RICOCHET_PART_OF_CALLER N double_dot(const SpaceTensor<N>& a, const SpaceTensor<N>& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2.0 * (a.xy * b.xy + a.yz * b.yz + a.zx * b.zx);
}
template <class N>
RICOCHET_PART_OF_CALLER N double_dot(const PlaneTensor<N>& a, const PlaneTensor<N>& b) {
  return a.xx * b.xx + a.yy * b.yy + a.zz * b.zz + 2.0 * (a.xy * b.xy);
}

/// adj A, with A adj A = det A I.
template <class N>
RICOCHET_PART_OF_CALLER SpaceTensor<N> adjugate(const SpaceTensor<N>& a) {
  return {a.yy * a.zz - a.yz * a.yz, a.zz * a.xx - a.zx * a.zx, a.xx * a.yy - a.xy * a.xy,
          a.yz * a.zx - a.xy * a.zz, a.zx * a.xy - a.yz * a.xx, a.xy * a.yz - a.zx * a.yy};
}
template <class N>
RICOCHET_PART_OF_CALLER PlaneTensor<N> adjugate(const PlaneTensor<N>& a) {
  return {a.yy * a.zz, a.zz * a.xx, a.xx * a.yy - a.xy * a.xy, -(a.xy * a.zz)};
}

/// det A, from A and its adjugate.
template <class N>
RICOCHET_PART_OF_CALLER N determinant(const SpaceTensor<N>& a, const SpaceTensor<N>& of_a) {
  return a.xx * of_a.xx + a.xy * of_a.xy + a.zx * of_a.zx;
}
template <class N>
RICOCHET_PART_OF_CALLER N determinant(const PlaneTensor<N>& a, const PlaneTensor<N>& of_a) {
  return a.zz * of_a.zz;
}

/// a A + b B + c I.
template <class N>
RICOCHET_PART_OF_CALLER SpaceTensor<N> combination(const N& a, const SpaceTensor<N>& first, const N& b,
                                                   const SpaceTensor<N>& second, const N& c) {
  return {a * first.xx + (b * second.xx + c), a * first.yy + (b * second.yy + c), a * first.zz + (b * second.zz + c),
          a * first.xy + b * second.xy,       a * first.yz + b * second.yz,       a * first.zx + b * second.zx};
}
template <class N>
RICOCHET_PART_OF_CALLER PlaneTensor<N> combination(const N& a, const PlaneTensor<N>& first, const N& b,
                                                   const PlaneTensor<N>& second, const N& c) {
  return {a * first.xx + (b * second.xx + c), a * first.yy + (b * second.yy + c), a * first.zz + (b * second.zz + c),
          a * first.xy + b * second.xy};
}

/// a A + c I.
template <class N>
RICOCHET_PART_OF_CALLER SpaceTensor<N> combination(const N& a, const SpaceTensor<N>& first, const N& c) {
  return {a * first.xx + c, a * first.yy + c, a * first.zz + c, a * first.xy, a * first.yz, a * first.zx};
}
template <class N>
RICOCHET_PART_OF_CALLER PlaneTensor<N> combination(const N& a, const PlaneTensor<N>& first, const N& c) {
  return {a * first.xx + c, a * first.yy + c, a * first.zz + c, a * first.xy};
}

template <class T>
RICOCHET_PART_OF_CALLER T deviator(const T& a) {
  using Number = typename T::Number;
  return combination(Number{} + 1.0, a, Number(trace(a) * (-1.0 / 3.0)));
}

/// λ tr A I + 2μ A.
template <class T>
RICOCHET_PART_OF_CALLER T linear_stress(const IsotropicElasticity& law, const T& strain) {
  using Number = typename T::Number;
  return combination(Number{} + 2.0 * law.mu, strain, Number(law.lambda * trace(strain)));
}

}  // namespace ricochet
