#pragma once

#include "ricochet/fem/packed_law.hpp"

/// @file Laws whose energy is quadratic in their strain, small or Green's.
namespace ricochet {

/// W = ½λ (tr E)² + μ E : E.
class QuadraticLaw : public PackedLaw<QuadraticLaw> {
 public:
  QuadraticLaw(double lambda, double mu) : constants_{lambda, mu} {}

  [[nodiscard]] double lambda() const final { return constants_.lambda; }
  [[nodiscard]] double mu() const final { return constants_.mu; }
  template <class T>
  RICOCHET_PART_OF_CALLER typename T::Number density(const T& strain) const {
    const auto dilatation = trace(strain);
    return 0.5 * constants_.lambda * dilatation * dilatation + constants_.mu * double_dot(strain, strain);
  }
  template <class T>
  RICOCHET_PART_OF_CALLER T stress_at(const T& strain) const {
    return linear_stress(constants_, strain);
  }
  void tangent(const Tensor&, StressTangent& result) const final {
    result.setZero();
    add_dyad(Tensor::Identity(), Tensor::Identity(), constants_.lambda, result);
    add_symmetric_product(Tensor::Identity(), 2.0 * constants_.mu, result);
  }

 private:
  IsotropicElasticity constants_;
};

}  // namespace ricochet
