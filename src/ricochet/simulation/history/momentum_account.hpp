#pragma once

#include <span>

#include "ricochet/scheme/scheme.hpp"

/// @file Impulses of the forces that act on the body: what changes its momentum.
///
/// A rigid velocity does no work on the stress, so its product with the momentum equation is the balance of momentum:
/// over a step P₁ − P₀ = h (w₀ F₀ + w₁ F₁), with the resultants F of the loads, obstacles, supports and damping at the
/// two ends and the scheme's weights (WorkRule). The same for moments about the origin with reference positions. It
/// holds to rounding where the displacement's functions contain rigid rotations: not for degree 1 on curved cells. Of
/// an axisymmetric body only forces along its axis have an impulse: the others cancel over the ring, and so do all
/// moments.
/// At finite strain moments are about current positions, those of forces at the middle of the step: for schemes whose
/// internal forces are of that middle (Scheme::keeps_moments_at_finite_strain); or, where the forces of both ends of a
/// step act, about the positions at either.
namespace ricochet {

/// Resultant and moment, or momentum and angular momentum.
struct Resultant {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
};

class MomentumAccount {
 public:
  /// Opens the account on a starting state.
  MomentumAccount(const SemidiscreteProblem& problem, const Scheme& scheme, const State& state);
  void save(Snapshot& snapshot, const std::string& name) const;
  /// Of an account that was saved at the state this one was opened on.
  void load(const Snapshot& snapshot, const std::string& name);

  /// Enters a step with the forces at its end (in the state).
  void enter_step(const State& state);
  /// Enters an impulse per dof that acts between two steps, where the body is then.
  void enter_impulse(const State& state, const Vector& impulse);
  /// Since the start.
  [[nodiscard]] const Resultant& impulse() const { return impulse_; }
  /// Σ of the sizes of all impulses, of each kind of force by itself: what their sum is rounded to.
  [[nodiscard]] double size() const { return size_; }
  /// Largest distance of a node from the origin.
  [[nodiscard]] double arm() const { return arm_; }

 private:
  struct Sum {
    Resultant total;
    double size = 0.0;
  };
  [[nodiscard]] bool is_taken_by_nodes(Index point) const;
  [[nodiscard]] Resultant between_bodies(const StepForces& forces);
  [[nodiscard]] SpaceVector held_torque(const FreeMotion& body, const StepForces& forces);
  [[nodiscard]] bool places_change() const { return finite_strain_ || !problem_.free_bodies.empty(); }
  [[nodiscard]] Sum resultant(const StepForces& forces);
  [[nodiscard]] Sum of_springs();
  [[nodiscard]] Resultant algorithmic(const State& state);
  /// Of a resultant: contact, supports, loads, damping, and in the last one the size of the supports' forces.
  static constexpr std::size_t most_parts = 5;
  [[nodiscard]] Resultant part_of_nodes(const Vector& force) const;
  void add_up_ranks(std::span<Resultant> parts) const;
  [[nodiscard]] Resultant of_nodes(const Vector& force) const;
  void take_positions(const Vector& displacement);
  void add_impulse(double weight, const Resultant& resultant);

  const SemidiscreteProblem& problem_;
  const Scheme& scheme_;
  WorkRule rule_;
  double arm_ = 0.0;
  bool finite_strain_;
  Points positions_;  ///< of the nodes, that moments are taken with
  Vector before_;     ///< displacement at the start of the step, at finite strain
  bool has_springs_ = false;
  Vector mean_;  ///< displacement of the step, where there are springs
  Resultant constant_load_;
  Sum previous_;
  Resultant algorithmic_;                                         ///< of M a, Scheme::momentum_acceleration
  Vector acceleration_, momentum_, force_, normal_, tangential_;  ///< work space
  Resultant impulse_;
  double size_ = 0.0;
};

}  // namespace ricochet
