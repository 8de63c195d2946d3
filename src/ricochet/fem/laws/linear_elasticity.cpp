#include "ricochet/fem/finite_strain.hpp"
#include "ricochet/fem/laws/elastic_constants.hpp"

namespace ricochet {

namespace {

/// W = ½λ (tr ε)² + μ ε : ε of the small strain ε.
class LinearElasticityLaw final : public MaterialLaw {
 public:
  LinearElasticityLaw(double lambda, double mu) : constants_{lambda, mu} {}

  [[nodiscard]] double lambda() const override { return constants_.lambda; }
  [[nodiscard]] double mu() const override { return constants_.mu; }
  [[nodiscard]] std::optional<IsotropicElasticity> constant_tangent(bool plane_stress) const override {
    return IsotropicElasticity::of(constants_.lambda, constants_.mu, plane_stress);
  }
  [[nodiscard]] double energy(const Tensor& strain) const override { return constants_.energy(strain); }
  void stress(const Tensor& strain, Tensor& result) const override { constants_.stress(strain, result); }
  void tangent(const Tensor&, StressTangent& result) const override {
    result.setZero();
    add_dyad(Tensor::Identity(), Tensor::Identity(), constants_.lambda, result);
    add_symmetric_product(Tensor::Identity(), 2.0 * constants_.mu, result);
  }

 private:
  IsotropicElasticity constants_;
};

}  // namespace

std::unique_ptr<MaterialLaw> make_linear_elasticity(double lambda, double mu) {
  return std::make_unique<LinearElasticityLaw>(lambda, mu);
}

MaterialLawRegistration linear_elasticity_law() {
  const auto make = [](const Parameters& parameters) {
    const auto [lambda, mu] = elastic_constants(parameters);
    return make_linear_elasticity(lambda, mu);
  };
  return {"linear", make, elastic_constant_keys(), elastic_constant_pairs(), check_elastic_constants};
}

}  // namespace ricochet
