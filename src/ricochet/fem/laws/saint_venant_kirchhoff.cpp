#include "ricochet/fem/finite_strain.hpp"
#include "ricochet/fem/laws/elastic_constants.hpp"

namespace ricochet {

namespace {

/// W = ½λ (tr E)² + μ E : E of Green's strain: linear elasticity that rotations do not change. For small strains only:
/// a bar under compression has its largest force at the stretch 1/√3, and beyond it has less and less.
class SaintVenantKirchhoff final : public MaterialLaw {
 public:
  explicit SaintVenantKirchhoff(const ElasticConstants& constants) : constants_{constants.lambda, constants.mu} {}

  [[nodiscard]] double lambda() const override { return constants_.lambda; }
  [[nodiscard]] double mu() const override { return constants_.mu; }
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

MaterialLawRegistration saint_venant_kirchhoff_law() {
  const auto make = [](const Parameters& parameters) {
    return std::make_unique<SaintVenantKirchhoff>(elastic_constants(parameters));
  };
  return {"saint-venant-kirchhoff", make, elastic_constant_keys(), elastic_constant_pairs(), check_elastic_constants};
}

}  // namespace ricochet
