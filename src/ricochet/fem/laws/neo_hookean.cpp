#include "ricochet/fem/laws/elastic_constants.hpp"
#include "ricochet/fem/packed_law.hpp"

namespace ricochet {

namespace {

/// W = (μ/2)(tr C − 3 − 2 ln J) + (λ/4)(J² − 1 − 2 ln J), polyconvex, and infinite if a volume vanishes
/// (P. G. Ciarlet, Mathematical Elasticity I, North-Holland 1988, section 4.10). With s = J² − 1,
///   S = μ(I − C⁻¹) + ½λ s C⁻¹,   I − C⁻¹ = 2 E C⁻¹.
class NeoHookean final : public PackedLaw<NeoHookean> {
 public:
  explicit NeoHookean(const ElasticConstants& constants) : mu_(constants.mu), volume_{constants.lambda} {}

  [[nodiscard]] double lambda() const override { return volume_.modulus; }
  [[nodiscard]] double mu() const override { return mu_; }
  [[nodiscard]] double volumetric_modulus() const override { return volume_.modulus; }
  template <class T>
  RICOCHET_PART_OF_CALLER typename T::Number density(const T& strain) const {
    const StrainMeasures<T> of = measures_of(strain);
    // tr C − 3 − 2 ln J = (s − ln(1+s)) − r.
    const auto rest = logarithm_rest(of.volume_change);
    return 0.5 * mu_ * (rest - of.remainder) + 0.25 * volume_.modulus * rest;
  }
  template <class T>
  RICOCHET_PART_OF_CALLER T stress_at(const T& strain) const {
    using Number = typename T::Number;
    const StrainMeasures<T> of = measures_of(strain);
    // I − C⁻¹ = (A − adj A + r I)/J².
    const Number pressure = 0.5 * volume_.modulus * of.volume_change, scale = 1.0 / (1.0 + of.volume_change);
    const Number along = scale * (mu_ - pressure);
    return combination(along, of.twice, -along, of.adjugate,
                       scale * (mu_ * of.remainder + pressure * (1.0 + of.trace)));
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
  return {"neo-hookean", {make, true}, elastic_constant_keys(), elastic_constant_pairs(), check_elastic_constants};
}

}  // namespace ricochet
