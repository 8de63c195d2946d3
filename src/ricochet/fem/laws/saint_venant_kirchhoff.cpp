#include "ricochet/fem/laws/elastic_constants.hpp"
#include "ricochet/fem/laws/quadratic_law.hpp"

namespace ricochet {

namespace {

/// Linear elasticity in Green's strain, invariant under rotations. For small strains only: the force on a bar in
/// compression has its maximum at the stretch 1/√3 and decreases beyond it.
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
  return {"saint-venant-kirchhoff", {make}, elastic_constant_keys(), elastic_constant_pairs(), check_elastic_constants};
}

}  // namespace ricochet
