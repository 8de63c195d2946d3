#pragma once

#include "ricochet/fem/finite_strain.hpp"
#include "ricochet/fem/symmetric_tensor.hpp"

/// @file Base of laws that are written once for a single point and for packs of points. Such a law has
///   `template <class T> typename T::Number density(const T& strain) const` and
///   `template <class T> T stress_at(const T& strain) const`,
/// both RICOCHET_PART_OF_CALLER, with T a SpaceTensor or a PlaneTensor. Included by source files only.
namespace ricochet {

/// Invariants common to formulas of finite strain, in terms of A = 2E (C = I + A): s = J² − 1 = tr
/// A + r, with r of second order.
template <class T>
struct StrainMeasures {
  using Number = typename T::Number;
  T twice, adjugate;     ///< A, adj A
  Number trace;          ///< tr A
  Number remainder;      ///< r = tr adj A + det A
  Number volume_change;  ///< s
  /// C⁻¹ = adj C/J², adj C = (1 + tr A) I − A + adj A, times a number.
  RICOCHET_PART_OF_CALLER T inverse(const Number& factor) const {
    const Number scale = factor / (1.0 + volume_change);
    return combination(scale, adjugate, -scale, twice, scale * (1.0 + trace));
  }
};
template <class T>
RICOCHET_PART_OF_CALLER StrainMeasures<T> measures_of(const T& strain) {
  using Number = typename T::Number;
  StrainMeasures<T> result;
  result.twice = combination(Number{} + 2.0, strain, Number{});
  result.adjugate = adjugate(result.twice);
  result.trace = trace(result.twice);
  result.remainder = trace(result.adjugate) + determinant(result.twice, result.adjugate);
  result.volume_change = result.trace + result.remainder;
  return result;
}

/// x − ln(1 + x), to the precision of x. With j = √(1+x) − 1 it is j² + 2 (j − ln(1+j)), which reduces x to values near
/// zero.
template <class Number>
RICOCHET_PART_OF_CALLER Number logarithm_rest(const Number& of) {
  if constexpr (std::is_same_v<Number, double>) {
    return logarithm_remainder(of);
  } else {
    constexpr int most_roots = 5;  // for 1 + x between 1/20 and 20
    constexpr double near = 0.1;
    Number x = of, sum{};
    double factor = 1.0;
    for (int root = 0; root < most_roots && any_of((x > near) | (x < -near)); ++root) {
      x = x / (1.0 + square_root(1.0 + x));
      sum += factor * (x * x);
      factor *= 2.0;
    }
    const Number t = x / (2.0 + x), square = t * t;
    Number series = Number{} + 1.0 / 17.0;
    for (int k = 15; k >= 3; k -= 2) series = 1.0 / k + square * series;
    sum += factor * (x * t - 2.0 * t * square * series);
    const auto outside = !((x <= near) & (x >= -near));
    if (any_of(outside)) {
      for (int i = 0; i < lane_count<Number>; ++i) {
        if (outside[i] != 0) sum[i] = of[i] - std::log1p(of[i]);
      }
    }
    return sum;
  }
}

/// (1 + x)^(−1/3). For packs by Newton's method, r ← r + r (1 − (1+x) r³)/3.
template <class Number>
RICOCHET_PART_OF_CALLER Number inverse_cube_root(const Number& x) {
  if constexpr (std::is_same_v<Number, double>) {
    return std::cbrt(1.0 / (1.0 + x));
  } else {
    const auto outside = !((x >= -0.5) & (x <= 1.5));
    const Number volume = 1.0 + x;
    Number root = (1.0 + x * (1.0 / 3.0)) / (1.0 + x * (2.0 / 3.0));
    for (int step = 0; step < 4; ++step) root += root * (1.0 - volume * (root * root * root)) * (1.0 / 3.0);
    if (any_of(outside)) {
      for (int i = 0; i < lane_count<Number>; ++i) {
        if (outside[i] != 0) root[i] = std::cbrt(1.0 / volume[i]);
      }
    }
    return root;
  }
}

template <class Law>
class PackedLaw : public MaterialLaw {
 public:
  [[nodiscard]] double energy(const Tensor& strain) const final { return own().density(in_space(strain)); }
  void stress(const Tensor& strain, Tensor& result) const final {
    const SpaceTensor<double> s = own().stress_at(in_space(strain));
    result << s.xx, s.xy, s.zx, s.xy, s.yy, s.yz, s.zx, s.yz, s.zz;
  }
  void energies(const StrainPacks& strains, double* result) const final {
    run_in_packs(Energies{own(), strains, result});
  }
  void stresses(const StrainPacks& strains, double* result) const final {
    run_in_packs(Stresses{own(), strains, result});
  }

 private:
  [[nodiscard]] const Law& own() const { return static_cast<const Law&>(*this); }
  static SpaceTensor<double> in_space(const Tensor& a) {
    return {a(0, 0), a(1, 1), a(2, 2), a(0, 1), a(1, 2), a(2, 0)};
  }

  struct Energies {
    const Law& law;
    const StrainPacks& strains;
    double* result;
    template <class T>
    RICOCHET_PART_OF_CALLER void of() const {
      constexpr int width = lane_count<typename T::Number>;
      for (Index p = 0; p < strains.count; ++p)
        store<width>(result + p * width, law.density(load_tensor<T>(strains.values + p * T::components * width)));
    }
    template <int W>
    RICOCHET_PART_OF_CALLER void run() const {
      strains.in_plane ? of<PlaneTensor<Pack<W>>>() : of<SpaceTensor<Pack<W>>>();
    }
  };
  struct Stresses {
    const Law& law;
    const StrainPacks& strains;
    double* result;
    template <class T>
    RICOCHET_PART_OF_CALLER void of() const {
      constexpr int size = T::components * lane_count<typename T::Number>;
      for (Index p = 0; p < strains.count; ++p)
        store_tensor(result + p * size, law.stress_at(load_tensor<T>(strains.values + p * size)));
    }
    template <int W>
    RICOCHET_PART_OF_CALLER void run() const {
      strains.in_plane ? of<PlaneTensor<Pack<W>>>() : of<SpaceTensor<Pack<W>>>();
    }
  };
};

}  // namespace ricochet
