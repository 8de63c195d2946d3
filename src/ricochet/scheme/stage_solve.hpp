#pragma once

#include "ricochet/problem/stage.hpp"

/// @file How a scheme has the stages of its step solved.
namespace ricochet {

/// Handed to Scheme::advance by whoever runs the scheme. Stages are numbered as the scheme's operators. A stage may
/// depend on the solutions of earlier ones, and may be solved again in the same step.
class StageSolve {
 public:
  virtual ~StageSolve() = default;
  /// The stage of this number, to be filled. Its vectors keep their storage, and their values, from step to step.
  [[nodiscard]] virtual Stage& stage(std::size_t number) = 0;
  /// Solves it. The solution stays until this stage is solved again. Throws Error(not_converged) where there is none,
  /// or where it is not finite.
  virtual const StageSolution& solve(std::size_t number) = 0;

  // Where the internal force is not linear:
  /// Operators turn with bodies that are at this displacement.
  virtual void follow(const Vector& displacement) = 0;
  /// Operators are made anew with the tangent at this displacement, those of contact nodes alone at another.
  virtual void renew(const Vector& displacement, const Vector& of_contact_nodes) = 0;
};

}  // namespace ricochet
