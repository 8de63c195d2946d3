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
namespace ricochet {

class MaterialLaw {
 public:
  virtual ~MaterialLaw() = default;
  /// Of a law whose stress is a linear function of the displacement's gradient: assembly and stress output then need
  /// nothing else. None where the tangent depends on the displacement.
  [[nodiscard]] virtual std::optional<IsotropicElasticity> constant_tangent(bool plane_stress) const = 0;
  /// Lamé's parameters of the three-dimensional law at zero strain: of waves, locking and estimates.
  [[nodiscard]] virtual double lambda() const = 0;
  [[nodiscard]] virtual double mu() const = 0;

  // At a displacement gradient H (d × d, H_ij = ∂u_i/∂x_j), per volume of the undeformed body; in the plane, of a body
  // in plane strain or plane stress:
  /// Strain energy W(H).
  [[nodiscard]] virtual double energy(const Matrix& gradient, bool plane_stress) const = 0;
  /// First Piola–Kirchhoff stress P = ∂W/∂H, d × d.
  virtual void stress(const Matrix& gradient, bool plane_stress, Matrix& result) const = 0;
  /// ∂P_ij/∂H_kl, d² × d², symmetric; components numbered i + d j.
  virtual void tangent(const Matrix& gradient, bool plane_stress, Matrix& result) const = 0;
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
