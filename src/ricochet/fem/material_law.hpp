#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/registry.hpp"
#include "ricochet/base/types.hpp"
#include "ricochet/fem/isotropic_elasticity.hpp"

/// @file Material laws. To add one: a file in laws/ with a class and its registration, and one line in
/// material_law.cpp.
///
/// A law gives an energy W(E) per undeformed volume of a strain tensor in space, its derivative S and the derivative of
/// that. For a law of finite strain E is Green's strain, E = ½(H + Hᵀ + HᵀH) of the displacement's gradient H, which no
/// rotation changes, and S the second Piola–Kirchhoff stress: the Cauchy stress is F S Fᵀ/J with F = I + H, J = det F.
/// For the law "linear" E is the small strain ½(H + Hᵀ), and S the stress. Formulas are written for E, not for
/// C = I + 2E, so that no digits are lost where strains are small.
namespace ricochet {

using Tensor = Eigen::Matrix3d;
/// ∂S_ij/∂E_kl between the components xx, yy, zz, xy, yz, zx: dS = this · (dE_xx, dE_yy, dE_zz, 2dE_xy, 2dE_yz,
/// 2dE_zx).
using StressTangent = Eigen::Matrix<double, 6, 6>;

/// Strains of many points, in packs of `width` of them: of each pack the components xx, yy, zz, xy, and unless all are
/// `in_plane` yz and zx, each `width` numbers side by side. Stresses come in the same order.
struct StrainPacks {
  const double* values = nullptr;
  Index count = 0;  ///< of packs
  int width = 0;    ///< pack_width(), base/packs.hpp
  bool in_plane = false;
  [[nodiscard]] int components() const { return in_plane ? 4 : 6; }
};

class MaterialLaw {
 public:
  virtual ~MaterialLaw() = default;
  /// Of a law whose stress is a linear function of the displacement's gradient: assembly and stress output then need
  /// nothing else. None of a law of finite strain.
  [[nodiscard]] virtual std::optional<IsotropicElasticity> constant_tangent(bool) const { return std::nullopt; }
  [[nodiscard]] bool is_linear() const { return constant_tangent(false).has_value(); }
  /// Lamé's parameters at zero strain: of waves, locking and estimates.
  [[nodiscard]] virtual double lambda() const = 0;
  [[nodiscard]] virtual double mu() const = 0;

  // What comes out is not finite where det(I + 2E) ≤ 0; the caller sees to det F > 0.
  [[nodiscard]] virtual double energy(const Tensor& strain) const = 0;
  virtual void stress(const Tensor& strain, Tensor& result) const = 0;
  virtual void tangent(const Tensor& strain, StressTangent& result) const = 0;
  // The same of many points, one number per point of energies. What is here asks for one point after another; laws
  // derived from PackedLaw (laws/packed_law.hpp) take a pack at once.
  virtual void energies(const StrainPacks& strains, double* result) const;
  virtual void stresses(const StrainPacks& strains, double* result) const;

  /// K of a part (K/4)(J² − 1 − 2 ln J) of the energy, the only one whose modulus grows without bounds as the material
  /// becomes incompressible: it may be taken from a mean of J over a cell (cell_dilatation.hpp). 0: there is no such
  /// part.
  [[nodiscard]] virtual double volumetric_modulus() const { return 0.0; }
};

using MaterialLawConstructor = std::function<std::unique_ptr<MaterialLaw>(const Parameters& parameters)>;
using MaterialLawRegistration = Registration<MaterialLawConstructor>;

/// All laws. A program of one's own may add to them.
[[nodiscard]] Registry<MaterialLawConstructor>& material_law_registry();
/// By name, with the values of its keys; throws Error(invalid_input) that lists the names, or says which value is
/// missing or too many.
[[nodiscard]] std::unique_ptr<MaterialLaw> make_material_law(const std::string& name, Parameters parameters);
/// The law "linear", from Lamé's parameters of three dimensions, which may be of any sign here.
[[nodiscard]] std::unique_ptr<MaterialLaw> make_linear_elasticity(double lambda, double mu);

}  // namespace ricochet
