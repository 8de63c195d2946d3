#include "ricochet/fem/laws/elastic_constants.hpp"
#include "ricochet/fem/laws/quadratic_law.hpp"

namespace ricochet {

namespace {

/// Law of small strain.
class LinearElasticityLaw final : public QuadraticLaw {
 public:
  using QuadraticLaw::QuadraticLaw;
  [[nodiscard]] std::optional<IsotropicElasticity> constant_tangent(bool plane_stress) const override {
    return IsotropicElasticity::of(lambda(), mu(), plane_stress);
  }
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
  return {"linear", {make}, elastic_constant_keys(), elastic_constant_pairs(), check_elastic_constants};
}

}  // namespace ricochet
