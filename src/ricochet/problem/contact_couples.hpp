#pragma once

#include <vector>

#include "ricochet/problem/semidiscrete_problem.hpp"

/// @file Couples of contact forces, if rows that follow the motion are those of a step.
///
/// Nodal forces Hᵀρ of such rows need not have the moment zero about the positions at which they act in the balance of
/// momentum. Bodies that move freely get the difference (ContactGeometry::add_couples), so that their angular momentum
/// is an invariant. Where a support holds one of two bodies it is none, and H alone acts: the work of the couples on
/// supports that move would be energy that no force of the step has brought.
namespace ricochet {

class ContactCouples {
 public:
  /// Analyses the problem. Keeps a reference.
  explicit ContactCouples(const SemidiscreteProblem& problem);
  /// Adds the couples of these reactions to a force per dof, at the displacement about whose positions moments are.
  void add(const Vector& displacement, const ContactRows& rows, const Vector& normal, const Vector& tangential,
           Vector& force);

 private:
  [[nodiscard]] bool is_held(const ContactRows& rows, Index point) const;

  const SemidiscreteProblem& problem_;
  std::vector<char> is_held_;  ///< per node: whether some support acts on its body
  Vector normal_, tangential_;
};

}  // namespace ricochet
