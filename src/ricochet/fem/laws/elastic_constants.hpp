#pragma once

#include <vector>

#include "ricochet/base/registry.hpp"

/// @file The constants of isotropic elasticity as a case gives them: keys of several laws.
namespace ricochet {

/// Lamé's parameters.
struct ElasticConstants {
  double lambda = 0.0, mu = 0.0;
};

/// lambda, mu, young and poisson.
[[nodiscard]] std::vector<Key> elastic_constant_keys();
/// Either pair of them.
[[nodiscard]] KeySets elastic_constant_pairs();
/// 3 lambda + 2 mu must be positive, and lambda finite.
void check_elastic_constants(const ParameterCheck& place, Parameters& values);
[[nodiscard]] ElasticConstants elastic_constants(const Parameters& parameters);

}  // namespace ricochet
