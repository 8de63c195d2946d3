#pragma once

#include <vector>

#include "ricochet/linear_algebra/dense_factor.hpp"
#include "ricochet/linear_algebra/gmres.hpp"
#include "ricochet/solver/contact/contact_system.hpp"
#include "ricochet/solver/contact/reused_factor.hpp"

/// @file Newton step of the contact problem with Coulomb friction.
namespace ricochet {

/// Newton's method on the equations of P. Alart and A. Curnier (Comput. Methods Appl. Mech. Engrg. 92 (1991) 353–375),
/// as an active set: with τ = (r_N − c u_N, r_T − c u_T), c = 1/w and b the friction limit of τ_N, a point is
///   open   where τ_N ≤ 0:    r = 0
///   stick  where |τ_T| ≤ b:  u = 0
///   slip elsewhere: u_N = 0, r_T = b t + p with t = τ_T/|τ_T|, p ⟂ t and (I − ttᵀ) u_T + (|τ_T| − b)/(b c) p = 0,
/// the last being the linearization of r_T = b τ_T/|τ_T| with b = F r_N, solved for the direction of slip. At a
/// solution (|τ_T| − b)/(b c) = |u_T|/b ≥ 0, so that the system is W on some directions and a positive diagonal, all of
/// its rows in units of u. In two dimensions there is no p, and the iteration is a finite active set method.
///
/// Linear systems with few unknowns are solved by LU in double precision, which is reused as long as nothing changes.
/// Larger ones are solved by GMRES, preconditioned by the LU in single precision of an earlier system (ReusedFactor),
/// of this step, of an earlier one or of an earlier problem with the same W; if that takes more iterations than a new
/// factor is worth, by the factor of this one. If even that fails (W singular), by LU in double precision with a
/// proximal term.
class AlartCurnierStep {
 public:
  /// Computes r of the full step from `from`. The linear system is solved to `reduction` of its residual at `from`, or
  /// better. Returns false if it could not be solved.
  bool step(const ContactSystem& system, const ContactIterate& from, Vector& reaction, double reduction = 1e-13);
  /// Refines r, given u of that r: solves once more for the residual of the linear system and adds the correction.
  /// Returns false if the residual is rounding.
  bool refine(const ContactIterate& full, Vector& reaction);
  /// Discards the factors, which are of another W.
  void reset() {
    factored_.clear();
    reused_.reset();
  }
  /// To be called before the first step of a problem: only factors are kept from earlier ones.
  void start() {
    last_unknowns_.clear();
    has_charged_factor_ = false;
    has_settled_ = false;
    work_ = 0.0;
  }
  /// Work of the steps since `start`, in entries of matrices read (operations of a factorization count a twelfth).
  [[nodiscard]] double work() const { return work_; }
  /// Work of a factorization and of an iteration with so many unknowns.
  [[nodiscard]] static double factor_work(double unknowns);
  [[nodiscard]] static double iteration_work(double unknowns);
  /// Factor of a large system, see IterativeContactSolver.
  [[nodiscard]] const ReusedFactor& reused() const { return reused_; }
  [[nodiscard]] ReusedFactor& reused() { return reused_; }
  /// True if the last step needed a new factor.
  [[nodiscard]] bool has_factored() const { return has_factored_; }
  /// True if the last two steps had the same states: with exact systems Newton's method converges from here on.
  [[nodiscard]] bool has_settled() const { return has_settled_; }

 private:
  void choose(const ContactSystem& system, const ContactPoint& point, const ContactIterate& from);
  void add(ContactUnknown unknown, const PaddedVector& trial, const PaddedVector& test, double diagonal,
           double present);
  void add_proximal_term();
  bool solve_directly();
  bool solve_with_reused_factor(const ContactSystem& system, double reduction);
  double correct(const Vector& residual, double reduction, Index limit);
  void expand(const Vector& x, Vector& reaction) const;

  std::vector<ContactUnknown> unknowns_, last_unknowns_, factored_;
  Vector present_;  ///< x of the r from which the step starts
  Vector fixed_;    ///< r that is not unknown: b t under Tresca's law
  bool has_fixed_ = false;
  Vector right_, residual_, solution_, correction_, fixed_motion_, column_;
  Matrix matrix_;
  DenseLu factor_;
  ReusedFactor reused_;
  Gmres gmres_;
  bool is_iterative_ = false;  ///< the last step was solved by GMRES
  /// Proximal terms on the diagonal of a matrix singular to rounding: of this step's system, and of the factorized one.
  double proximal_ = 0.0, factored_proximal_ = 0.0;
  bool has_factored_ = false, has_settled_ = false;
  /// A factor of few unknowns is charged in every problem, even if it is that of an earlier one: the choice of a method
  /// must not depend on whether a run has been interrupted.
  bool has_charged_factor_ = false;
  double work_ = 0.0;
};

}  // namespace ricochet
