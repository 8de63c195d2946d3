#include "ricochet/fem/material_law.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <random>

#include "ricochet/base/error.hpp"
#include "ricochet/fem/finite_strain.hpp"
#include "ricochet/fem/point_law.hpp"

namespace ricochet {
namespace {

struct Law {
  std::string name;
  Parameters parameters;
};

const std::vector<Law>& laws() {
  static const std::vector<Law> all{{"linear", {{"lambda", 1.3}, {"mu", 0.8}}},
                                    {"linear", {{"young", 2.0}, {"poisson", 0.3}}},
                                    {"saint-venant-kirchhoff", {{"young", 2.0}, {"poisson", 0.3}}},
                                    {"neo-hookean", {{"lambda", 1.3}, {"mu", 0.8}}},
                                    {"mooney-rivlin", {{"c10", 0.3}, {"c01", 0.1}, {"bulk_modulus", 2.0}}}};
  return all;
}

Tensor random_gradient(unsigned seed, double size = 0.2) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> random(-size, size);
  Tensor result;
  for (double& entry : result.reshaped()) entry = random(generator);
  return result;
}

Tensor random_strain(unsigned seed, double size = 0.2) {
  const Tensor gradient = random_gradient(seed, size);
  return 0.5 * (gradient + gradient.transpose());
}

/// Changes one component of a symmetric tensor; dE_ij and dE_ji together.
Tensor changed(const Tensor& strain, int component, double by) {
  const auto [i, j] = tangent_components[std::size_t(component)];
  Tensor result = strain;
  result(i, j) += 0.5 * by;
  result(j, i) += 0.5 * by;
  return result;
}

/// Stress is the derivative of the energy and the tangent that of the stress, for every law in every state.
TEST(MaterialLaw, StressAndTangentAreDerivatives) {
  constexpr double h = 1e-6;
  for (const Law& each : laws()) {
    const auto law = make_material_law(each.name, each.parameters);
    EXPECT_EQ(law->volumetric_modulus() > 0.0, material_law_registry().find(each.name).type.has_volumetric_energy);
    for (const unsigned seed : {7U, 8U, 9U}) {
      const Tensor strain = random_strain(seed);
      Tensor stress, before, after;
      StressTangent tangent;
      law->stress(strain, stress);
      law->tangent(strain, tangent);
      EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-13) << each.name;
      EXPECT_EQ(stress, Tensor(stress.transpose())) << each.name;
      for (int c = 0; c < 6; ++c) {
        const auto [i, j] = tangent_components[std::size_t(c)];
        const Tensor low = changed(strain, c, -h), high = changed(strain, c, h);
        EXPECT_NEAR((law->energy(high) - law->energy(low)) / (2.0 * h), stress(i, j), 1e-8) << each.name;
        law->stress(low, before);
        law->stress(high, after);
        const Tensor change = (after - before) / (2.0 * h);
        for (int p = 0; p < 6; ++p) {
          const auto [k, l] = tangent_components[std::size_t(p)];
          EXPECT_NEAR(change(k, l), tangent(p, c), 1e-7) << each.name << " " << p << c;
        }
      }
    }
  }
}

/// Every law is linear elasticity with its Lamé parameters at small strains, to all digits that a strain of 1e-9 has.
TEST(MaterialLaw, IsLinearElasticityWhereStrainsAreSmall) {
  for (const Law& each : laws()) {
    const auto law = make_material_law(each.name, each.parameters);
    const IsotropicElasticity linear{law->lambda(), law->mu()};
    for (const double size : {1e-5, 1e-9, 1e-12}) {
      const Tensor strain = random_strain(3, size);
      Tensor stress, wanted;
      law->stress(strain, stress);
      linear.stress(strain, wanted);
      // The next term of the series, plus rounding.
      EXPECT_LT((stress - wanted).norm(), (20.0 * size + 1e-14) * wanted.norm()) << each.name;
      EXPECT_NEAR(law->energy(strain), linear.energy(strain), (20.0 * size + 1e-14) * linear.energy(strain))
          << each.name;
    }
  }
}

/// The textbook formulas, with the invariants of C = FᵀF.
TEST(MaterialLaw, HasTheEnergyOfItsInvariants) {
  const Tensor gradient = random_gradient(5, 0.4), f = Tensor::Identity() + gradient, c = f.transpose() * f;
  const double j = f.determinant(), first = c.trace(), second = 0.5 * (first * first - (c * c).trace());
  ASSERT_GT(j, 0.0);
  const Tensor strain = green_strain(gradient);
  const auto energy = [&](const std::string& name, const Parameters& parameters) {
    return make_material_law(name, parameters)->energy(strain);
  };
  const double volumetric = j * j - 1.0 - 2.0 * std::log(j);
  EXPECT_NEAR(energy("neo-hookean", {{"lambda", 1.3}, {"mu", 0.8}}),
              0.4 * (first - 3.0 - 2.0 * std::log(j)) + 1.3 / 4.0 * volumetric, 1e-14);
  EXPECT_NEAR(
      energy("mooney-rivlin", {{"c10", 0.3}, {"c01", 0.1}, {"bulk_modulus", 2.0}}),
      0.3 * (first * std::pow(j, -2.0 / 3.0) - 3.0) + 0.1 * (second * std::pow(j, -4.0 / 3.0) - 3.0) + 0.5 * volumetric,
      1e-14);
  EXPECT_NEAR(energy("saint-venant-kirchhoff", {{"lambda", 1.3}, {"mu", 0.8}}),
              0.65 * std::pow(strain.trace(), 2) + 0.8 * strain.squaredNorm(), 1e-15);
}

/// A rotation changes neither strain nor energy: Green's strain of Q F is that of F.
TEST(MaterialLaw, SeesNoRotation) {
  const Tensor gradient = random_gradient(4);
  const Tensor rotation = Eigen::AngleAxisd(2.1, Eigen::Vector3d(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
  const Tensor turned = rotation * (Tensor::Identity() + gradient) - Tensor::Identity();
  EXPECT_LT((green_strain(turned) - green_strain(gradient)).norm(), 1e-15);
}

/// The stress across the plane vanishes, and the tangent is condensed accordingly.
TEST(PointLaw, PlaneStressHasNoStressAcrossThePlane) {
  constexpr double h = 1e-6;
  for (const Law& each : laws()) {
    const auto law = make_material_law(each.name, each.parameters);
    const PointLaw point(*law, true);
    Tensor gradient = random_gradient(6, 0.3);
    gradient.row(2).setZero();
    gradient.col(2).setZero();
    const Tensor strain = point.strain(gradient);
    Tensor stress, before, after;
    point.stress(strain, stress);
    EXPECT_NEAR(stress(2, 2), 0.0, 1e-14) << each.name;
    StressTangent tangent;
    point.tangent(strain, tangent);
    if (!law->is_linear()) continue;
    // ∂S/∂E in the plane equals the tangent of the plane-stress law.
    const IsotropicElasticity section = *law->constant_tangent(true);
    EXPECT_NEAR(tangent(0, 1), section.lambda, 1e-14);
    EXPECT_NEAR(tangent(0, 0), section.lambda + 2.0 * section.mu, 1e-14);
  }
  // Differences of the stress, with the thickness solved again.
  const auto law = make_material_law("neo-hookean", {{"lambda", 1.3}, {"mu", 0.8}});
  const PointLaw point(*law, true);
  Tensor gradient = Tensor::Zero();
  gradient(0, 0) = 0.3;
  gradient(1, 1) = -0.1;
  StressTangent tangent;
  point.tangent(point.strain(gradient), tangent);
  Tensor low = gradient, high = gradient, before, after;
  low(0, 0) -= h;
  high(0, 0) += h;
  point.stress(point.strain(low), before);
  point.stress(point.strain(high), after);
  const double slope = 1.0 + gradient(0, 0);  // dE_xx = (1 + H_xx) dH_xx
  EXPECT_NEAR((after(0, 0) - before(0, 0)) / (2.0 * h), tangent(0, 0) * slope, 1e-7);
  EXPECT_NEAR((after(1, 1) - before(1, 1)) / (2.0 * h), tangent(1, 0) * slope, 1e-7);
}

TEST(FiniteStrain, RemaindersHaveAllDigits) {
  for (const double x : {1e-12, -1e-6, 0.05, -0.0999, 0.1001, 3.0, -0.9}) {
    const auto exact = double(static_cast<long double>(x) - std::log1p(static_cast<long double>(x)));
    // Cancellation in long doubles leaves 1e-19/|x|.
    const double tolerance = 1e-19 / std::abs(x) + 1e-15 * exact;
    EXPECT_NEAR(logarithm_remainder(x), exact, tolerance + 1e-19 * std::abs(x)) << x;
  }
  EXPECT_NEAR(logarithm_remainder(1e-9), 0.5e-18 * (1.0 - 2e-9 / 3.0), 1e-33);
}

TEST(MaterialLaw, IsMadeFromEitherPairOfParameters) {
  for (const std::string name : {"linear", "neo-hookean", "saint-venant-kirchhoff"}) {
    const auto law = make_material_law(name, {{"young", 2.5}, {"poisson", 0.25}});
    EXPECT_DOUBLE_EQ(law->lambda(), 1.0);
    EXPECT_DOUBLE_EQ(law->mu(), 1.0);
  }
  EXPECT_THROW((void)make_material_law("rubber", {}), Error);
  EXPECT_THROW((void)make_material_law("linear", {{"lambda", 1.0}}), Error);
  EXPECT_THROW((void)make_material_law("mooney-rivlin", {{"c10", 1.0}, {"c01", 0.0}}), Error);
}

}  // namespace
}  // namespace ricochet
