#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/fem/material_law.hpp"

/// @file Materials of a body.
namespace ricochet {

/// Section represented by a 2D body: of a long body, of a thin one, or of a body of revolution about the y
/// axis, with x the distance from it.
enum class PlaneState { strain, stress, axisymmetric };

/// Viscoelastic branch of a material, see relaxation.hpp.
struct RelaxationBranch {
  double modulus = 0.0;  ///< g, relative to the shear modulus of the law
  double time = 0.0;     ///< τ
};

struct Material {
  std::string name;      ///< of its group, in messages
  double density = 0.0;  ///< mass per volume
  std::shared_ptr<const MaterialLaw> law;
  double mass_damping = 0.0;       ///< Rayleigh, 1/time
  double stiffness_damping = 0.0;  ///< Rayleigh, time
  /// Whether the dilatational part of the energy is evaluated at a mean over each cell (elastic_cells.hpp), if the law
  /// has such a part and the cell has more than one quadrature point.
  bool mean_dilatation = false;
  /// Viscoelastic branches, in addition to the law, which is the long-term response. For laws of
  /// finite strain, not in plane stress.
  std::vector<RelaxationBranch> relaxation = {};

  /// Σ gμ: the contribution of the branches to the instantaneous shear modulus.
  [[nodiscard]] double branch_mu() const {
    double sum = 0.0;
    for (const RelaxationBranch& branch : relaxation) sum += branch.modulus * mu();
    return sum;
  }

  // Constants of the law at zero strain, in 3D:
  [[nodiscard]] double lambda() const { return law->lambda(); }  ///< Lamé's first parameter
  [[nodiscard]] double mu() const { return law->mu(); }          ///< shear modulus
  [[nodiscard]] double poisson() const { return lambda() / (2.0 * (lambda() + mu())); }
  [[nodiscard]] double young() const { return mu() * (3.0 * lambda() + 2.0 * mu()) / (lambda() + mu()); }
};

}  // namespace ricochet
