#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "ricochet/base/contact_status.hpp"
#include "ricochet/base/types.hpp"
#include "ricochet/contact/contact_rows.hpp"

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
/// If the contact nodes have no inertia, a stage may impose its conditions at the end of a step whose forces are those
/// of its midpoint. Let A_c be the operator of a preceding stage on the contact dofs, ρ = (r_N, −r_T) the reactions and
/// H = [G; B_T] the rows of all points. The acting reactions ρ̄ are ρ or a mean of the reactions over the step
/// (ActingReaction). They act on the body, while the contact conditions hold for ρ and, with s = 2, for the contact
/// motion m in place of δ:
///   A δ = b + Hᵀ ρ̄ + support reactions,   m = δ − ½ A_c⁻¹ Hᵀ (ℓ ρ + 2 (ρ̄ − ρ)).
/// ℓ is 1 without stiffness damping. docs/energy.md gives the reasons.
namespace ricochet {

/// Dofs for which a stage solves; δ is zero on all others unless a support prescribes it.
enum class StageDofs {
  all,
  contact,  ///< the dofs of contact nodes
  massive,  ///< the dofs with inertia
};

/// Definition of ρ̄, the reactions on the body over a stage with massless contact nodes.
enum class ActingReaction : char {
  end,        ///< ρ
  path_mean,  ///< the mean of the reactions over a step in which the gaps without reactions change linearly
  /// (1−μ) path_mean + μ ρ with the least μ in [0, 1] for which a sustained reaction does not alternate from step to
  /// step: the factor from one to the next is at least −½ without friction, and at least 0 with it
  mixed_mean
};

/// A = mass·M + stiffness·K + damping·C, constant for one step length. At finite strain K is the tangent of the last
/// refactorization.
struct OperatorCoefficients {
  double mass = 0.0;       ///< α
  double stiffness = 0.0;  ///< κ
  double damping = 0.0;    ///< η
  StageDofs dofs = StageDofs::all;
  /// Index of the operator A_c on the contact dofs, which precedes this one; −1 if the stage has none.
  int condensed_operator = -1;
  double condensed_weight = 1.0;  ///< ℓ, factor of ρ in m, 0 < ℓ ≤ 1
  ActingReaction acting = ActingReaction::end;
  /// h if stress of viscoelastic branches relaxes over the stage (viscous_force.hpp): K then contains the tangent of
  /// their forces over a step of this length. 0 if it does not.
  double relaxation_step = 0.0;
};

/// Instant or interval, and positions, of the obstacle velocities to which the conditions of a stage refer.
struct ObstacleInstant {
  double time = 0.0;    ///< absolute: the middle of the interval
  double span = 0.0;    ///< length of the interval over which velocities are averaged, as a time; 0: instantaneous
  double factor = 0.0;  ///< contact points are at factor · δ from the displacement of the evaluation
};

/// Momentum equation of a stage, per dof of the problem.
struct RightHandSide {
  Vector force;       ///< b, acting on the body
  Vector prescribed;  ///< δ on supported dofs, in the order of Supports::dofs()
};

/// A motion of contact points as a function of δ: offset + factor · (rows δ).
struct AffineMotion {
  Vector offset;        ///< q, one per contact point; or p, (d−1) per contact point
  Vector rounding;      ///< rounding error of all components of the offset, one per contact point
  double factor = 1.0;  ///< s, without unit if y is a gap, 1/time if it is a rate; or σ, 1/time
};

/// Conditions on the contact points with given rows.
struct ContactConditions {
  std::vector<char> eligible;      ///< flag per contact point: 0 if it carries no force in this stage, else 1
  AffineMotion gap;                ///< y; y ≥ −(rounding + the solver's own error) counts as y ≥ 0
  AffineMotion slip;               ///< w; empty if the stage has no friction
  std::vector<char> frictionless;  ///< flag per contact point: 1 if this stage omits its friction; empty: all 0
};

/// State of the contact points at the start of a step over which a mean of the reactions is computed: one gap, one
/// normal and (d−1) tangential reactions per point. Empty for ActingReaction::end.
struct MeanStart {
  Vector gap, normal_reaction, tangential_reaction;
};

/// A stage with rows and forces that do not depend on δ: what the solver of an operator is given. A wrapper passes on
/// the parts that it leaves as they are. Refers to the parts, which must outlive it.
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
  /// obstacle_instant.factor δ (evaluate_obstacle_velocity).
  bool reevaluates_obstacles = false;
  Vector obstacle_displacement;
  ObstacleInstant obstacle_instant;

  /// Work space of the functions of contact_conditions.hpp.
  struct Work {
    Vector displacement, gap_change, gap_change_rounding;
    ObstacleMotion obstacle;
  } work = {};

  /// Moves the origin of δ, from that of `origin`, by an increment of a stage with these conditions.
  void move_origin(const ContactMotion& origin, const ContactConditions& conditions, const Vector& increment) {
    displacement = origin.displacement + conditions.gap.factor * increment;
    if (conditions.slip.offset.size() > 0) velocity = origin.velocity + conditions.slip.factor * increment;
    if (reevaluates_obstacles)
      obstacle_displacement = origin.obstacle_displacement + obstacle_instant.factor * increment;
  }
};

/// Linearization of a nonlinear internal force f at a displacement p.
struct ForceLinearization {
  /// p: b contains −f(p), and A δ stands for αM δ + ηC δ + f(p + κδ) − f(p). Empty if A δ is linear.
  Vector displacement;
  /// Time and scale factor of the loads that follow the surface: b contains them at p, and the solver re-evaluates them
  /// at p + κδ.
  double load_time = 0.0, load_part = 1.0;
};

/// Contact problem of a step, as a scheme states it.
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
  /// Whether these are known: evaluate_obstacle_velocity() sets it, and require_friction() clears it again.
  bool has_obstacle_velocity = false;
  std::vector<std::shared_ptr<ContactRows>> row_storage;  ///< storage for rows that follow the motion

  /// The stage with its present rows and right-hand side.
  [[nodiscard]] LinearStage linear() const { return {*rows, right_hand_side, conditions, start}; }
};

/// Reactions of a step. With several ranks, those of the local points and supports.
struct Reactions {
  Vector normal_reaction;      ///< r_N, one per contact point; zero if not eligible
  Vector tangential_reaction;  ///< r_T, (d−1) per contact point; empty without friction
  /// ρ̄, means that act on the body over a step at whose end the ones above hold; empty if they are equal.
  Vector mean_normal_reaction, mean_tangential_reaction;
  double end_weight = 1.0;  ///< μ, weight of the reactions at the end in that mean
  Vector support_reaction;  ///< force of the support on the body, in the order of Supports::dofs()

  /// Reactions that act on the body over the step.
  [[nodiscard]] const Vector& acting_normal() const {
    return mean_normal_reaction.size() > 0 ? mean_normal_reaction : normal_reaction;
  }
  [[nodiscard]] const Vector& acting_tangential() const {
    return mean_tangential_reaction.size() > 0 ? mean_tangential_reaction : tangential_reaction;
  }
};

/// Solution of a stage.
struct StageSolution : Reactions {
  Vector increment;                           ///< δ
  std::vector<ContactStatus> contact_status;  ///< per contact point
  int iterations = 0;                         ///< iterations of the contact solver
  int newton_iterations = 1;                  ///< iterations of Newton's method; 1 if the internal force is linear
  Vector follower_load;                       ///< loads that follow the surface, at p + κδ; empty if there are none
  Vector contact_increment;                   ///< m on contact nodes, if the operator has an A_c; else empty
  /// Energies that reactions along the path of ActingReaction::path_mean bring to the body, negative if lost: normal
  /// ones, −(those just after the start of the path) · MeanStart::gap; and tangential ones.
  double path_contact_work = 0.0, path_friction_work = 0.0;

  /// Sets all reactions to zero at `points` contact points, with d − 1 tangents per point, or 0 without friction.
  void open_all(Index points, Index tangents_per_point) {
    normal_reaction.setZero(points);
    tangential_reaction.setZero(points * tangents_per_point);
    contact_status.assign(std::size_t(points), ContactStatus::open);
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
  /// Motion for which the contact conditions hold: m, or δ.
  [[nodiscard]] const Vector& contact_motion() const {
    return contact_increment.size() > 0 ? contact_increment : increment;
  }
};

}  // namespace ricochet
