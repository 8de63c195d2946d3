#pragma once

#include "ricochet/fem/elastic_cells.hpp"

/// @file Interface of the control of distorted cells (fem/distortion_control.hpp), part of an internal force.
namespace ricochet {

class DistortionForce {
 public:
  virtual ~DistortionForce() = default;
  /// Returns the smallest volume ratio close to a node of a cell, if it is below 1.
  [[nodiscard]] virtual CellVolume smallest_nodal_volume(const Vector& displacement) const = 0;
  /// Sets whether forces, tangents and energies include those of the control. They may exclude it as long as all ratios
  /// are above `distortion_volume_ratio`, where they are zero.
  virtual void control_distortion(bool is_on) const = 0;
  /// Energy of the control at a displacement, which the strain energy includes.
  [[nodiscard]] virtual double distortion_energy(const Vector& displacement) const = 0;
};

}  // namespace ricochet
