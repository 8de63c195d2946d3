#pragma once

#include "ricochet/base/snapshot.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"

/// @file Cells that only the control of distortion (fem/distortion_control.hpp) keeps from being turned inside out.
namespace ricochet {

class DistortionWatch {
 public:
  /// Keeps references.
  DistortionWatch(const Body& body, const SemidiscreteProblem& problem) : body_(body), problem_(problem) {}
  void persist(const SnapshotVisitor& visit) { visit("energy", largest_energy_); }

  /// Enters a state. Warns the first time that the control has energy.
  void watch(double time, const State& state);
  /// Largest energy of the control so far.
  [[nodiscard]] double largest_energy() const { return largest_energy_; }

 private:
  const Body& body_;
  const SemidiscreteProblem& problem_;
  double largest_energy_ = 0.0;
};

}  // namespace ricochet
