#pragma once

#include "ricochet/step/stage.hpp"

/// @file Interface through which a scheme has the stages of its step solved.
namespace ricochet {

/// Passed to Scheme::advance by the caller that runs the scheme. Stages are numbered as the scheme's operators. A stage
/// may depend on the solutions of earlier ones, and may be solved again in the same step.
class StageSolve {
 public:
  virtual ~StageSolve() = default;
  /// Stage of this number, to be filled. Its vectors keep their storage and their values from step to step.
  [[nodiscard]] virtual Stage& stage(std::size_t number) = 0;
  /// Solves a stage. The solution remains valid until this stage is solved again. Throws Error(not_converged) if there
  /// is none, or if it is not finite.
  virtual const StageSolution& solve(std::size_t number) = 0;

  // For a nonlinear internal force:
  /// Rotates the operators with the bodies at this displacement.
  virtual void follow(const Vector& displacement) = 0;
  /// Renews the operators with the tangent at this displacement, those of contact nodes alone at the other.
  virtual void renew(const Vector& displacement, const Vector& of_contact_nodes) = 0;
};

}  // namespace ricochet
