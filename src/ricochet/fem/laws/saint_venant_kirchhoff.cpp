#include "ricochet/fem/laws/elastic_constants.hpp"
#include "ricochet/fem/laws/quadratic_law.hpp"

namespace ricochet {

namespace {

/// Of Green's strain: linear elasticity that rotations do not change. For small strains only: a bar under compression
/// has its largest force at the stretch 1/√3, and beyond it has less and less.
class SaintVenantKirchhoff final : public QuadraticLaw {
 public:
  using QuadraticLaw::QuadraticLaw;
};

}  // namespace

MaterialLawRegistration saint_venant_kirchhoff_law() {
  const auto make = [](const Parameters& parameters) {
    const auto [lambda, mu] = elastic_constants(parameters);
    return std::make_unique<SaintVenantKirchhoff>(lambda, mu);
  };
  return {"saint-venant-kirchhoff", make, elastic_constant_keys(), elastic_constant_pairs(), check_elastic_constants};
}

}  // namespace ricochet
