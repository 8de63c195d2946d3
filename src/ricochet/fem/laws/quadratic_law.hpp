#pragma once

#include "ricochet/fem/finite_strain.hpp"

/// @file Laws whose energy is quadratic in the strain they are given: small or Green's.
namespace ricochet {

/// W = ½λ (tr E)² + μ E : E.
class QuadraticLaw : public MaterialLaw {
 public:
  QuadraticLaw(double lambda, double mu) : constants_{lambda, mu} {}

  [[nodiscard]] double lambda() const final { return constants_.lambda; }
  [[nodiscard]] double mu() const final { return constants_.mu; }
  [[nodiscard]] double energy(const Tensor& strain) const final { return constants_.energy(strain); }
  void stress(const Tensor& strain, Tensor& result) const final { constants_.stress(strain, result); }
  void tangent(const Tensor&, StressTangent& result) const final {
    result.setZero();
    add_dyad(Tensor::Identity(), Tensor::Identity(), constants_.lambda, result);
    add_symmetric_product(Tensor::Identity(), 2.0 * constants_.mu, result);
  }

 private:
  IsotropicElasticity constants_;
};

}  // namespace ricochet
