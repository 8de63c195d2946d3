#include "ricochet/fem/finite_strain.hpp"
#include "ricochet/fem/laws/elastic_constants.hpp"

namespace ricochet {

namespace {

/// W = (μ/2)(tr C − 3 − 2 ln J) + (λ/4)(J² − 1 − 2 ln J), polyconvex, and infinite where a volume vanishes
/// (P. G. Ciarlet, Mathematical Elasticity I, North-Holland 1988, section 4.10). With s = J² − 1,
///   S = μ(I − C⁻¹) + ½λ s C⁻¹,   I − C⁻¹ = 2 E C⁻¹.
class NeoHookean final : public MaterialLaw {
 public:
  explicit NeoHookean(const ElasticConstants& constants) : mu_(constants.mu), volume_{constants.lambda} {}

  [[nodiscard]] double lambda() const override { return volume_.modulus; }
  [[nodiscard]] double mu() const override { return mu_; }
  [[nodiscard]] double volumetric_modulus() const override { return volume_.modulus; }
  [[nodiscard]] double energy(const Tensor& strain) const override {
    const Tensor twice = 2.0 * strain;
    const double s = determinant_change(twice);
    // tr C − 3 − 2 ln J = (tr 2E − s) + (s − ln(1+s)).
    return 0.5 * mu_ * (logarithm_remainder(s) - determinant_remainder(twice)) + volume_.energy(s);
  }
  void stress(const Tensor& strain, Tensor& result) const override {
    const double s = determinant_change(2.0 * strain);
    const Tensor inverse = inverse_metric(strain);
    const Tensor along = product(strain, inverse);
    const double pressure = volume_.stress_factor(s);
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i) result(i, j) = mu_ * (along(i, j) + along(j, i)) + pressure * inverse(i, j);
    }
  }
  void tangent(const Tensor& strain, StressTangent& result) const override {
    const Tensor inverse = inverse_metric(strain);
    result.setZero();
    add_symmetric_product(inverse, 2.0 * mu_, result);
    volume_.add_tangent(determinant_change(2.0 * strain), inverse, result);
  }

 private:
  double mu_;
  VolumetricEnergy volume_;
};

}  // namespace

MaterialLawRegistration neo_hookean_law() {
  const auto make = [](const Parameters& parameters) {
    return std::make_unique<NeoHookean>(elastic_constants(parameters));
  };
  return {"neo-hookean", make, elastic_constant_keys(), elastic_constant_pairs(), check_elastic_constants};
}

}  // namespace ricochet
