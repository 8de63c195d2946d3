#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ricochet/base/contact_status.hpp"
#include "ricochet/base/types.hpp"
#include "ricochet/contact/contact_rows.hpp"
#include "ricochet/problem/follower_pressure.hpp"

/// @file Interface between time schemes and step solvers: a step consists of one or more contact problems.
///
/// A stage determines an increment δ (the unknown is x = base + δ) and reactions such that
///   A δ = b + Gᵀ r_N − B_Tᵀ r_T + support reactions,   A = αM + κK + ηC,   δ given on supported dofs,
///   for each eligible contact point:  0 ≤ r_N,i ⟂ y_i = q_i + s (G δ)_i ≥ 0,
///     |r_T,i| ≤ F_i r_N,i,   r_T,i = F_i r_N,i w_i/|w_i| if the slip rate w_i = p_i + σ (B_T δ)_i is not zero.
/// b is the residual force at the base, q the gap (or gap rate) and p the slip rate there. Since the equations are
/// written in increments, no digits are lost between large inertia terms that cancel, and the energy balance closes to
/// rounding. Schemes do not depend on how a stage is solved; step solvers do not depend on time.
///
/// If the contact nodes have no inertia, a stage may impose its conditions at the end of a step whose forces
/// are those of its midpoint. With A_c, the operator of a preceding stage on the contact dofs, ρ = (r_N, −r_T)
/// and H = [G; B_T], forces ρ̄ then act on the body, and the contact conditions hold for ρ and the contact
/// motion m instead of δ, with s = 2:
///   A δ = b + Hᵀ ρ̄ + support reactions,   m = δ − ½ A_c⁻¹ Hᵀ (ℓ ρ + 2 (ρ̄ − ρ)).
/// ρ̄ is ρ or a mean of the reactions over the step (ReactionMean). docs/energy.md gives the reasons.
namespace ricochet {

/// Dofs for which a stage solves; δ is zero on all others unless a support prescribes it.
enum class StageDofs {
  all,
  contact,  ///< the dofs of contact nodes
  massive,  ///< the dofs with inertia
};

/// Definition of ρ̄, the reactions on the body over a stage with massless contact nodes.
enum class ReactionMean : char {
  end,   ///< ρ
  path,  ///< the mean of the reactions along the path: the gaps without them go straight from the start to the end
  mixed  ///< (1−μ) path + μ ρ with the smallest μ that keeps the reactions smooth, see mean_reaction.hpp
};

/// A = mass·M + stiffness·K + damping·C, constant over a run.
struct OperatorCoefficients {
  double mass = 0.0;       ///< α
  double stiffness = 0.0;  ///< κ
  double damping = 0.0;    ///< η
  StageDofs dofs = StageDofs::all;
  int condensed_operator =
      -1;  ///< index of the operator A_c on the contact dofs, which precedes this one; −1 if the stage has none
  double condensed_weight = 1.0;  ///< ℓ
  ReactionMean mean = ReactionMean::end;
  /// h if stress of viscoelastic branches relaxes over the stage (viscous_force.hpp): K then contains
  /// their stiffness. 0 if it does not.
  double relaxation_step = 0.0;
};

/// Time and positions of the obstacle velocities to which the conditions of a stage refer.
struct ObstacleInstant {
  double time = 0.0;
  double span = 0.0;    ///< length of [time − span/2, time + span/2], over which they are averaged; 0: instantaneous
  double factor = 0.0;  ///< contact points move by factor · δ from the displacement of the evaluation
};

/// Momentum equation of a stage, per dof of the problem.
struct RightHandSide {
  Vector force;       ///< b
  Vector prescribed;  ///< δ on supported dofs, in the order of Supports::dofs()
};

/// A motion of contact points as a function of δ: offset + factor · (rows δ).
struct AffineMotion {
  Vector offset;        ///< q, or p: (d−1) per contact point; no slip if empty
  Vector rounding;      ///< rounding error of the offset, per contact point
  double factor = 1.0;  ///< s, or σ
};

/// Conditions on the contact points with given rows.
struct ContactConditions {
  std::vector<char> eligible;      ///< per contact point: 0 if it carries no force in this stage
  AffineMotion gap;                ///< y: from −(rounding + the solver's own error) on it counts as y ≥ 0
  AffineMotion slip;               ///< w; empty if the stage has no friction
  std::vector<char> frictionless;  ///< per contact point: 1 if this stage omits its friction; empty: none
};

/// Start of the step, per contact point, from which a mean of the reactions is computed; empty for ReactionMean::end.
struct MeanStart {
  Vector gap, normal_reaction, tangential_reaction;
};

/// A stage with rows and forces that do not depend on δ: what the solver of an operator is given. A wrapper passes on
/// the parts that it leaves as they are.
struct LinearStage {
  const ContactRows& rows;  ///< G and B_T
  const RightHandSide& right_hand_side;
  const ContactConditions& conditions;
  const MeanStart& start;
};

/// Data from which the solver re-evaluates the contact conditions of a stage if rows follow the motion: the gap at
/// displacement + s δ at `time`, and the slip rate B_T (velocity + σ δ) relative to the obstacles.
struct ContactMotion {
  Vector displacement, velocity;
  double time = 0.0;
  Vector start;  ///< displacement at the start of the step if the rows are those of a step; else empty
  double start_time = 0.0;
  /// Whether the obstacle velocities depend on δ. They are then evaluated at obstacle_displacement +
  /// instant.factor δ, see evaluate_obstacle_velocity().
  bool reevaluates_obstacles = false;
  Vector obstacle_displacement;
  ObstacleInstant instant;
  Vector solution, gap_change, gap_change_rounding;  ///< work space: displacement + s δ, G δ
  ObstacleMotion obstacle;                           ///< work space
};

/// Linearization of a nonlinear internal force f at a displacement p.
struct ForceLinearization {
  /// p: b contains −f(p), and A δ stands for αM δ + ηC δ + f(p + κδ) − f(p). Empty if A δ is linear.
  Vector base;
  /// Loads that follow the surface: b contains them at p, and the solver re-evaluates them at p + κδ.
  FollowerPressure::Instant pressure;
};

struct Stage {
  std::shared_ptr<const ContactRows> rows;  ///< G and B_T
  RightHandSide right_hand_side;
  ContactConditions conditions;
  MeanStart start;
  ForceLinearization linearization;
  /// Set if the gaps of this stage, or the velocities of its obstacles, are nonlinear functions of δ: the solver then
  /// re-evaluates rows and offsets until they hold at the solution.
  std::optional<ContactMotion> motion;
  /// Obstacle velocities: the conditions are relative to them, and the reactions do work on them.
  ObstacleMotion obstacle;
  std::vector<std::shared_ptr<ContactRows>> row_storage;  ///< storage for rows that follow the motion

  /// The stage with its present rows and right-hand side.
  [[nodiscard]] LinearStage linear() const { return {*rows, right_hand_side, conditions, start}; }
};

struct StageSolution {
  Vector increment;                           ///< δ
  Vector normal_reaction;                     ///< r_N, per contact point; zero if not eligible
  Vector tangential_reaction;                 ///< r_T, (d−1) per contact point; empty without friction
  Vector support_reaction;                    ///< on supported dofs
  std::vector<ContactStatus> contact_status;  ///< per contact point
  int iterations = 0;                         ///< of the contact solver, not of Newton's method
  int newton_iterations = 1;                  ///< Newton iterations; 1 if the internal force is linear
  Vector follower_load;                       ///< loads that follow the surface, at p + κδ; empty if there are none
  Vector contact_increment;                   ///< m on contact nodes, if the operator has an A_c; else empty
  /// ρ̄; empty if it equals ρ.
  Vector mean_normal_reaction, mean_tangential_reaction;
  double path_contact_work = 0.0;  ///< of normal reactions along the path: −(those just after its start) · start.gap
  double path_friction_work = 0.0;  ///< of tangential reactions along the path
  double end_weight = 1.0;          ///< μ of this stage

  /// Sets all reactions to zero at `points` contact points; `tangents`: d − 1 per point with friction, 0 without.
  void open_all(Index points, Index tangents) {
    normal_reaction.setZero(points);
    tangential_reaction.setZero(points * tangents);
    contact_status.assign(static_cast<std::size_t>(points), ContactStatus::open);
    clear_mean();
    iterations = 0;
  }
  /// Makes the mean reactions those of the end, the default until a stage sets them.
  void clear_mean() {
    mean_normal_reaction.resize(0);
    mean_tangential_reaction.resize(0);
    path_contact_work = path_friction_work = 0.0;
    end_weight = 1.0;
  }
  /// Reactions that act on the body over the stage.
  [[nodiscard]] const Vector& acting_normal() const {
    return mean_normal_reaction.size() > 0 ? mean_normal_reaction : normal_reaction;
  }
  [[nodiscard]] const Vector& acting_tangential() const {
    return mean_tangential_reaction.size() > 0 ? mean_tangential_reaction : tangential_reaction;
  }
  /// Motion for which the contact conditions hold: m, or δ.
  [[nodiscard]] const Vector& contact_motion() const {
    return contact_increment.size() > 0 ? contact_increment : increment;
  }
};

}  // namespace ricochet
