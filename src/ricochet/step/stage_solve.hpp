#pragma once

#include <stdexcept>

#include "ricochet/step/exact_tangent.hpp"
#include "ricochet/step/stage.hpp"

/// @file Interface by which a scheme solves the stages of its step.
namespace ricochet {

/// Passed to Scheme::advance by the caller that runs the scheme. Stages are numbered as the scheme's operators; another
/// number is a std::out_of_range. A stage may depend on the solutions of earlier ones, and may be solved again in the
/// same step.
class StageSolve {
 public:
  virtual ~StageSolve() = default;
  /// Stage of this number, to be filled. Its vectors keep their storage and their values from step to step.
  [[nodiscard]] virtual Stage& stage(std::size_t number) = 0;
  /// Solves a stage. The solution remains valid until this stage is solved again. Throws Error(not_converged) if there
  /// is none, or if it is not finite.
  virtual const StageSolution& solve(std::size_t number) = 0;

  /// Whether a step that is not solved is attempted in shorter parts.
  [[nodiscard]] virtual bool may_be_shortened() const { return false; }
  /// Whether solve_exactly() is available: not if the body is divided among ranks.
  [[nodiscard]] virtual bool solves_exactly() const { return false; }
  /// Solves the equations of an exact tangent with the eligible points of a stage. `solution`: on entry the reactions
  /// of the last iteration, on return those of this one and the contact status; nothing else of it is set. Throws
  /// Error(not_converged).
  virtual void solve_exactly(std::size_t /*number*/, ExactTangent& /*tangent*/, StageSolution& /*solution*/,
                             Vector& /*unknowns*/) {
    throw std::logic_error("exact tangents are not solved here");
  }

  // For a nonlinear internal force, with displacements per dof:
  /// Error, relative to the increment of a step, that Newton iterations of the scheme itself (NewtonProgress) may leave
  /// in it. solve() iterates to rounding.
  [[nodiscard]] virtual double newton_tolerance() const = 0;
  /// Rotates the operators with the bodies at this displacement.
  virtual void rotate_operators(const Vector& displacement) = 0;
  /// Number of iterations of Newton's method that take as long as renew_operators(), by counted costs.
  [[nodiscard]] virtual double renewal_price() const = 0;
  /// Refactorizes the operators with the tangent at `displacement`, those of contact nodes alone with the tangent at
  /// `of_contact_nodes`. If some operator is not positive definite there, all are made without the stiffness of loads
  /// that follow the surface, or with a part of the strains, or finally for the undeformed body.
  virtual void renew_operators(const Vector& displacement, const Vector& of_contact_nodes) = 0;
};

}  // namespace ricochet
