#pragma once

#include <string>
#include <vector>

/// @file Linear isotropic elasticity.
namespace ricochet {

/// What a two-dimensional body is a section of.
enum class PlaneState { strain, stress };

struct Material {
  std::string name;                ///< of its group, for messages
  double density = 0.0;            ///< mass per volume
  double lambda = 0.0;             ///< Lamé's first parameter, of the three-dimensional law
  double mu = 0.0;                 ///< shear modulus
  double mass_damping = 0.0;       ///< Rayleigh, 1/time
  double stiffness_damping = 0.0;  ///< Rayleigh, time

  [[nodiscard]] double poisson() const { return lambda / (2.0 * (lambda + mu)); }
  [[nodiscard]] double young() const { return mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu); }
  /// λ of the two-dimensional law: plane stress condenses the stress-free direction, 2λμ/(λ+2μ).
  [[nodiscard]] double plane_stress_lambda() const { return 2.0 * lambda * mu / (lambda + 2.0 * mu); }
};

}  // namespace ricochet
