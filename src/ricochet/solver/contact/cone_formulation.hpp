#pragma once

#include <string>

#include "ricochet/solver/contact/contact_system.hpp"

/// @file What the solvers of the cone complementarity problem K* ∋ û ⟂ r ∈ K share. Lengths are those of the metric
/// that has w_i at point i, in which a gradient step is u_i/w_i and projections on K are the ordinary ones.
namespace ricochet {

/// Why a problem is none of a cone; empty: it is one.
[[nodiscard]] std::string refuse_bounds(const ContactSystem& system);

/// û = u + (F |u_T|, 0, 0) of a point. G. De Saxcé, Z.-Q. Feng, Math. Comput. Modelling 28 (1998) 225–245.
[[nodiscard]] inline PaddedVector de_saxce(const ContactPoint& point, const PaddedVector& motion) {
  return {motion[0] + point.coefficient * motion.tail<2>().norm(), motion[1], motion[2]};
}

/// Projection on K, the half-line r_N ≥ 0 where there is no friction.
[[nodiscard]] inline PaddedVector project(const ContactPoint& point, const PaddedVector& r) {
  if (!point.has_friction()) return {r[0] > 0.0 ? r[0] : 0.0, 0.0, 0.0};
  return project_on_cone(point.coefficient, r);
}

/// r = 0, exactly, where the projection of r − û/w is the cone's tip: what an iteration through the inside of the cone
/// leaves at open points. u does not follow. True: some r changed.
bool open_points(const ContactSystem& system, ContactIterate& iterate);

/// Σ w_i x_i·y_i.
[[nodiscard]] double weighted_product(const ContactSystem& system, const Vector& x, const Vector& y);

}  // namespace ricochet
