#pragma once

#include <limits>
#include <optional>
#include <string>

#include "ricochet/step/stage.hpp"

/// @file Properties of schemes, so that no caller has to know one by name.
namespace ricochet {

/// Weights of a step's forces in the balance of energy:
/// work of a force F over a step = incrementᵀ (previous_weight F_previous + current_weight F_current).
struct WorkRule {
  double previous_weight = 0.0;
  double current_weight = 1.0;
};

/// Effect of a jump in the velocity of a prescribed displacement on the forces at its dofs, which have inertia, in the
/// steps that follow.
enum class JumpResponse { fades, alternates, grows };

/// Properties that hold for every problem. The instants are those of a row of the history, relative to its time, in
/// steps.
struct SchemeTraits {
  double energy_instant = 0.0;
  double force_instant = 0.0;   ///< of the forces shown
  double acting_instant = 0.0;  ///< of the forces that acted over a step: its middle if those shown are of its end
  WorkRule work_rule = {};
  /// Default number of steps between rows of the history: more than one if a row costs over half a step.
  long history_every = 1;
  /// True if steps of different lengths may follow one another: neither the state's memory nor energy_state() depends
  /// on the last length, and advance() moves by step(). (algorithmic_energy() may: the account books the difference.)
  bool supports_step_changes = false;
  /// True if the scheme supports internal forces that are nonlinear in the displacement.
  bool supports_nonlinear_force = false;
  /// True if, in addition, its steps relax viscoelastic branches (viscous_force.hpp) and report their dissipation.
  bool supports_relaxation = false;
  /// True if the scheme supports a body divided among ranks: it operates on each rank's part and solves stages.
  bool supports_ranks = true;
  /// True if rigid bodies that move under the forces on them (free_motion.hpp) are part of its steps.
  bool supports_free_bodies = false;
  /// True if, at finite strain, its steps change the angular momentum about current positions only by the moments of
  /// external forces about the positions at which these act.
  bool conserves_moments_at_finite_strain = false;
  /// True if its contact forces create hardly any energy with a mass without inertia on contact nodes.
  bool suits_singular_mass = false;
  /// True if nodes with inertia that friction holds keep a velocity of alternating sign.
  bool stuck_nodes_alternate = false;
  JumpResponse jump_response = JumpResponse::fades;
};

/// Consequence of steps longer than `crossings` times the time in which a wave crosses a cell: `trouble` completes a
/// sentence that begins with such a step. Empty: none known.
struct LongSteps {
  double crossings = 1.0;
  std::string trouble = {};
  bool shorter_steps_help = true;
};

/// Properties that depend on the problem.
struct ProblemTraits {
  /// Reactions that act on the body over a step, for schemes with a choice; none without contact.
  std::optional<ReactionMean> acting_reactions = {};
  LongSteps long_steps = {};
  /// Key and value of the case file with which the scheme loses less energy in impacts; empty: none.
  std::string setting_that_loses_less = {};
};

}  // namespace ricochet
