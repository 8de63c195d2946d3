#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/step/stage.hpp"

/// @file State of a run between two steps: everything that the next step depends on.
namespace ricochet {

/// Forces at the scheme's instant of a step, as in its momentum equation.
struct StepForces : Reactions {
  std::shared_ptr<const ContactRows> rows;  ///< directions of the reactions: Gᵀ r_N − B_Tᵀ r_T is their nodal force
  Vector varying_load;                      ///< varying part of L, per dof; empty without one
  Vector damping_force;                     ///< C times the scheme's velocity, per dof; empty without damping
};

/// Vectors by name. `at` throws Error(invalid_input) if there is none of this size: a checkpoint that was loaded is
/// damaged.
struct SchemeMemory : std::map<std::string, Vector> {
  [[nodiscard]] Vector& at(const std::string& name, Index size);
  [[nodiscard]] const Vector& at(const std::string& name, Index size) const;
};

struct State {
  long step = 0;
  double time = 0.0;
  Vector displacement;  ///< U at `time`
  Vector velocity;      ///< V; on massless dofs the mean velocity of the last step
  Vector acceleration;  ///< A; 0 on massless dofs
  /// Internal strains of viscoelastic branches (viscous_force.hpp); empty if none.
  Vector internal_strain;
  StepForces forces;
  std::vector<ContactStatus> contact_status;  ///< per contact point, at the instant of the forces
  /// Displacement of the obstacles at the contact points over the increment of the last step.
  ObstacleMotion obstacle_increment;
  int iterations = 0;         ///< of the contact solver in the last step
  int newton_iterations = 0;  ///< Newton iterations of the last step, with all attempts and substeps; 0 if linear
  /// Further memory of the scheme, so that a checkpoint can contain it: one value per dof, per supported dof, (d−1) per
  /// contact point, or `memory_numbers` of them.
  static constexpr Index memory_numbers = 5;
  SchemeMemory memory;

  /// Vector of the memory with one value per dof.
  [[nodiscard]] Vector& dof_memory(const std::string& name) { return memory.at(name, displacement.size()); }
  [[nodiscard]] const Vector& dof_memory(const std::string& name) const { return memory.at(name, displacement.size()); }
};

/// Saves and loads a state of this problem. Throws Error(invalid_input) if sizes do not match.
void persist(const SnapshotVisitor& visit, const SemidiscreteProblem& problem, State& state);

}  // namespace ricochet
