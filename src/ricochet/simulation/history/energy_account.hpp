#pragma once

#include <functional>
#include <optional>

#include "ricochet/scheme/scheme.hpp"

/// @file Energy balance, in which each term is computed from forces and increments, never as a remainder.
namespace ricochet {

/// Cumulative works since the start.
struct Works {
  double load = 0.0;      ///< of the time-dependent loads
  double contact = 0.0;   ///< of normal reactions on the change of the gaps
  double friction = 0.0;  ///< of tangential reactions on the slip relative to the obstacle
  double support = 0.0;
  double obstacle = 0.0;  ///< of all reactions on the motion of the obstacles: the energy that these supply to the body
  double damping = 0.0;
  double numerical_dissipation = 0.0;  ///< removed by the scheme, positive when energy is lost
  double integration_error = 0.0;      ///< change of the elastic energy that the scheme's internal forces miss
  double viscous_dissipation = 0.0;    ///< of viscoelastic branches, turned into heat; never decreases
  /// Part of `contact`: work of normal reactions between bodies with large sliding on the change of the gaps that their
  /// rows miss. Zero to rounding for rows of steps (sliding_contact.hpp), except where the facing facets change
  /// abruptly.
  double re_pairing = 0.0;
  double velocity_correction = 0.0;  ///< kinetic energy added to close the balance of steps: no term of the account

  [[nodiscard]] double sum() const { return load + contact + friction + support + obstacle + damping; }
};

struct Energies {
  double kinetic = 0.0;
  double elastic = 0.0;         ///< including the energy of viscoelastic branches
  double load_potential = 0.0;  ///< −LᵀU of the constant loads
  double algorithmic = 0.0;

  [[nodiscard]] double total() const { return kinetic + elastic + load_potential; }
};

class EnergyAccount {
 public:
  /// Opens the account on a starting state.
  EnergyAccount(const SemidiscreteProblem& problem, const Scheme& scheme, const State& state);
  /// Resumes an account that was saved at this state.
  EnergyAccount(const SemidiscreteProblem& problem, const Scheme& scheme, const State& state,
                const SnapshotVisitor& saved);
  void persist(const SnapshotVisitor& visit);

  /// Enters a step: its displacement increment and the forces at its end (in the state).
  void enter_step(const Vector& increment, const State& state);
  /// Calls `change`, which changes the length of the scheme's next step and with it the algorithmic energy of the
  /// state: the difference counts as numerical dissipation.
  void change_step(const State& state, const std::function<void()>& change);
  /// Calls `change`, which changes the velocity of the body between two steps: the difference of energy counts as work
  /// of the loads.
  void enter_impulse(const State& state, const std::function<void()>& change);
  /// Energies at the instant at which the scheme evaluates them.
  [[nodiscard]] Energies energies(const State& state);
  [[nodiscard]] const Works& works() const { return works_; }
  /// Energy that the time discretization has put into the body since the start, negative if it has removed energy:
  /// contact work, which is zero for exact motions, plus the integration error, less numerical dissipation and the
  /// change of the algorithmic energy. Valid for the state of the last step; the other works account for the remaining
  /// change of the total energy.
  [[nodiscard]] double method_energy(const State& state);
  /// total + algorithmic − initial values − Σ works + numerical and viscous dissipation − integration error: zero to
  /// rounding.
  [[nodiscard]] double residual(const Energies& now) const;
  /// Largest gap or overlap, between bodies with large sliding, of points that were pressed in the last step. Zero to
  /// rounding unless a step was frozen (ContactGeometry::freeze).
  [[nodiscard]] double unsettled_gap() const { return unsettled_gap_; }
  /// Velocity from which `energies` was last computed, for this state.
  [[nodiscard]] const Vector& velocity(const State& state) const {
    return scheme_.traits().energy_instant == 0.0 ? state.velocity : velocity_;
  }

 private:
  struct StepWorks {
    double load = 0.0, contact = 0.0, friction = 0.0, support = 0.0, obstacle = 0.0, damping = 0.0;
  };
  [[nodiscard]] double algorithmic(const State& state);
  [[nodiscard]] StepWorks works_of(const StepForces& forces, const Vector& increment, const ObstacleMotion& obstacle);
  void evaluate_gaps(const State& state);
  void enter_re_pairing(const StepForces& forces, double weight);
  void enter(const StepForces& forces, double weight, const Vector& increment, const ContactRows*& rows);
  /// Computes the motion of the contact points over the step along these rows, and that of the obstacles.
  void find_motion(const ContactRows& rows, const Vector& increment, ObstacleMotion& obstacle);

  const SemidiscreteProblem& problem_;
  const Scheme& scheme_;
  WorkRule rule_;
  Works works_;
  StepForces previous_;
  double initial_ = 0.0, initial_algorithmic_ = 0.0;
  std::optional<double> algorithmic_;  ///< of the last step; empty until it is requested
  Vector displacement_, velocity_;     ///< at the scheme's instant, if that differs from the state's
  Vector gap_increment_, slip_increment_;
  Vector gap_before_, gap_now_;  ///< with large sliding
  double unsettled_gap_ = 0.0;
  ObstacleMotion obstacle_;
};

}  // namespace ricochet
