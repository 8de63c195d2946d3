#pragma once

#include <array>
#include <string>
#include <vector>

#include "ricochet/scheme/scheme.hpp"
#include "ricochet/simulation/impact/impact.hpp"
#include "ricochet/simulation/impact/rigid_bodies.hpp"

/// @file Impacts: what the collisions of a body with an obstacle, or of two bodies, come to, told from the forces of
/// every step.
///
/// A body is in contact with an obstacle or a body at an instant of the scheme's forces when one of its contact points
/// there carries a force, and in a step when a force with a weight in it (WorkRule) does. An impact is a maximal run of
/// such steps. Contact that is lost for less than wave_crossing_times (or two steps) and comes back is still the same
/// impact: its far side has not heard yet that it left. Of two bodies the longer one's time counts.
///
/// Of a point between bodies the part Σ t_ij over the nodes j of a body acts on that body, so that impulses balance
/// momenta to rounding where a multiplier faces two bodies, too. The first of two bodies is that of the `group` of
/// their first contact, as the case names it.
///
/// A rigid body that moves freely is the other of two bodies, after those of the mesh.
///
/// Over the ring of an axisymmetric body what acts across its axis cancels: forces and impulses are those along it.
///
/// It begins half a step before the first instant with a force and ends half a step after the last one. `before` and
/// `after` are the states (at the scheme's instant of energies) at the ends of its steps, so that
/// m (v_after − v_before) = impulse + that of loads, supports and damping in the same steps, to rounding; the impulse
/// on the other body is the opposite.
namespace ricochet {

class ImpactRecorder {
 public:
  /// Impacts that are kept; later ones are counted.
  static constexpr std::size_t most_impacts = 1000;

  /// Opens on a starting state. `pairs`: those of the problem's contact boundary; `separation`: per body of the mesh,
  /// how long contact must be lost for an impact to have ended.
  ImpactRecorder(const SemidiscreteProblem& problem, const Scheme& scheme, const State& state,
                 const std::vector<ContactPair>& pairs, std::vector<int> body_of_node, std::vector<double> separation);
  void save(Snapshot& snapshot, const std::string& name) const;
  /// Of a recorder that was saved at the state this one was opened on.
  void load(const Snapshot& snapshot, const std::string& name);

  /// These contact points are inside their obstacle, or the opposite body, when the run begins.
  void begin_inside(const std::vector<Index>& points);
  /// Enters a step with the forces at its end (in the state), and what the discretization of time has put into the
  /// bodies since the start (EnergyAccount::of_method). Allocates nothing.
  void enter_step(const State& state, double method_energy);
  /// The body has another velocity from here on. Of an impact that goes on the restitution then counts that, too.
  void enter_impulse(const State& state);
  /// By their begin.
  [[nodiscard]] std::vector<Impact> impacts() const;
  /// Those beyond most_impacts, which only have been counted.
  [[nodiscard]] long left_out() const { return left_out_; }
  [[nodiscard]] const std::vector<RigidBody>& bodies() const { return rigid_.bodies(); }
  [[nodiscard]] double separation(int body) const { return separation_[static_cast<std::size_t>(body)]; }

 private:
  using Three = std::array<double, 3>;
  struct Motion {
    Three velocity, spin;
    double kinetic, rigid_kinetic;
  };
  /// Numbers only, so that a snapshot can take it as it is.
  struct Interval {
    double place;  ///< index in places_
    double phase;  ///< no_contact, touching or apart: lost, but it may come back
    double begin, end, from_start, from_inside, intervals, contact_time;
    Three impulse, normal_impulse;
    /// Σ h r_N over instants, and Σ r_N times the obstacle's motion, along the normal and across it.
    double pressing, travel;
    Three sliding;
    double largest, largest_time;
    double most_points;
    Three first_place;
    Motion before, after;
    Motion other_before, other_after;  ///< of the other body
    double method_before, method_after;
    Three turn, other_turn;  ///< TurningBody::turn
    Three other_arm;         ///< likewise, from the other body's centre of mass
  };
  /// Of an interval: numbers, too.
  static constexpr double no_contact = 0.0, touching = 1.0, apart = 2.0;
  /// A body, and an obstacle or another body, that can touch.
  struct Place {
    int body;
    int other;  ///< another body; −1: an obstacle
    std::string obstacle;
    long points;
    bool begins_inside = false;
  };
  /// Resultants of the points of a place at an instant, of those on all ranks.
  struct Force {
    Eigen::Vector3d all = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    double pressing = 0.0, travel = 0.0;
    Eigen::Vector3d sliding = Eigen::Vector3d::Zero();
    long points = 0;            ///< that carry a force
    Index leading = -1;         ///< the point of the largest force, the first of equals
    double leading_size = 0.0;  ///< of that force, of one point
    Three leading_place{};      ///< of the point, in the reference configuration
    [[nodiscard]] bool any() const { return points > 0; }
    /// What the largest force of an impact, and the largest of several forces in a step, are told by.
    [[nodiscard]] double size() const { return all.norm(); }
  };
  /// The forces with a weight in a step, each null where it does not act: at its beginning, at its end, and the largest
  /// of those that are not in the state.
  struct Acting {
    const Force *previous = nullptr, *current = nullptr, *other = nullptr;
    [[nodiscard]] bool any() const { return previous != nullptr || current != nullptr || other != nullptr; }
    [[nodiscard]] const Force& first() const {
      return previous != nullptr ? *previous : current != nullptr ? *current : *other;
    }
  };
  /// What of a point's force acts at a place: on its body.
  struct PointPart {
    Index point;
    std::size_t place;
    double part;
  };
  class BodyOrder;
  void find_places(const std::vector<ContactPair>& pairs);
  void add_places_of_ranks(const std::vector<ContactPair>& pairs);
  [[nodiscard]] int free_body_of(Index point) const;
  void add_part(Index point, int body, int other, const std::string& obstacle, double part);
  void find_forces(const StepForces& acting, const ObstacleMotion& travel, std::vector<Force>& forces) const;
  void add_up_ranks(std::vector<Force>& forces) const;
  void find_other_forces();
  void add_along_axis(Index point, double part, const SpaceVector& own, const StepForces& acting,
                      const ObstacleMotion& travel, Force& force) const;
  [[nodiscard]] Acting acting_in(std::size_t place) const;
  void take_velocity(const State& state, Vector& velocity);
  void enter_place(std::size_t place, double instant);
  [[nodiscard]] Motion motion_of(int body) const;
  [[nodiscard]] double separation_at(const Interval& interval) const;
  void let_go(Interval& interval) const;
  void touch(Interval& interval, const Acting& acting, double instant);
  void add_impulses(Interval& interval, std::size_t place) const;
  void begin(Interval& interval, double time, const Force& first);
  void take_turns(Interval& interval);
  [[nodiscard]] bool grows_as_it_turns(int body) const;
  [[nodiscard]] double growth_in(const Interval& interval, const Impact& impact) const;
  [[nodiscard]] Three place_of(Index point) const;
  static void take_largest(Interval& interval, const Force& force, double instant);
  void file(const Interval& interval);
  [[nodiscard]] Impact describe(const Interval& interval) const;

  const SemidiscreteProblem& problem_;
  const Scheme& scheme_;
  RigidBodies rigid_;
  std::vector<double> separation_;
  std::vector<Place> places_;
  std::vector<PointPart> parts_;  ///< by points
  std::vector<Force> previous_, current_;
  /// Of Scheme::other_parts.
  struct OtherForces {
    double weight = 0.0;
    std::vector<Force> forces;
  };
  std::vector<OtherForces> others_;
  std::vector<Interval> open_;   ///< per place
  std::vector<Interval> filed_;  ///< that are over
  long left_out_ = 0;
  double first_step_ = 0.0;                           ///< length, or that of its first part
  double method_before_ = 0.0, method_energy_ = 0.0;  ///< at the beginning and the end of a step
  Vector velocity_before_;                            ///< at the beginning of a step
  Vector displacement_before_;                        ///< likewise
  Vector scratch_;
  const std::vector<RigidMotionState>* motion_ = nullptr;  ///< of velocity_before_, once it was asked for
};

}  // namespace ricochet
