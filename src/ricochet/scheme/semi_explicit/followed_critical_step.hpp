#pragma once

#include <string>
#include <vector>

#include "ricochet/scheme/state.hpp"

/// @file The critical step of central differences at finite strain, where it changes with the deformation: cells that
/// are squeezed are shorter and stiffer. With the tangent K(u) = ∂f/∂u, contact nodes held (critical_step.hpp),
///   h_c(u) = 2/√λ,   λ the largest eigenvalue of K_ii(u) x = λ M_ii x.
///
/// At the start λ is bounded from above as for the linear body, with K at the starting displacement. Then it is
/// followed. A check is due where the distance of two neighbouring nodes has changed, since the last check, by more
/// than 2 %, or by half of the room 1 − h/h_c where that is more, 15 % at most: such distances know no rotation, and
/// all of them are looked at after every step. Changes count in the proportion of k/m, k the largest diagonal entry of
/// K of a node and m its mass, to that of the stiffest node of all: soft cells must change more to matter. It is also
/// due where the highest frequencies carry much of the energy, (h²/8) AᵀMA > ½ (T + |W|): what a step that is too long
/// does first. A check takes some steps of Lanczos' method from the last eigenvector and a random part, by differences
/// of forces,
///   K(u) x ≈ [f(u + εx) − f(u)]/ε,
/// each with one evaluation of the internal force, and takes θ/(1−ε) of critical_step.hpp for λ. A stiff place that is
/// new is found as soon as it stands out of the spectrum; what is found is no bound, but a few per cent off at worst.
///
/// All that is remembered is in the state.
namespace ricochet {

class FollowedCriticalStep {
 public:
  explicit FollowedCriticalStep(std::string scheme) : scheme_(std::move(scheme)) {}

  /// `undeformed`: the critical step of the undeformed body.
  void analyse(const SemidiscreteProblem& problem, double undeformed);
  /// Of the starting state. Where the step is to be checked throws Error(invalid_input) where the step is too long for
  /// it.
  void start(const SemidiscreteProblem& problem, double step, bool check, State& state);
  /// Before a step, which is not taken where the step is beyond what was found last: throws Error(not_converged) that
  /// says where, and which step to take.
  void require_stable(const SemidiscreteProblem& problem, double step, const State& state);
  /// After a step, whose number the state does not have yet, with the internal force and the elastic energy there.
  /// Warns once of a step that is nearly as long.
  void follow(const SemidiscreteProblem& problem, double step, const Vector& force, double energy, State& state);
  /// What a step that turned cells inside out has to do with it: ends a sentence.
  [[nodiscard]] std::string explain(const SemidiscreteProblem& problem, double step, const State& state) const;

  /// So far.
  [[nodiscard]] double smallest() const { return smallest_; }

 private:
  struct Pair {
    Index first, second;  ///< nodes
    double weight;        ///< at most 1: how near the stiffest of them is to the stiffest node of all, undeformed
  };
  void find_pairs(const SemidiscreteProblem& problem);
  [[nodiscard]] bool is_due(const SemidiscreteProblem& problem, double step, double energy, const State& state) const;
  [[nodiscard]] double change_since(const SemidiscreteProblem& problem, const State& state) const;
  [[nodiscard]] double find(const SemidiscreteProblem& problem, const Vector& force, State& state);
  void take(double critical, State& state);
  [[nodiscard]] std::string place(const SemidiscreteProblem& problem, const State& state) const;

  std::string scheme_;
  std::vector<Pair> pairs_;  ///< of nodes that have a cell in common
  double shortest_ = 0.0;    ///< distance of two of them, undeformed
  Vector inverse_root_;      ///< M^{-½} on dofs with mass that no support holds, else 0, of masses brought near 1 …
  int exponent_ = 0;         ///< … by 2^exponent
  double smallest_ = 0.0;
  Vector place_, force_;
};

}  // namespace ricochet
