#pragma once

#include <vector>

#include "ricochet/base/registry.hpp"

/// @file Constants of isotropic elasticity in a case file: keys shared by several laws.
namespace ricochet {

/// Lamé's parameters.
struct ElasticConstants {
  double lambda = 0.0, mu = 0.0;
};

/// lambda, mu, young and poisson.
[[nodiscard]] std::vector<Key> elastic_constant_keys();
/// The two pairs of constants, either of which determines the law.
[[nodiscard]] KeySets elastic_constant_pairs();
/// Checks that 3 lambda + 2 mu is positive and lambda finite.
void check_elastic_constants(const ParameterCheck& check, Parameters& values);
[[nodiscard]] ElasticConstants elastic_constants(const Parameters& parameters);

}  // namespace ricochet
