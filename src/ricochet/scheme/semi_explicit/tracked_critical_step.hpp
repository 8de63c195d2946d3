#pragma once

#include <string>
#include <vector>

#include "ricochet/scheme/state.hpp"

/// @file Critical step of central differences at finite strain, where it changes with the deformation: compressed cells
/// are shorter and stiffer. With the tangent K(u) = ∂f/∂u, contact nodes held (critical_step.hpp),
///   h_c(u) = 2/√λ,   λ the largest eigenvalue of K_ii(u) x = λ M_ii x.
///
/// At the start λ is bounded from above as for the linear body, with K at the starting displacement. Afterwards it is
/// tracked. A check is due if the distance of two neighbouring nodes has changed, since the last check, by more than 2
/// %, or by half of the margin 1 − h/h_c if that is more, 15 % at most: distances are invariant under rotation, and all
/// of them are evaluated after every step. Changes are weighted by the ratio of k/m, k the largest diagonal entry of K
/// of a node and m its mass, to that of the stiffest node of all: soft cells must change more to matter. A check is
/// also due if the highest frequencies carry much of the energy, (h²/8) AᵀMA > ½ (T + |W|), which is the first symptom
/// of a step that is too long. A check performs some steps of Lanczos' method from the last eigenvector and a random
/// part, by differences of forces,
///   K(u) x ≈ [f(u + εx) − f(u)]/ε,
/// each with one evaluation of the internal force, and uses θ/(1−ε) of critical_step.hpp for λ. A new stiff region is
/// found as soon as it stands out of the spectrum; the result is no bound, but a few per cent off at worst.
///
/// Everything that is remembered is in the state.
namespace ricochet {

class TrackedCriticalStep {
 public:
  explicit TrackedCriticalStep(std::string scheme) : scheme_(std::move(scheme)) {}

  /// `undeformed` is the critical step of the undeformed body.
  void analyse(const SemidiscreteProblem& problem, double undeformed);
  /// Initializes the memory for the starting state. With `check`, throws Error(invalid_input) if the step is too long
  /// for it.
  void start(const SemidiscreteProblem& problem, double step, bool check, State& state);
  /// Checks a step before it is taken against the last critical step found: throws Error(not_converged), which names
  /// the position and the step to use.
  void require_stable(const SemidiscreteProblem& problem, double step, const State& state);
  /// Updates the critical step after a step, whose number the state does not have yet, with the internal force and the
  /// elastic energy there. Warns once if the step is nearly as long.
  void track(const SemidiscreteProblem& problem, double step, const Vector& force, double energy, State& state);
  /// Explains, at the end of a sentence, how the critical step relates to a step that inverted cells.
  [[nodiscard]] std::string explain(const SemidiscreteProblem& problem, double step, const State& state) const;

  /// Smallest critical step so far.
  [[nodiscard]] double smallest() const { return smallest_; }

 private:
  struct Pair {
    Index first, second;  ///< nodes
    double weight;        ///< at most 1: k/m of the stiffer of them, relative to the stiffest node of all, undeformed
  };
  void find_pairs(const SemidiscreteProblem& problem);
  [[nodiscard]] bool is_due(const SemidiscreteProblem& problem, double step, double energy, const State& state) const;
  [[nodiscard]] double change_since(const SemidiscreteProblem& problem, const State& state) const;
  [[nodiscard]] double find(const SemidiscreteProblem& problem, const Vector& force, State& state);
  void store(double critical, State& state);
  [[nodiscard]] std::string location_text(const SemidiscreteProblem& problem, const State& state) const;

  std::string scheme_;
  std::vector<Pair> pairs_;  ///< of nodes with a common cell
  double shortest_ = 0.0;    ///< smallest distance of two of them, undeformed
  Vector inverse_root_;      ///< M^{-½} on unsupported dofs with mass, else 0, of masses brought near 1 …
  int exponent_ = 0;         ///< … by 2^exponent
  double smallest_ = 0.0;
  Vector displacement_, force_;
};

}  // namespace ricochet
