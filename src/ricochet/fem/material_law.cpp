#include "ricochet/fem/material_law.hpp"

namespace ricochet {

// The laws, each by the function of its own file that registers it. One line each, in the order of the documentation.
// clang-format off
#define RICOCHET_MATERIAL_LAWS(law) \
  law(linear_elasticity_law) \
  law(neo_hookean_law) \
  law(mooney_rivlin_law) \
  law(saint_venant_kirchhoff_law)
// clang-format on

RICOCHET_DEFINE_REGISTRY(material_law_registry, MaterialLawConstructor, "material law", RICOCHET_MATERIAL_LAWS)

std::unique_ptr<MaterialLaw> make_material_law(const std::string& name, Parameters parameters) {
  return material_law_registry().find(name, parameters).type(parameters);
}

}  // namespace ricochet
