#pragma once

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file Loads of a step whose forces act at its middle x, and whose contact nodes are in equilibrium at its end.
namespace ricochet {

/// Forces per dof. Over the step act L̄ = ½(L₀+L₁) of loads with a fixed direction, and P(x), with the mean of the
/// pressures at both ends, of loads that follow the surface; at its end L₁ and P(u₁).
class StepLoads {
 public:
  void start(const SemidiscreteProblem& problem, double step, const State& state);
  /// Evaluates pressures at these displacements; at the end only if there are contact nodes.
  void evaluate(const SemidiscreteProblem& problem, const Vector& middle, const Vector& end, bool has_contact_nodes);

  [[nodiscard]] const Vector& mean() const { return mean_; }
  /// True if anything acts at the ends of a step besides L̄.
  [[nodiscard]] bool acts_at_ends() const { return varies_ || follows_; }
  /// L₁ − L̄ + P(u₁).
  [[nodiscard]] const Vector& beside_at_end() const { return at_end_; }
  /// Adds L₀ − L̄ + P₀, with P₀ = 2 P(x) − P(u₁).
  void add_at_start(Vector& force) const {
    force -= at_end_;
    if (follows_) force += 2.0 * pressure_;
  }
  void add_pressure(Vector& force) const {
    if (follows_) force += pressure_;
  }
  /// Work of linearly changing loads on the given dofs over the step, besides (L̄ + P(x))·(u₁ − u₀): as x is the mean
  /// of their displacements, (L₁ − L₀ + P(u₁) − P₀)·(½(u₀+u₁) − x).
  [[nodiscard]] double work_of_change(const std::vector<Index>& dofs, const Vector& start, const Vector& end,
                                      const Vector& middle) const;
  /// Writes the varying part of L̄ and P(x), if any.
  void store_varying(Vector& varying_load) const;

 private:
  bool varies_ = false, follows_ = false;
  double start_time_ = 0.0, end_time_ = 0.0;
  Vector mean_, varying_, rise_;  ///< L̄, its varying part, ½(L₁ − L₀)
  Vector pressure_, at_end_;      ///< P(x), ½(L₁ − L₀) + P(u₁)
};

}  // namespace ricochet
