#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "ricochet/base/registry.hpp"
#include "ricochet/base/types.hpp"
#include "ricochet/fem/isotropic_elasticity.hpp"

/// @file Material laws. To add one: a file in laws/ with a class and its registration, and
/// one line in material_law.cpp.
///
/// A law defines an energy W(E) per undeformed volume as a function of a 3D strain tensor, its derivative S and the
/// derivative of S. For a law of finite strain E is Green's strain, E = ½(H + Hᵀ + HᵀH) of the displacement gradient H,
/// invariant under rotations, and S the second Piola–Kirchhoff stress: the Cauchy stress is F S Fᵀ/J with F = I + H,
/// J = det F. For the law "linear" E is the small strain ½(H + Hᵀ), and S the stress. Formulas are written in E, not in
/// C = I + 2E, so that no digits are lost at small strain.
namespace ricochet {

using Tensor = Eigen::Matrix3d;
/// ∂S_ij/∂E_kl between the components xx, yy, zz, xy, yz, zx: dS = this · (dE_xx, dE_yy,
/// dE_zz, 2dE_xy, 2dE_yz, 2dE_zx).
using StressTangent = Eigen::Matrix<double, 6, 6>;

/// Strains at many points, in packs of `width` points: for each pack the components xx, yy, zz, xy and, unless
/// `in_plane`, yz and zx, with `width` contiguous numbers each. Stresses are in the same order.
struct StrainPacks {
  const double* values = nullptr;
  Index count = 0;  ///< number of packs
  int width = 0;    ///< pack_width(), base/packs.hpp
  bool in_plane = false;
  [[nodiscard]] int components() const { return in_plane ? 4 : 6; }
};

class MaterialLaw {
 public:
  virtual ~MaterialLaw() = default;
  /// Constant tangent of a law whose stress is a linear function of the displacement gradient: assembly and stress
  /// output then need nothing else. None for a law of finite strain.
  [[nodiscard]] virtual std::optional<IsotropicElasticity> constant_tangent(bool) const { return std::nullopt; }
  [[nodiscard]] bool is_linear() const { return constant_tangent(false).has_value(); }
  /// Lamé's parameters at zero strain: for waves, locking and estimates.
  [[nodiscard]] virtual double lambda() const = 0;
  [[nodiscard]] virtual double mu() const = 0;

  // Energy, stress and tangent are not finite if det(I + 2E) ≤ 0; the caller ensures det F > 0.
  [[nodiscard]] virtual double energy(const Tensor& strain) const = 0;
  virtual void stress(const Tensor& strain, Tensor& result) const = 0;
  virtual void tangent(const Tensor& strain, StressTangent& result) const = 0;
  // Energies and stresses at many points, with one energy per point. The defaults evaluate point by point; laws derived
  // from PackedLaw (packed_law.hpp) process a whole pack at a time.
  virtual void energies(const StrainPacks& strains, double* result) const;
  virtual void stresses(const StrainPacks& strains, double* result) const;

  /// Modulus K of a part (K/4)(J² − 1 − 2 ln J) of the energy, the only part whose modulus grows without bounds
  /// as the material becomes incompressible: it may be evaluated at a mean of J over a cell
  /// (cell_dilatation.hpp). 0 if there is no such part.
  [[nodiscard]] virtual double volumetric_modulus() const { return 0.0; }
};

struct MaterialLawType {
  std::function<std::unique_ptr<MaterialLaw>(const Parameters& values)> make;
  /// Whether its laws have a `volumetric_modulus`.
  bool has_volumetric_energy = false;
};
using MaterialLawRegistration = Registration<MaterialLawType>;

/// Registry of all laws. A program may add its own.
[[nodiscard]] Registry<MaterialLawType>& material_law_registry();
/// Creates a law by name, with the values of its keys; throws Error(invalid_input) that lists the names, or reports a
/// missing or superfluous value.
[[nodiscard]] std::unique_ptr<MaterialLaw> make_material_law(const std::string& name, Parameters parameters);
/// Creates the law "linear" from Lamé's 3D parameters, which may have any sign here.
[[nodiscard]] std::unique_ptr<MaterialLaw> make_linear_elasticity(double lambda, double mu);

}  // namespace ricochet
