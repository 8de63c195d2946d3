#pragma once

#include <vector>

#include "ricochet/scheme/state.hpp"

/// @file Supported dofs in an explicit step: they follow their prescribed values, and their acceleration is the second
/// difference of these. The values at the end of the next step are in the state's memory.
namespace ricochet {

/// Key of State::memory: prescribed displacements at the end of the next step, in the order of the supports.
inline constexpr const char* supported_next = "supported_next";

/// Computes acceleration and reaction of supported dofs at t = 0. `mass` is the diagonal of M.
void start_supports(const SemidiscreteProblem& problem, const Vector& mass, double step, State& state);

class SupportedMotion {
 public:
  /// Keeps a reference to the dofs of contact nodes, including supported ones.
  explicit SupportedMotion(const std::vector<Index>& contact_node_dofs) : contact_node_dofs_(contact_node_dofs) {}
  /// Computes, at the end of a step with this displacement increment, acceleration, velocity, and the reaction M A + C
  /// V + K U − L − (Gᵀr_N − B_Tᵀr_T). `force` is K U there; `damping` is the diagonal of C, empty without damping.
  void advance(const SemidiscreteProblem& problem, const Vector& mass, const Vector& damping, const Vector& force,
               const Vector& load, const Vector& increment, double step, State& state);

 private:
  const std::vector<Index>& contact_node_dofs_;
  Vector contact_force_;  ///< per dof; nonzero only on contact nodes
};

}  // namespace ricochet
