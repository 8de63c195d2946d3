#include <fmt/format.h>

#include <cmath>

#include "ricochet/fem/material_law.hpp"

namespace ricochet {

namespace {

class LinearElasticityLaw final : public MaterialLaw {
 public:
  LinearElasticityLaw(double lambda, double mu) : lambda_(lambda), mu_(mu) {}

  [[nodiscard]] double lambda() const override { return lambda_; }
  [[nodiscard]] double mu() const override { return mu_; }
  [[nodiscard]] std::optional<IsotropicElasticity> constant_tangent(bool plane_stress) const override {
    return IsotropicElasticity::of(lambda_, mu_, plane_stress);
  }
  [[nodiscard]] double energy(const Matrix& gradient, bool plane_stress) const override {
    return constant_tangent(plane_stress)->energy(strain(gradient));
  }
  void stress(const Matrix& gradient, bool plane_stress, Matrix& result) const override {
    constant_tangent(plane_stress)->stress(strain(gradient), result);
  }
  void tangent(const Matrix& gradient, bool plane_stress, Matrix& result) const override {
    const Index d = gradient.rows();
    const double lambda = constant_tangent(plane_stress)->lambda;
    result.setZero(d * d, d * d);
    for (Index i = 0; i < d; ++i) {
      for (Index j = 0; j < d; ++j) {
        result(i + d * i, j + d * j) += lambda;
        result(i + d * j, i + d * j) += mu_;
        result(i + d * j, j + d * i) += mu_;
      }
    }
  }

 private:
  [[nodiscard]] static Matrix strain(const Matrix& gradient) { return 0.5 * (gradient + gradient.transpose()); }

  double lambda_, mu_;
};

std::vector<Key> elasticity_keys() {
  return {{.name = "lambda",
           .type = KeyType::number,
           .unit = "stress",
           .doc = "First Lamé parameter; 3 lambda + 2 mu must be positive."},
          {.name = "mu",
           .type = KeyType::number,
           .unit = "stress",
           .range = positive,
           .doc = "Second Lamé parameter, the shear modulus."},
          {.name = "young", .type = KeyType::number, .unit = "stress", .range = positive, .doc = "Young's modulus."},
          {.name = "poisson",
           .type = KeyType::number,
           .unit = "1",
           .range = {.above = -1.0, .below = 0.5},
           .doc = "Poisson's ratio."}};
}

/// Of E and ν.
struct LameParameters {
  double lambda, mu;
};
LameParameters lame_parameters(double young, double poisson) {
  return {young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson))};
}

void check_elasticity(const ParameterCheck& place, Parameters& values) {
  if (place.is_usable("lambda") && place.is_usable("mu")) {
    const double bulk = 3.0 * values.number("lambda") + 2.0 * values.number("mu");
    if (!(bulk > 0.0)) {
      place.add_problem(
          "lambda",
          fmt::format("3 lambda + 2 mu must be positive (the bulk modulus is a third of it); it is {}", bulk));
    }
  }
  if (!place.is_usable("young") || !place.is_usable("poisson")) return;
  const double young = values.number("young"), poisson = values.number("poisson");
  const LameParameters lame = lame_parameters(young, poisson);
  if (!std::isfinite(lame.lambda) || !std::isfinite(lame.mu)) {
    place.add_problem("poisson", fmt::format("young = {} and poisson = {} give infinite lambda or mu", young, poisson));
  }
}

}  // namespace

std::unique_ptr<MaterialLaw> make_linear_elasticity(double lambda, double mu) {
  return std::make_unique<LinearElasticityLaw>(lambda, mu);
}

MaterialLawRegistration linear_elasticity_law() {
  const auto make = [](const Parameters& parameters) {
    if (!parameters.has("young")) return make_linear_elasticity(parameters.number("lambda"), parameters.number("mu"));
    const LameParameters lame = lame_parameters(parameters.number("young"), parameters.number("poisson"));
    return make_linear_elasticity(lame.lambda, lame.mu);
  };
  return {"linear", make, elasticity_keys(), {{"lambda", "mu"}, {"young", "poisson"}}, check_elasticity};
}

}  // namespace ricochet
