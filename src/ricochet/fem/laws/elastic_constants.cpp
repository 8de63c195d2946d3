#include "ricochet/fem/laws/elastic_constants.hpp"

#include <fmt/format.h>

#include <cmath>

namespace ricochet {

std::vector<Key> elastic_constant_keys() {
  return {number_key("lambda", "stress", {}, "First Lamé parameter; 3 lambda + 2 mu must be positive."),
          number_key("mu", "stress", {.range = positive}, "Second Lamé parameter, the shear modulus."),
          number_key("young", "stress", {.range = positive}, "Young's modulus."),
          number_key("poisson", "1", {.range = {.above = -1.0, .below = 0.5}}, "Poisson's ratio.")};
}

namespace {

/// Lamé's parameters from E and ν.
ElasticConstants lame_parameters(double young, double poisson) {
  return {young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson)), young / (2.0 * (1.0 + poisson))};
}

}  // namespace

void check_elastic_constants(const ParameterCheck& check, Parameters& values) {
  if (check.is_usable("lambda") && check.is_usable("mu")) {
    const double bulk = 3.0 * values.number("lambda") + 2.0 * values.number("mu");
    if (!(bulk > 0.0)) {
      check.add_problem(
          "lambda",
          fmt::format("3 lambda + 2 mu must be positive (the bulk modulus is a third of it); it is {}", bulk));
    }
  }
  if (!check.is_usable("young") || !check.is_usable("poisson")) return;
  const double young = values.number("young"), poisson = values.number("poisson");
  const ElasticConstants lame = lame_parameters(young, poisson);
  if (!std::isfinite(lame.lambda) || !std::isfinite(lame.mu)) {
    check.add_problem("poisson", fmt::format("young = {} and poisson = {} give infinite lambda or mu", young, poisson));
  }
}

KeySets elastic_constant_pairs() { return {{"lambda", "mu"}, {"young", "poisson"}}; }

ElasticConstants elastic_constants(const Parameters& parameters) {
  if (!parameters.has("young")) return {parameters.number("lambda"), parameters.number("mu")};
  return lame_parameters(parameters.number("young"), parameters.number("poisson"));
}

}  // namespace ricochet
