#pragma once

#include "ricochet/scheme/kane.hpp"
#include "ricochet/scheme/response/contact_response.hpp"
#include "ricochet/step/contact_conditions.hpp"

/// @file The midpoint rule inside the body, with normal forces that a scheme computes itself from gaps before and
/// after.
namespace ricochet {

/// Balance of the step,
///   M (V₁−V₀)/h + C ΔU/h + K (U₀+U₁)/2 = L_½ + Gᵀ r + f,   ΔU = h (V₀+V₁)/2,
/// with forces r ≥ 0 of the obstacle and f of the body on itself. No friction, no curved obstacles.
class ForcedMidpoint : public Kane {
 public:
  ForcedMidpoint(double step, std::string name) : Kane(step, std::move(name), -0.5) {}

  /// Energy of the contact.
  [[nodiscard]] double algorithmic_energy(const SemidiscreteProblem& problem, const State& state) const override;
  /// Energy that the forces take from the body and the contact stores.
  [[nodiscard]] LastStep last_step() const override { return {.corrections = corrections_}; }
  void analyse(const SemidiscreteProblem& problem) override;
  void advance(const SemidiscreteProblem& problem, State& state, StageSolve& stages, Vector& increment) override;

 protected:
  /// Step without contact forces: gaps at its start, and displacement and gaps at its end.
  struct Unforced {
    const State& start;
    const Vector &gap_before, &displacement, &gap;
  };
  /// Computes r in `normal`, which is zero before; returns false if neither r nor f acts. May use stage 0.
  virtual bool find_forces(const SemidiscreteProblem& problem, const ContactRows& rows, const Unforced& unforced,
                           StageSolve& stages, Vector& normal) = 0;
  virtual void add_other_forces(Vector&) const {}
  /// Energy stored by the contact at a displacement with these gaps: the sum of J and this changes by the dissipation
  /// of the law.
  [[nodiscard]] virtual double contact_energy(const Vector& displacement, const Vector& gap) const = 0;
  /// Dissipation of the law in the step that ends there, ≥ 0.
  [[nodiscard]] virtual double lost(const Vector&, const Vector&) const { return 0.0; }
  /// Work of f.
  [[nodiscard]] virtual double other_work(const Vector&) const { return 0.0; }

 private:
  StepCorrections corrections_;
  Vector before_, free_, normal_, displacement_;
  StageSolution solution_;
  mutable Vector gap_;  ///< work space
};

}  // namespace ricochet
