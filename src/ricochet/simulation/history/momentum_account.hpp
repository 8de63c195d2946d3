#pragma once

#include <span>

#include "ricochet/problem/contact_couples.hpp"
#include "ricochet/scheme/scheme.hpp"

/// @file Balance of momentum: impulses of all forces that act on the body.
///
/// A rigid velocity does no work on the stress, so that its product with the momentum equation is the balance of
/// momentum: over a step P₁ − P₀ = h (w₀ F₀ + w₁ F₁), with the resultants F of the loads, obstacles, supports and
/// damping at the two ends and the scheme's weights (WorkRule). Likewise for moments about the origin with reference
/// positions. The balance holds to rounding if the displacement space contains rigid rotations, which degree 1 on
/// curved cells does not. In an axisymmetric body only forces along the axis have an impulse: the other forces cancel
/// over the ring, and so do all moments.
/// At finite strain moments are about current positions: at the middle of the step for schemes that evaluate internal
/// forces there (SchemeTraits::conserves_moments_at_finite_strain), or, if the forces of both ends of a step act, at
/// the respective end.
namespace ricochet {

/// Resultant force and moment, or momentum and angular momentum.
struct Resultant {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();

  [[nodiscard]] auto members() { return std::tie(force, moment); }
};

class MomentumAccount {
 public:
  /// Opens the account on a starting state.
  MomentumAccount(const SemidiscreteProblem& problem, const Scheme& scheme, const State& state);
  /// Saves the account, or loads one that was saved at the state on which this one was opened.
  void persist(const SnapshotVisitor& visit);

  /// Enters a step with the forces at its end (in the state).
  void enter_step(const State& state);
  /// Enters an impulse per dof that acts between two steps, at the current position of the body.
  void enter_impulse(const State& state, const Vector& impulse);
  /// Impulse since the start.
  [[nodiscard]] const Resultant& impulse() const { return impulse_; }
  /// Σ of the magnitudes of all impulses: of the resultants of each kind of force, and of each supported dof.
  [[nodiscard]] double size() const { return size_; }
  /// Σ of the magnitudes of the impulses of all contact points, which may cancel in their resultant and leave its
  /// rounding.
  [[nodiscard]] double contact_size() const { return contact_size_; }
  /// Largest distance of a node from the origin so far.
  [[nodiscard]] double arm() const { return arm_; }

 private:
  struct Sum {
    Resultant total;
    double size = 0.0, contact_size = 0.0;
  };
  [[nodiscard]] bool is_summed_by_nodes(Index point) const;
  [[nodiscard]] Resultant between_bodies(const StepForces& forces);
  [[nodiscard]] SpaceVector support_torque(const FreeMotion& body, const StepForces& forces);
  [[nodiscard]] bool positions_change() const { return finite_strain_ || !problem_.free_bodies.empty(); }
  [[nodiscard]] Sum resultant(const StepForces& forces);
  [[nodiscard]] Sum of_springs();
  [[nodiscard]] Resultant algorithmic(const State& state);
  /// Parts of a resultant: contact, supports, loads, damping, and in the last one the magnitudes of the forces of
  /// supports and of contact points.
  static constexpr std::size_t most_parts = 5;
  [[nodiscard]] Resultant part_of_nodes(const Vector& force) const;
  void add_up_ranks(std::span<Resultant> parts) const;
  [[nodiscard]] Resultant of_nodes(const Vector& force) const;
  void update_positions(const Vector& displacement);
  void add_impulse(double weight, const Resultant& resultant);

  const SemidiscreteProblem& problem_;
  const Scheme& scheme_;
  WorkRule rule_;
  ContactCouples couples_;
  double arm_ = 0.0;
  bool finite_strain_;
  Points positions_;  ///< of the nodes, about which moments are computed
  Vector displacement_of_forces_;
  Vector displacement_before_;  ///< displacement at the start of the step, at finite strain or with rigid bodies
  bool has_springs_ = false;
  Vector mean_;  ///< mean displacement over the step, with springs
  Resultant constant_load_;
  Sum previous_;
  Resultant algorithmic_;                                         ///< of M a, Scheme::momentum_acceleration
  Vector acceleration_, momentum_, force_, normal_, tangential_;  ///< work space
  Resultant impulse_;
  double size_ = 0.0, contact_size_ = 0.0;
};

}  // namespace ricochet
