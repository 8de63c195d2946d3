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
///
/// Where contact nodes have no inertia a stage may state its conditions at the end of a step whose forces are those of
/// its middle. With A_c, the operator of an earlier number on the contact dofs, and ρ = (r_N, −r_T), H = [G; B_T], the
/// body then gets forces ρ̄, and the contact conditions hold for ρ and the contact motion m in place of δ, with s = 2:
///   A δ = b + Hᵀ ρ̄ + support reactions,   m = δ − ½ A_c⁻¹ Hᵀ (ℓ ρ + 2 (ρ̄ − ρ)).
/// ρ̄ is ρ, or a mean of the reactions over the step (ReactionMean). docs/energy.md has the reasons.
namespace ricochet {

/// Which dofs a stage solves for; δ is zero on the others that no support prescribes.
enum class StageDofs {
  all,
  contact,  ///< those of contact nodes
  massive,  ///< those with inertia
};

/// What acts on the body over a stage with a layer, ρ̄.
enum class ReactionMean : char {
  end,   ///< ρ
  path,  ///< the mean of the reactions while the gaps without them go straight from the start to the end
  mixed  ///< (1−μ) of that and μ of ρ: the least μ that keeps reactions smooth, see mean_reaction.hpp
};

/// A = mass·M + stiffness·K + damping·C, constant over a run.
struct OperatorCoefficients {
  double mass = 0.0;       ///< α
  double stiffness = 0.0;  ///< κ
  double damping = 0.0;    ///< η
  StageDofs dofs = StageDofs::all;
  int layer = -1;  ///< number of the operator A_c, before this one and of contact dofs; −1: the stage has none
  double layer_weight = 1.0;  ///< ℓ
  ReactionMean mean = ReactionMean::end;
  /// h, where stress of branches relaxes over the stage (viscous_force.hpp): K then has their stiffness. 0: they have
  /// none.
  double relaxation_step = 0.0;
};

/// When and where the velocities of the obstacles are taken that the conditions of a stage are relative to.
struct ObstacleInstant {
  double time = 0.0;
  double span = 0.0;    ///< They are means over [time − span/2, time + span/2]; 0: those at the time.
  double factor = 0.0;  ///< Contact points move by factor · δ from the displacement at which they are observed.
};

/// What the contact conditions of a stage are taken from, so that they can be taken again where rows follow the motion:
/// the gap at displacement + s δ at `time`, and the slip rate B_T (velocity + σ δ) less the obstacles'.
struct ContactMotion {
  Vector displacement, velocity;
  double time = 0.0;
  Vector start;  ///< displacement at the start of the step, if rows are those of the step; else empty
  double start_time = 0.0;
  /// Whether the velocities of the obstacles depend on δ. They are then those at observed + instant.factor δ, see
  /// observe_obstacles().
  bool observes = false;
  Vector observed;
  ObstacleInstant instant;
  Vector solution, gap_change, gap_change_rounding;  ///< work space: displacement + s δ, G δ
  ObstacleMotion obstacle;                           ///< work space
};

struct Stage {
  std::shared_ptr<const ContactRows> rows;  ///< G and B_T
  /// Set where the gaps of this stage, or the velocities of its obstacles, are not linear functions of δ: the solver
  /// takes rows and offsets anew until they hold at the solution.
  std::optional<ContactMotion> motion;
  std::vector<std::shared_ptr<ContactRows>> rows_in_store;  ///< memory for rows that follow the motion
  /// Velocities of the obstacles, which the conditions are relative to and on which the reactions work.
  ObstacleMotion obstacle;
  Vector right_hand_side;  ///< b, per dof
  /// Where the internal force f is no linear function of the displacement: a place p with −f(p) in b, and A δ
  /// stands for αM δ + ηC δ + f(p + κδ) − f(p). Empty: A δ is what it is.
  Vector force_place;
  /// The instant of the loads that follow the surface, and the part of them that acts: in b as they are at p, and anew
  /// where p + κδ is.
  double pressure_time = 0.0, pressure_part = 1.0;
  Vector prescribed;               ///< δ on supported dofs, in the order of Supports::dofs()
  std::vector<char> eligible;      ///< per contact point
  Vector gap_offset;               ///< q, per contact point
  Vector gap_offset_rounding;      ///< size of the rounding error of q: a y above −(this + the solver's own) is zero
  double gap_factor = 1.0;         ///< s
  double slip_factor = 1.0;        ///< σ
  Vector slip_offset;              ///< p, (d−1) per contact point; empty: no friction in this stage
  Vector slip_offset_rounding;     ///< size of the rounding error of p, per contact point
  std::vector<char> frictionless;  ///< per contact point: 1 where this stage leaves friction out; empty: nowhere
  /// Where the mean is not that of the end: y and the reactions at the start of the step, per contact point.
  Vector start_gap, start_normal_reaction, start_tangential_reaction;
};

struct StageSolution {
  Vector increment;                           ///< δ
  Vector normal_reaction;                     ///< r_N, per contact point; zero where not eligible
  Vector tangential_reaction;                 ///< r_T, (d−1) per contact point; empty without friction
  Vector support_reaction;                    ///< on supported dofs
  std::vector<ContactStatus> contact_status;  ///< per contact point
  int iterations = 0;                         ///< of the contact solver
  int rounds = 1;                             ///< linear stages that were solved, for an internal force that is none
  Vector follower_load;                       ///< what follows the surface, at p + κδ; empty: nothing does
  Vector contact_increment;                   ///< m on contact nodes, where the operator has a layer; else empty
  /// ρ̄, where it is not ρ: then not empty.
  Vector mean_normal_reaction, mean_tangential_reaction;
  double path_contact_work = 0.0;  ///< of normal reactions along the path: −(those just after its start) · start_gap
  double path_friction_work = 0.0;  ///< of tangential reactions along the path
  double end_weight = 1.0;          ///< μ of this stage

  /// No reactions: so many points, d − 1 tangents of each with friction and none without.
  void open_all(Index points, Index tangents) {
    normal_reaction.setZero(points);
    tangential_reaction.setZero(points * tangents);
    contact_status.assign(static_cast<std::size_t>(points), ContactStatus::open);
    clear_mean();
    iterations = 0;
  }
  /// The mean reactions are those of the end, until a stage says otherwise.
  void clear_mean() {
    mean_normal_reaction.resize(0);
    mean_tangential_reaction.resize(0);
    path_contact_work = path_friction_work = 0.0;
    end_weight = 1.0;
  }
  /// What acts on the body over the stage.
  [[nodiscard]] const Vector& acting_normal() const {
    return mean_normal_reaction.size() > 0 ? mean_normal_reaction : normal_reaction;
  }
  [[nodiscard]] const Vector& acting_tangential() const {
    return mean_tangential_reaction.size() > 0 ? mean_tangential_reaction : tangential_reaction;
  }
  /// What the contact conditions hold for: m, or δ.
  [[nodiscard]] const Vector& contact_motion() const {
    return contact_increment.size() > 0 ? contact_increment : increment;
  }
};

}  // namespace ricochet
