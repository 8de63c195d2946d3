#pragma once

#include <string>
#include <tuple>
#include <vector>

#include "ricochet/scheme/scheme.hpp"
#include "ricochet/simulation/impact/impact.hpp"
#include "ricochet/simulation/impact/rigid_bodies.hpp"

/// @file Impacts: results of the collisions of a body with an obstacle, or of two bodies, derived from the forces of
/// every step.
///
/// A body is in contact with an obstacle or a body at an instant of the scheme's forces if one of its contact points
/// there carries a force, and in a step if a force with a weight in it (WorkRule) does. An impact is a maximal run of
/// such steps. Contact that is lost for less than wave_crossing_times (or two steps) and regained belongs to the same
/// impact: no wave has yet carried the loss to the far side of the body. For two bodies the longer time counts.
///
/// The part Σ t_ij, over the nodes j of a body, of the force at a point between bodies acts on that body, so that
/// impulses balance momenta to rounding even if a multiplier faces two bodies. The first of two bodies is that of the
/// `group` of their first contact, as the case names it.
///
/// A free rigid body is the other of two bodies; free rigid bodies are numbered after those of the mesh.
///
/// In an axisymmetric body forces across the axis cancel over the ring: forces and impulses are those along it.
///
/// An impact begins half a step before the first instant with a force and ends half a step after the last one. `before`
/// and `after` are the states (at the scheme's instant of energies) at the ends of its steps, so that
/// m (v_after − v_before) = impulse + that of loads, supports and damping in the same steps, to rounding; the impulse
/// on the other body is the opposite.
namespace ricochet {

class ImpactRecorder {
 public:
  /// Largest number of recorded impacts; later ones are only counted.
  static constexpr std::size_t most_impacts = 1000;

  /// Opens on a starting state. `pairs`: those of the problem's contact boundary; `separation`: per body of the mesh,
  /// the time for which contact must be lost for an impact to end.
  ImpactRecorder(const SemidiscreteProblem& problem, const Scheme& scheme, const State& state,
                 const std::vector<ContactPair>& pairs, std::vector<int> body_of_node, std::vector<double> separation);
  /// Saves the recorder, or loads one that was saved at the state on which this one was opened.
  void persist(const SnapshotVisitor& visit);

  /// Marks contact points that are inside their obstacle, or the opposite body, when the run begins.
  void begin_inside(const std::vector<Index>& points);
  /// Enters a step with the forces at its end (in the state) and the energy that the time discretization has put into
  /// the bodies since the start (EnergyAccount::method_energy). Allocates nothing.
  void enter_step(const State& state, double method_energy);
  /// Accounts for an instantaneous change of the bodies' velocities. The restitution of an ongoing impact then includes
  /// it.
  void enter_impulse(const State& state);
  /// Impacts, ordered by their begin.
  [[nodiscard]] std::vector<Impact> impacts() const;
  /// Number of impacts beyond most_impacts, which are not recorded.
  [[nodiscard]] long left_out() const { return left_out_; }
  [[nodiscard]] const std::vector<RigidBody>& bodies() const { return rigid_.bodies(); }
  [[nodiscard]] double separation(int body) const { return separation_[std::size_t(body)]; }

 private:
  struct Interval {
    std::size_t collision = 0;  ///< index in collision_pairs_
    int phase = 0;              ///< no_contact, touching or apart: lost, but it may be regained
    double begin = 0.0, end = 0.0;
    bool from_start = false, from_inside = false;
    long intervals = 0;
    double contact_time = 0.0;
    Eigen::Vector3d impulse = Eigen::Vector3d::Zero(), normal_impulse = Eigen::Vector3d::Zero();
    /// Σ h r_N over instants, and Σ r_N times the obstacle's motion along the normal and across it.
    double pressing = 0.0, travel = 0.0;
    Eigen::Vector3d sliding = Eigen::Vector3d::Zero();
    double largest = 0.0, largest_time = 0.0;
    long most_points = 0;
    Eigen::Vector3d first_position = Eigen::Vector3d::Zero();
    RigidMotionState before, after;
    RigidMotionState other_before, other_after;  ///< of the other body
    double method_before = 0.0, method_after = 0.0;
    /// RotatingBody::rotation of the body and of the other one, RotatingBody::arm of the other body.
    Eigen::Vector3d rotation = Eigen::Vector3d::Zero(), other_rotation = Eigen::Vector3d::Zero(),
                    other_arm = Eigen::Vector3d::Zero();

    [[nodiscard]] auto members() {
      return std::tie(collision, phase, begin, end, from_start, from_inside, intervals, contact_time, impulse,
                      normal_impulse, pressing, travel, sliding, largest, largest_time, most_points, first_position,
                      before, after, other_before, other_after, method_before, method_after, rotation, other_rotation,
                      other_arm);
    }
  };
  /// Phases of an interval.
  static constexpr int no_contact = 0, touching = 1, apart = 2;
  /// Collision pair: a body and an obstacle, or another body, that can touch.
  struct CollisionPair {
    int body;
    int other;  ///< the other body; −1: an obstacle
    std::string obstacle;
    long points;
    bool begins_inside = false;
  };
  /// Resultant of the points of a collision pair at an instant, on all ranks.
  struct Force {
    Eigen::Vector3d all = Eigen::Vector3d::Zero(), normal = Eigen::Vector3d::Zero();
    double pressing = 0.0, travel = 0.0;
    Eigen::Vector3d sliding = Eigen::Vector3d::Zero();
    long points = 0;                                             ///< number of those that carry a force
    Index leading = -1;                                          ///< point of the largest force, the first of equals
    double leading_size = 0.0;                                   ///< magnitude of that force
    Eigen::Vector3d leading_position = Eigen::Vector3d::Zero();  ///< reference position of that point
    /// Returns what ranks exchange.
    [[nodiscard]] auto members() {
      return std::tie(all, normal, sliding, pressing, travel, points, leading_size, leading_position);
    }
    [[nodiscard]] bool any() const { return points > 0; }
    /// Magnitude by which the largest force of an impact, and the largest of several in a step, is selected.
    [[nodiscard]] double size() const { return all.norm(); }
  };
  /// Forces with a weight in a step, each null if it does not act: at its start, at its end, and the largest of those
  /// that are not in the state.
  struct Acting {
    const Force *previous = nullptr, *current = nullptr, *other = nullptr;
    [[nodiscard]] bool any() const { return previous != nullptr || current != nullptr || other != nullptr; }
    [[nodiscard]] const Force& first() const {
      return previous != nullptr ? *previous : current != nullptr ? *current : *other;
    }
  };
  /// Fraction of a point's force that acts on the body of a collision pair.
  struct PointPart {
    Index point;
    std::size_t collision;
    double part;
  };
  class BodyOrder;
  [[nodiscard]] bool fits(const Interval& interval) const;
  void find_collision_pairs(const std::vector<ContactPair>& pairs);
  void add_collision_pairs_of_ranks(const std::vector<ContactPair>& pairs);
  [[nodiscard]] int free_body_of(Index point) const;
  void add_part(Index point, int body, int other, const std::string& obstacle, double part);
  void find_forces(const StepForces& acting, const ObstacleMotion& travel, std::vector<Force>& forces) const;
  void add_up_ranks(std::vector<Force>& forces) const;
  void find_other_forces();
  void add_along_axis(Index point, double part, const SpaceVector& own, const StepForces& acting,
                      const ObstacleMotion& travel, Force& force) const;
  [[nodiscard]] Acting acting_in(std::size_t collision) const;
  void store_velocity(const State& state, Vector& velocity);
  void enter_collision_pair(std::size_t collision, double instant);
  [[nodiscard]] const RigidMotionState& motion_of(int body) const { return (*motion_)[std::size_t(body)]; }
  [[nodiscard]] double separation_at(const Interval& interval) const;
  void release(Interval& interval) const;
  void touch(Interval& interval, const Acting& acting, double instant);
  void add_impulses(Interval& interval, std::size_t collision) const;
  void begin(Interval& interval, double time, const Force& first);
  void compute_rotations(Interval& interval);
  [[nodiscard]] bool inflates_with_rotation(int body) const;
  [[nodiscard]] double growth_in(const Interval& interval, const Impact& impact) const;
  [[nodiscard]] Eigen::Vector3d reference_position(Index point) const;
  static void update_largest(Interval& interval, const Force& force, double instant);
  void file(const Interval& interval);
  [[nodiscard]] Impact describe(const Interval& interval) const;

  const SemidiscreteProblem& problem_;
  const Scheme& scheme_;
  RigidBodies rigid_;
  std::vector<double> separation_;
  std::vector<CollisionPair> collision_pairs_;
  std::vector<PointPart> parts_;  ///< ordered by points
  std::vector<Force> previous_, current_;
  /// Forces of Scheme::other_stages.
  struct OtherForces {
    double weight = 0.0;
    std::vector<Force> forces;
  };
  std::vector<OtherForces> others_;
  std::vector<Interval> open_;       ///< per collision pair
  std::vector<Interval> completed_;  ///< completed
  long left_out_ = 0;
  double first_step_ = 0.0;                           ///< length of the first step, or of its first part
  double method_before_ = 0.0, method_energy_ = 0.0;  ///< at the start and the end of a step
  Vector velocity_before_;                            ///< at the start of a step
  Vector displacement_before_;                        ///< likewise
  Vector scratch_;
  const std::vector<RigidMotionState>* motion_ = nullptr;  ///< at the start of the step; null until requested
};

}  // namespace ricochet
