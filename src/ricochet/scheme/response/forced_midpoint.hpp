#pragma once

#include "ricochet/problem/contact_conditions.hpp"
#include "ricochet/scheme/kane.hpp"
#include "ricochet/scheme/response/contact_response.hpp"

/// @file The midpoint rule inside the body with normal forces that a scheme finds by itself, from gaps before and
/// after.
namespace ricochet {

///   M (V₁−V₀)/h + C ΔU/h + K (U₀+U₁)/2 = L_½ + Gᵀ r + f,   ΔU = h (V₀+V₁)/2,
/// with forces r ≥ 0 of the obstacle and f of the body on itself. No friction, no curved obstacles.
class ForcedMidpoint : public Kane {
 public:
  using Kane::Kane;

  [[nodiscard]] double force_instant() const override { return -0.5; }
  /// Of the contact.
  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const override;
  /// What the forces take from the body and the contact stores.
  [[nodiscard]] StepCorrections step_corrections(const SemidiscreteProblem&) const override { return corrections_; }
  void analyse(const SemidiscreteProblem& problem) override;
  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override;

 protected:
  /// A step before its forces are known: gaps at its start, and place and gaps at its end without forces.
  struct Unforced {
    const State& start;
    const Vector &gap_before, &place, &gap;
  };
  /// Sets `normal`, r, zero before; false where neither r nor f acts. Stage 0 may be used.
  virtual bool find_forces(const SemidiscreteProblem& problem, const ContactRows& rows, const Unforced& unforced,
                           StageSolve& stages, Vector& normal) = 0;
  virtual void add_other_forces(Vector&) const {}
  /// What the contact stores at a displacement with these gaps: J and this together change by what the law loses.
  [[nodiscard]] virtual double contact_energy(const Vector& displacement, const Vector& gap) const = 0;
  /// What the law has taken in the step that ends there, ≥ 0, and the work of f.
  [[nodiscard]] virtual double lost(const Vector&, const Vector&) const { return 0.0; }
  [[nodiscard]] virtual double other_work(const Vector&) const { return 0.0; }

 private:
  StepCorrections corrections_;
  Vector before_, free_, normal_, place_;
  StageSolution solution_;
  mutable Vector gap_;  ///< work space
};

}  // namespace ricochet
