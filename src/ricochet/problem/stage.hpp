#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/contact_status.hpp"
#include "ricochet/base/types.hpp"
#include "ricochet/contact/contact_rows.hpp"

/// @file What a time scheme and a step solver say to each other: a step is one or more contact problems.
///
/// A stage asks for an increment δ (the unknown is x = base + δ) and reactions such that
///   A δ = b + Gᵀ r_N − B_Tᵀ r_T + support reactions,   A = αM + κK + ηC,   δ given on supported dofs,
///   for each eligible contact point:  0 ≤ r_N,i ⟂ y_i = q_i + s (G δ)_i ≥ 0,
///     |r_T,i| ≤ F_i r_N,i,   r_T,i = F_i r_N,i w_i/|w_i| where the slip rate w_i = p_i + σ (B_T δ)_i is not zero.
/// b is the residual force at the base, q the gap (or gap rate) and p the slip rate there: written in increments, no
/// digits are lost between large inertia terms that cancel, and the energy account closes to rounding.
/// A scheme knows nothing of how a stage is solved; a step solver knows nothing of time.
namespace ricochet {

/// Which dofs a stage solves for; δ is zero on the others that no support prescribes.
enum class StageDofs {
  all,
  contact,  ///< those of contact nodes
  massive,  ///< those with inertia
};

/// A = mass·M + stiffness·K + damping·C, constant over a run.
struct OperatorCoefficients {
  double mass = 0.0;       ///< α
  double stiffness = 0.0;  ///< κ
  double damping = 0.0;    ///< η
  StageDofs dofs = StageDofs::all;
};

/// What the contact conditions of a stage are taken from, so that they can be taken again where rows follow the motion:
/// the gap at displacement + δ at `time`, and the slip rate B_T (velocity + σ δ) less the obstacles'.
struct ContactMotion {
  Vector displacement, velocity;
  double time = 0.0;
  Vector solution, gap_change, gap_change_rounding;  ///< work space: displacement + δ, G δ
};

struct Stage {
  std::shared_ptr<const ContactRows> rows;  ///< G and B_T
  /// Set where the gaps of this stage are no linear functions of δ: the solver takes rows and offsets anew until they
  /// hold at the solution.
  std::optional<ContactMotion> motion;
  std::vector<std::shared_ptr<ContactRows>> rows_in_store;  ///< memory for rows that follow the motion
  ObstacleMotion obstacle;                                  ///< where rows follow the motion: velocities along them
  Vector right_hand_side;                                   ///< b, per dof
  Vector prescribed;                                        ///< δ on supported dofs, in the order of Supports::dofs()
  std::vector<char> eligible;                               ///< per contact point
  Vector gap_offset;                                        ///< q, per contact point
  Vector gap_offset_rounding;      ///< size of the rounding error of q: a y above −(this + the solver's own) is zero
  double gap_factor = 1.0;         ///< s
  double slip_factor = 1.0;        ///< σ
  Vector slip_offset;              ///< p, (d−1) per contact point; empty: no friction in this stage
  Vector slip_offset_rounding;     ///< size of the rounding error of p, per contact point
  std::vector<char> frictionless;  ///< per contact point: 1 where this stage leaves friction out; empty: nowhere
};

struct StageSolution {
  Vector increment;                           ///< δ
  Vector normal_reaction;                     ///< r_N, per contact point; zero where not eligible
  Vector tangential_reaction;                 ///< r_T, (d−1) per contact point; empty without friction
  Vector support_reaction;                    ///< on supported dofs
  std::vector<ContactStatus> contact_status;  ///< per contact point
  int iterations = 0;                         ///< of the contact solver
};

}  // namespace ricochet
