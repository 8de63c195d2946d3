#pragma once

#include <vector>

#include "ricochet/base/types.hpp"

/// @file Fixed points x = F(x) of maps that do not contract, or slowly.
namespace ricochet {

/// Anderson's acceleration (J. ACM 12, 1965): of the last points x_j and residuals f_j = F(x_j) − x_j it takes the
/// affine combination whose residual is least, Σ θ_j f_j, and goes on from Σ θ_j F(x_j), Σ θ_j = 1. For linear F these
/// are the iterates of GMRES. Allocates: it is for what plain rounds do not settle.
class AndersonAcceleration {
 public:
  /// `depth`: earlier points that take part, at least 1.
  explicit AndersonAcceleration(int depth) : depth_(static_cast<std::size_t>(depth)) {}
  void restart();
  /// The next point; the first after a restart is F(x).
  [[nodiscard]] Vector next(const Vector& point, const Vector& image);

 private:
  std::size_t depth_;
  Vector image_, residual_;  ///< of the last point; empty at the start
  std::vector<Vector> image_changes_, residual_changes_;
};

}  // namespace ricochet
