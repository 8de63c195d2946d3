#include "ricochet/fem/material_law.hpp"

#include <gtest/gtest.h>

#include <random>

#include "ricochet/base/error.hpp"

namespace ricochet {
namespace {

struct Law {
  std::string name;
  Parameters parameters;
};

const std::vector<Law>& laws() {
  static const std::vector<Law> all{{"linear", {{"lambda", 1.3}, {"mu", 0.8}}},
                                    {"linear", {{"young", 2.0}, {"poisson", 0.3}}}};
  return all;
}

Matrix random_gradient(Index dimension, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> random(-0.2, 0.2);
  Matrix result(dimension, dimension);
  for (double& entry : result.reshaped()) entry = random(generator);
  return result;
}

/// Stress is the derivative of the energy, the tangent that of the stress: of every law, in every state.
TEST(MaterialLaw, StressAndTangentAreDerivatives) {
  constexpr double h = 1e-6;
  for (const Law& each : laws()) {
    const auto law = make_material_law(each.name, each.parameters);
    for (const Index d : {Index{2}, Index{3}}) {
      for (const bool plane_stress : {false, true}) {
        if (plane_stress && d == 3) continue;
        const Matrix gradient = random_gradient(d, 7);
        Matrix stress, tangent, before, after;
        law->stress(gradient, plane_stress, stress);
        law->tangent(gradient, plane_stress, tangent);
        EXPECT_LT((tangent - tangent.transpose()).norm(), 1e-14);
        for (Index l = 0; l < d; ++l) {
          for (Index k = 0; k < d; ++k) {
            Matrix low = gradient, high = gradient;
            low(k, l) -= h;
            high(k, l) += h;
            const double slope = (law->energy(high, plane_stress) - law->energy(low, plane_stress)) / (2.0 * h);
            EXPECT_NEAR(slope, stress(k, l), 1e-8) << each.name;
            law->stress(low, plane_stress, before);
            law->stress(high, plane_stress, after);
            const Vector change = ((after - before) / (2.0 * h)).reshaped();
            EXPECT_LT((change - tangent.col(k + d * l)).norm(), 1e-7) << each.name;
          }
        }
      }
    }
  }
}

/// Assembly and stress output use the short form of a linear law: it is the same law.
TEST(MaterialLaw, TheConstantTangentIsTheTangent) {
  const auto law = make_linear_elasticity(1.3, 0.8);
  for (const Index d : {Index{2}, Index{3}}) {
    for (const bool plane_stress : {false, true}) {
      if (plane_stress && d == 3) continue;
      const IsotropicElasticity constant = *law->constant_tangent(plane_stress);
      Matrix tangent;
      law->tangent(Matrix::Zero(d, d), plane_stress, tangent);
      // g_i and g_j along two axes: the block of ∂P_ak/∂H_bl contracted with them.
      const Matrix gradients = random_gradient(d, 3);
      Matrix block = Matrix::Zero(d, d);
      if (d == 2) constant.add_tangent<2>(gradients.col(0).data(), gradients.col(1).data(), block.data());
      if (d == 3) constant.add_tangent<3>(gradients.col(0).data(), gradients.col(1).data(), block.data());
      for (Index a = 0; a < d; ++a) {
        for (Index b = 0; b < d; ++b) {
          double sum = 0.0;
          for (Index k = 0; k < d; ++k) {
            for (Index l = 0; l < d; ++l) sum += gradients(k, 0) * tangent(a + d * k, b + d * l) * gradients(l, 1);
          }
          EXPECT_NEAR(block.data()[a * d + b], sum, 1e-15);
        }
      }
    }
  }
}

TEST(MaterialLaw, IsMadeFromEitherPairOfParameters) {
  const auto law = make_material_law("linear", {{"young", 2.5}, {"poisson", 0.25}});
  EXPECT_DOUBLE_EQ(law->lambda(), 1.0);
  EXPECT_DOUBLE_EQ(law->mu(), 1.0);
  EXPECT_THROW((void)make_material_law("rubber", {}), Error);
  EXPECT_THROW((void)make_material_law("linear", {{"lambda", 1.0}}), Error);
}

}  // namespace
}  // namespace ricochet
