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

/// The verdicts of an iteration whose u follows by updates and whose residual need not fall: on a u evaluated afresh,
/// every sixteenth time and when the residual seems small enough. The best r is kept.
class FirstOrderVerdict {
 public:
  void start(const ContactSystem& system, double tolerance, const ContactIterate& current);
  /// After iteration k, which left `residual` with the u it follows. True: `current` is a solution, and evaluated.
  bool is_solved(const ContactSystem& system, int k, double residual, ContactIterate& current);
  /// `current` becomes the best there was, evaluated. False: the iteration diverged.
  bool finish(const ContactSystem& system, ContactIterate& current) const;
  /// Residual of the best r so far.
  [[nodiscard]] double best() const { return best_residual_; }

 private:
  static constexpr int interval = 16;
  ContactIterate best_;
  double best_residual_ = 0.0;
  double tolerance_ = 0.0;
};

/// Σ w_i x_i·y_i.
[[nodiscard]] double weighted_product(const ContactSystem& system, const Vector& x, const Vector& y);

}  // namespace ricochet
