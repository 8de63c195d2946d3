#pragma once

#include <memory>
#include <string>
#include <vector>

#include "ricochet/fem/material_law.hpp"

/// @file What a body is made of.
namespace ricochet {

/// What a two-dimensional body is a section of: of a long one, of a thin one, or of one that is the same all round the
/// y axis, from which x is the distance.
enum class PlaneState { strain, stress, axisymmetric };

/// A branch beside the law whose stress relaxes, see relaxation.hpp.
struct RelaxationBranch {
  double modulus = 0.0;  ///< g, relative to the shear modulus of the law
  double time = 0.0;     ///< τ
};

struct Material {
  std::string name;      ///< of its group, for messages
  double density = 0.0;  ///< mass per volume
  std::shared_ptr<const MaterialLaw> law;
  double mass_damping = 0.0;       ///< Rayleigh, 1/time
  double stiffness_damping = 0.0;  ///< Rayleigh, time
  /// The dilatation's part of the energy is that of a mean over each cell (elastic_cells.hpp), where the law has such a
  /// part and the cell has more than one quadrature point.
  bool mean_dilatation = false;
  /// Beside the law, which is what is left of them in the end. Of laws of finite strain, not in plane stress.
  std::vector<RelaxationBranch> relaxation = {};

  /// Σ gμ: what the branches add to the shear modulus at an instant.
  [[nodiscard]] double branch_mu() const {
    double sum = 0.0;
    for (const RelaxationBranch& branch : relaxation) sum += branch.modulus * mu();
    return sum;
  }

  // Of the law at zero strain, in three dimensions:
  [[nodiscard]] double lambda() const { return law->lambda(); }  ///< Lamé's first parameter
  [[nodiscard]] double mu() const { return law->mu(); }          ///< shear modulus
  [[nodiscard]] double poisson() const { return lambda() / (2.0 * (lambda() + mu())); }
  [[nodiscard]] double young() const { return mu() * (3.0 * lambda() + 2.0 * mu()) / (lambda() + mu()); }
};

}  // namespace ricochet
