#include "ricochet/fem/packed_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

/// @file Laws evaluated on packs of points, and the functions that they use.
namespace ricochet {
namespace {

struct PackedCase {
  std::string name;
  Parameters parameters;
};

const std::vector<PackedCase>& packed_laws() {
  static const std::vector<PackedCase> all{{"linear", {{"lambda", 1.3}, {"mu", 0.8}}},
                                           {"saint-venant-kirchhoff", {{"lambda", 1.3}, {"mu", 0.8}}},
                                           {"neo-hookean", {{"lambda", 1.3}, {"mu", 0.8}}},
                                           {"mooney-rivlin", {{"c10", 0.3}, {"c01", 0.1}, {"bulk_modulus", 2.0}}}};
  return all;
}

/// Green's strains of random gradients in successive packs; sizes from 1e-12 to 1.5 side by side, so that some retain a
/// tenth of their volume and some grow tenfold.
class RandomStrains {
 public:
  RandomStrains(Index count, bool in_plane) : packs_{nullptr, count, pack_width(), in_plane} {
    std::mt19937 generator(11);
    std::uniform_real_distribution<double> random(-1.0, 1.0), exponent(-12.0, 0.2);
    values_.resize(std::size_t(count * packs_.components() * packs_.width));
    for (Index p = 0; p < count * packs_.width; ++p) {
      const double size = std::pow(10.0, exponent(generator));
      Tensor gradient = Tensor::Zero();
      do {
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) gradient(i, j) = !in_plane || (i < 2 && j < 2) ? size * random(generator) : 0.0;
        }
        if (in_plane) gradient(2, 2) = size * random(generator);
      } while (!(determinant(Tensor::Identity() + gradient) > 0.01));
      strains_.push_back(green_strain(gradient));
      const Index pack = p / packs_.width, lane = p % packs_.width;
      const int components[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
      for (int k = 0; k < packs_.components(); ++k)
        values_[std::size_t((pack * packs_.components() + k) * packs_.width + lane)] =
            strains_.back()(components[k][0], components[k][1]);
    }
    packs_.values = values_.data();
  }
  [[nodiscard]] const StrainPacks& packs() const { return packs_; }
  [[nodiscard]] const std::vector<Tensor>& strains() const { return strains_; }

 private:
  StrainPacks packs_;
  std::vector<double> values_;
  std::vector<Tensor> strains_;
};

/// A law without loops over packs: the default of MaterialLaw evaluates point by point.
class OnePointAfterAnother final : public MaterialLaw {
 public:
  explicit OnePointAfterAnother(const MaterialLaw& law) : law_(law) {}
  [[nodiscard]] double lambda() const override { return law_.lambda(); }
  [[nodiscard]] double mu() const override { return law_.mu(); }
  [[nodiscard]] double energy(const Tensor& strain) const override { return law_.energy(strain); }
  void stress(const Tensor& strain, Tensor& result) const override { law_.stress(strain, result); }
  void tangent(const Tensor& strain, StressTangent& result) const override { law_.tangent(strain, result); }

 private:
  const MaterialLaw& law_;
};

/// Packs round sums in another order: a few units in the last digit of the strain's own stress, which a determinant
/// near zero enlarges by its inverse.
TEST(PackedLaw, HasOfPacksWhatItHasOfEachPoint) {
  constexpr Index count = 100;
  for (const bool in_plane : {false, true}) {
    const RandomStrains random(count, in_plane);
    const int width = random.packs().width, components = random.packs().components();
    std::vector<double> energies(static_cast<std::size_t>(count * width)), stresses(energies.size() * 6);
    for (const PackedCase& each : packed_laws()) {
      const auto law = make_material_law(each.name, each.parameters);
      const OnePointAfterAnother slow(*law);
      for (const MaterialLaw* const asked :
           {static_cast<const MaterialLaw*>(law.get()), static_cast<const MaterialLaw*>(&slow)}) {
        asked->energies(random.packs(), energies.data());
        asked->stresses(random.packs(), stresses.data());
        for (std::size_t p = 0; p < energies.size(); ++p) {
          const Tensor& strain = random.strains()[p];
          const double volume = 1.0 + determinant_change(2.0 * strain);
          const double tolerance = 1e-14 * std::max(1.0, std::pow(strain.norm(), 3) / volume);
          Tensor wanted, found = Tensor::Zero();
          law->stress(strain, wanted);
          const std::size_t lane = p % std::size_t(width);
          const double* at = stresses.data() + (p - lane) * std::size_t(components) + lane;
          const int places[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
          for (int k = 0; k < components; ++k, at += width)
            found(places[k][0], places[k][1]) = found(places[k][1], places[k][0]) = *at;
          EXPECT_LT((found - wanted).norm(), tolerance * wanted.norm()) << each.name << " " << strain;
          EXPECT_NEAR(energies[p], law->energy(strain), tolerance * law->energy(strain)) << each.name << " " << strain;
        }
      }
    }
  }
}

/// In long doubles, over all volumes; for small x its square holds the digits.
TEST(PackedLaw, FunctionsOfPacksHaveAllDigits) {
  using Number = Pack<4>;
  const double values[] = {1e-12, -1e-12, 1e-7,  -1e-5, 0.05, -0.05,  0.0999, 0.1001, -0.1001, 0.3,   -0.3,        0.7,
                           1.499, 1.501,  -0.49, -0.51, 3.0,  -0.900, 19.0,   30.0,   1e6,     -0.99, -1.0 + 1e-9, 0.0};
  for (std::size_t first = 0; first < std::size(values); first += 4) {
    const Number x = load<4>(values + first), rest = logarithm_rest(x), root = inverse_cube_root(x);
    for (int i = 0; i < 4; ++i) {
      const long double exact = x[i];
      const long double logarithm = std::abs(x[i]) < 1e-3 ? exact * exact * (0.5L - exact / 3.0L + exact * exact / 4.0L)
                                                          : exact - std::log1p(exact);
      EXPECT_NEAR(rest[i], double(logarithm), 1.5e-15 * double(logarithm)) << x[i];
      const auto wanted = double(std::pow(1.0L + exact, -1.0L / 3.0L));
      EXPECT_NEAR(root[i], wanted, 5e-16 * wanted) << x[i];
    }
  }
}

/// A negative volume has no energy.
TEST(PackedLaw, IsNotFiniteWhereTheVolumeIsNegative) {
  std::vector<double> strains(static_cast<std::size_t>(6 * pack_width()), 0.0), energies(strains.size() / 6);
  std::fill_n(strains.begin(), pack_width(), -0.6);
  for (const std::string name : {"neo-hookean", "mooney-rivlin"}) {
    const PackedCase& each = name == "neo-hookean" ? packed_laws()[2] : packed_laws()[3];
    make_material_law(each.name, each.parameters)->energies({strains.data(), 1, pack_width(), false}, energies.data());
    for (const double energy : energies) EXPECT_FALSE(std::isfinite(energy)) << name;
  }
}

}  // namespace
}  // namespace ricochet
