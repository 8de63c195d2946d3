#pragma once

#include <functional>
#include <optional>

#include "ricochet/scheme/scheme.hpp"

/// @file The account of energy: each part computed from forces and increments, never as a remainder.
namespace ricochet {

/// Cumulative works since the start.
struct Works {
  double load = 0.0;      ///< of the time-dependent loads
  double contact = 0.0;   ///< of normal reactions on the change of the gaps
  double friction = 0.0;  ///< of tangential reactions on the slip relative to the obstacle
  double support = 0.0;
  double obstacle = 0.0;  ///< of all reactions on the motion of the obstacles: what these put into the body
  double damping = 0.0;
  double numerical_dissipation = 0.0;  ///< taken away by the scheme, positive when energy is lost
  double integration_error = 0.0;      ///< what the scheme's internal forces miss of the change of the elastic energy
  double viscous_dissipation = 0.0;    ///< of stress that relaxes, which turns into heat; never falls
  /// Part of `contact`: of normal reactions between bodies that slide far, on what their rows miss of the change of the
  /// gaps. Zero to rounding for rows of steps (sliding_contact.hpp), but where facets come and go at once.
  double re_pairing = 0.0;

  [[nodiscard]] double sum() const { return load + contact + friction + support + obstacle + damping; }
};

struct Energies {
  double kinetic = 0.0;
  double elastic = 0.0;         ///< with what branches that relax have stored
  double load_potential = 0.0;  ///< −LᵀU of the constant loads
  double algorithmic = 0.0;

  [[nodiscard]] double total() const { return kinetic + elastic + load_potential; }
};

class EnergyAccount {
 public:
  /// Opens the account on a starting state.
  EnergyAccount(const SemidiscreteProblem& problem, const Scheme& scheme, const State& state);
  /// Goes on with an account that was saved at this state.
  EnergyAccount(const SemidiscreteProblem& problem, const Scheme& scheme, const State& state, const Snapshot& snapshot,
                const std::string& name);
  void save(Snapshot& snapshot, const std::string& name) const;

  /// Enters a step: its displacement increment and the forces at its end (in the state).
  void enter_step(const Vector& increment, const State& state);
  /// Calls `change`, which gives the scheme's next step another length and with it the state another algorithmic
  /// energy: the difference is numerical dissipation.
  void change_step(const State& state, const std::function<void()>& change);
  /// Calls `change`, which gives the body another velocity between two steps: the difference of energy is work of
  /// loads.
  void enter_impulse(const State& state, const std::function<void()>& change);
  /// Energies at the scheme's own instant.
  [[nodiscard]] Energies energies(const State& state);
  [[nodiscard]] const Works& works() const { return works_; }
  /// What the discretization of time has put into the body since the start; negative where it has taken energy away:
  /// contact work, which exact motions have none of, less numerical dissipation, the error of integration and the
  /// change of the algorithmic energy. Of the state of the last step; what total energy then changes besides is the
  /// other works.
  [[nodiscard]] double of_method(const State& state);
  /// total + algorithmic − initial values − Σ works + numerical and viscous dissipation − integration error: zero to
  /// rounding.
  [[nodiscard]] double residual(const Energies& now) const;
  /// Between bodies that slide far: the largest gap, or overlap, of points that were pressed in the last step. Zero to
  /// rounding but where a step has been held (ContactGeometry::hold).
  [[nodiscard]] double unsettled_gap() const { return unsettled_gap_; }
  /// The velocity that `energies` was last computed from, for this state.
  [[nodiscard]] const Vector& velocity(const State& state) const {
    return scheme_.energy_instant() == 0.0 ? state.velocity : velocity_;
  }

 private:
  struct StepWorks {
    double load = 0.0, contact = 0.0, friction = 0.0, support = 0.0, obstacle = 0.0, damping = 0.0;
  };
  [[nodiscard]] double algorithmic(const State& state);
  [[nodiscard]] StepWorks works_of(const StepForces& forces, const Vector& increment, const ObstacleMotion& obstacle);
  void look_at_gaps(const State& state);
  void enter_re_pairing(const StepForces& forces, double weight);
  void enter(const StepForces& forces, double weight, const Vector& increment, const ContactRows*& rows);
  /// Motion of the contact points over the step along these rows, and that of the obstacles.
  void find_motion(const ContactRows& rows, const Vector& increment, ObstacleMotion& obstacle);

  const SemidiscreteProblem& problem_;
  const Scheme& scheme_;
  WorkRule rule_;
  Works works_;
  StepForces previous_;
  double initial_ = 0.0, initial_algorithmic_ = 0.0;
  std::optional<double> algorithmic_;  ///< of the last step, once it was asked for
  Vector displacement_, velocity_;     ///< of the scheme's instant, where that is not the state's
  Vector gap_increment_, slip_increment_;
  Vector gap_before_, gap_now_;  ///< where bodies slide far
  double unsettled_gap_ = 0.0;
  ObstacleMotion obstacle_;
};

}  // namespace ricochet
