#include "ricochet/fem/material_law.hpp"

#include <array>

namespace ricochet {

// The laws, each by the registration function of its own file. One line each, in the order of the documentation.
// clang-format off
#define RICOCHET_MATERIAL_LAWS(law) \
  law(linear_elasticity_law) \
  law(neo_hookean_law) \
  law(mooney_rivlin_law) \
  law(saint_venant_kirchhoff_law)
// clang-format on

RICOCHET_DEFINE_REGISTRY(material_law_registry, MaterialLawType, "material law", RICOCHET_MATERIAL_LAWS)

namespace {

/// Indices (i, j) of the components of StrainPacks.
constexpr std::array<std::array<int, 2>, 6> pack_components{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}}};

/// Calls work(number of the pack, lane, strain) for all points.
template <class Work>
void for_each_point(const StrainPacks& strains, const Work& work) {
  const double* from = strains.values;
  for (Index pack = 0; pack < strains.count; ++pack, from += strains.components() * strains.width) {
    for (int lane = 0; lane < strains.width; ++lane) {
      Tensor strain = Tensor::Zero();
      for (int k = 0; k < strains.components(); ++k) {
        const auto [i, j] = pack_components[std::size_t(k)];
        strain(i, j) = strain(j, i) = from[k * strains.width + lane];
      }
      work(pack, lane, strain);
    }
  }
}

}  // namespace

void MaterialLaw::energies(const StrainPacks& strains, double* result) const {
  for_each_point(strains, [&](Index pack, int lane, const Tensor& strain) {
    result[pack * strains.width + lane] = energy(strain);
  });
}

void MaterialLaw::stresses(const StrainPacks& strains, double* result) const {
  Tensor of_point;
  for_each_point(strains, [&](Index pack, int lane, const Tensor& strain) {
    stress(strain, of_point);
    double* const to = result + pack * strains.components() * strains.width + lane;
    for (int k = 0; k < strains.components(); ++k) {
      const auto [i, j] = pack_components[std::size_t(k)];
      to[k * strains.width] = of_point(i, j);
    }
  });
}

std::unique_ptr<MaterialLaw> make_material_law(const std::string& name, Parameters parameters) {
  return material_law_registry().find(name, parameters).type.make(parameters);
}

}  // namespace ricochet
