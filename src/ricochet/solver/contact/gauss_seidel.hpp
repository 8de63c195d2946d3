#pragma once

#include <vector>

#include "ricochet/solver/contact/contact_system.hpp"

/// @file Projected block Gauss–Seidel and its acceleration.
namespace ricochet {

/// One pass over the points in their order: each active or violated point is solved exactly for the reactions of the
/// others (solve_point), and u is updated. Robust, first order: the error falls by a factor that depends on W's
/// conditioning. M. Jean, Comput. Methods Appl. Mech. Engrg. 177 (1999) 235–257.
class GaussSeidel {
 public:
  /// Applies `damping` of each point's correction. Returns whether some point has changed between open, stick and slip
  /// since the last sweep. `roughly`: u is updated in single precision only.
  bool sweep(const ContactSystem& system, double damping, ContactIterate& iterate, bool roughly = false);
  /// Discards the states of the last sweep, with which the next one compares its own.
  void restart() { states_.clear(); }

 private:
  std::vector<char> states_;
  std::vector<double> slip_stiffness_;  ///< per point, see solve_point
};

/// Anderson acceleration of the sweeps, viewed as a fixed point r = g(r): the next start is the combination of the last
/// few g whose residuals g(r) − r nearly cancel. Once states no longer change the sweeps are linear to first order, and
/// this is GMRES preconditioned by Gauss–Seidel: about the root of the number of sweeps. The extrapolated r need not
/// satisfy the law; the sweep after it does. If the residual grows, it continues from the last sweep without history.
/// D. G. Anderson, J. ACM 12 (1965) 547–560; H. F. Walker, P. Ni, SIAM J. Numer. Anal. 49 (2011) 1715–1735.
class AcceleratedGaussSeidel {
 public:
  /// Starts a new problem; the first sweep begins at its iterate.
  void start(const ContactSystem& system);
  /// Performs one sweep from the extrapolated start; `iterate` is the sweep's end, which satisfies the law's signs and
  /// limits. Returns whether states changed.
  bool sweep(const ContactSystem& system, ContactIterate& iterate);
  /// Sets u at the end of the last sweep, evaluated afresh: sweeps update it in single precision if that is faster.
  void correct(const Vector& motion);
  /// Size |g(r) − r|, scaled, of the last sweep.
  [[nodiscard]] double change() const { return change_; }

 private:
  static constexpr Index depth = 6;
  void extrapolate();

  GaussSeidel sweeps_;
  Vector start_reaction_, start_motion_;  ///< of the next sweep
  Vector end_reaction_, end_motion_;      ///< of the last
  Vector residual_, last_residual_;
  Matrix residual_steps_, reaction_steps_, motion_steps_;
  Eigen::Matrix<double, depth, depth> products_;  ///< of residual steps
  Index stored_ = 0, next_ = 0;
  bool has_last_ = false;
  double change_ = 0.0;
};

}  // namespace ricochet
