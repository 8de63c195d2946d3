#pragma once

#include "ricochet/fem/material.hpp"

/// @file Material law at a point of a body in 3D, in plane strain or in plane stress.
namespace ricochet {

class PointLaw {
 public:
  PointLaw(const MaterialLaw& law, bool plane_stress)
      : law_(&law), plane_stress_(plane_stress), is_linear_(law.is_linear()) {}

  [[nodiscard]] bool is_linear() const { return is_linear_; }
  [[nodiscard]] bool is_plane_stress() const { return plane_stress_; }
  /// Strain of the law at a displacement gradient; under plane stress including the strain normal to the plane at which
  /// the stress normal to the plane vanishes (NaN if there is none).
  [[nodiscard]] Tensor strain(const Tensor& gradient) const;
  /// Completes a strain given by its components in the plane, under plane stress.
  void complete(Tensor& strain) const {
    if (plane_stress_) solve_plane_stress(strain);
  }

  // Evaluated at that strain:
  [[nodiscard]] double energy(const Tensor& strain) const { return law_->energy(strain); }
  void stress(const Tensor& strain, Tensor& result) const { law_->stress(strain, result); }
  /// Under plane stress the tangent is that of the section, which keeps the stress normal to the plane zero.
  void tangent(const Tensor& strain, StressTangent& result) const;

 private:
  void solve_plane_stress(Tensor& strain) const;

  const MaterialLaw* law_;
  bool plane_stress_, is_linear_;
};

}  // namespace ricochet
