#pragma once

#include "ricochet/fem/material.hpp"

/// @file A material law at a point of a body in space, in plane strain or in plane stress.
namespace ricochet {

class PointLaw {
 public:
  PointLaw(const MaterialLaw& law, bool plane_stress)
      : law_(&law), plane_stress_(plane_stress), is_linear_(law.is_linear()) {}

  [[nodiscard]] bool is_linear() const { return is_linear_; }
  [[nodiscard]] bool is_plane_stress() const { return plane_stress_; }
  /// The strain that the law has at a displacement gradient; of plane stress with the strain across the plane at which
  /// there is no stress across it (NaN where there is none).
  [[nodiscard]] Tensor strain(const Tensor& gradient) const;
  /// The same from its components in the plane, where that is needed.
  void complete(Tensor& strain) const {
    if (plane_stress_) thin_out(strain);
  }

  // At that strain:
  [[nodiscard]] double energy(const Tensor& strain) const { return law_->energy(strain); }
  void stress(const Tensor& strain, Tensor& result) const { law_->stress(strain, result); }
  /// Of plane stress that of the section: no stress across the plane comes up.
  void tangent(const Tensor& strain, StressTangent& result) const;

 private:
  void thin_out(Tensor& strain) const;

  const MaterialLaw* law_;
  bool plane_stress_, is_linear_;
};

}  // namespace ricochet
