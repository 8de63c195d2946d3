#pragma once

#include <string>

#include "ricochet/solver/contact/contact_system.hpp"

/// @file Functions shared by the solvers of the cone complementarity problem K* ∋ û ⟂ r ∈ K. Lengths are those of the
/// metric with w_i at point i, in which a gradient step is u_i/w_i and projections on K are the ordinary ones.
namespace ricochet {

/// Reason why a problem is no cone complementarity problem; empty: it is one.
[[nodiscard]] std::string refuse_bounds(const ContactSystem& system);

/// û = u + (F |u_T|, 0, 0) of a point. G. De Saxcé, Z.-Q. Feng, Math. Comput. Modelling 28 (1998) 225–245.
[[nodiscard]] inline PaddedVector de_saxce(const ContactPoint& point, const PaddedVector& motion) {
  return {motion[0] + point.coefficient * motion.tail<2>().norm(), motion[1], motion[2]};
}

/// Projection on K; without friction on the half-line r_N ≥ 0.
[[nodiscard]] inline PaddedVector project(const ContactPoint& point, const PaddedVector& r) {
  if (!point.has_friction()) return {r[0] > 0.0 ? r[0] : 0.0, 0.0, 0.0};
  return project_on_cone(point.coefficient, r);
}

/// Sets r = 0, exactly, if the projection of r − û/w is the cone's tip: the remainder, at open points, of an iteration
/// through the interior of the cone. Leaves u unchanged. Returns whether some r changed.
bool open_points(const ContactSystem& system, ContactIterate& iterate);

/// Verdicts of an iteration that updates u and whose residual need not fall: on a freshly evaluated u, every sixteenth
/// time and when the residual seems small enough. Keeps the best r.
class FirstOrderVerdict {
 public:
  void start(const ContactSystem& system, double tolerance, const ContactIterate& current);
  /// Judges iteration k, which left `residual` with the updated u. Returns whether `current` is a solution, evaluated.
  bool is_solved(const ContactSystem& system, int k, double residual, ContactIterate& current);
  /// Replaces `current` by the best iterate, evaluated. Returns false if the iteration diverged.
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
