#pragma once

#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/monitor/sliding_report.hpp"

/// @file Slip between bodies beyond the limit of their pairing: facets that face each other at the start are assumed to
/// do so for the whole run. For pairs with large sliding, the doubtful force of frozen steps.
namespace ricochet {

class SlidingWatch {
 public:
  /// Keeps references to problem and pairs.
  SlidingWatch(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs);
  void persist(const SnapshotVisitor& visit);

  /// Checks the pressed points between bodies in the starting state and after every step. Warns, once, of each contact
  /// whose slip exceeds its limit. Allocates nothing if there is nothing to report.
  void check(const State& state);
  /// Report on each contact between bodies.
  [[nodiscard]] std::vector<PairSliding> report() const;
  /// Report on each contact with large sliding that had such points.
  [[nodiscard]] std::vector<UnsettledContact> unsettled() const;

 private:
  /// Record of a contact with large sliding.
  struct LargeSlidingContact {
    int contact = 0;
    bool is_self = false;
    std::vector<Index> points;
    std::vector<double> stiffness;  ///< per point: upper bound of the force for a unit displacement along the normal
    double largest_force = 0.0;     ///< normal, of all points
    double force = 0.0;             ///< largest doubtful force
    double missing = 0.0;           ///< part of it that is missing in the contact force
    long steps = 0;
    double first_time = 0.0, time = 0.0, gap = 0.0;
    Index point = -1;
    bool is_warned = false;
    [[nodiscard]] auto members() {
      return std::tie(largest_force, force, steps, first_time, time, gap, point, is_warned, missing);
    }
    [[nodiscard]] double share() const { return force > 0.0 ? force / (largest_force + missing) : 0.0; }
  };
  /// Record of a contact between bodies.
  struct Largest {
    int contact = 0;
    double ratio = 0.0, slip = 0.0, limit = 0.0, time = 0.0, time_beyond = 0.0;
    Index point = -1;
    bool is_beyond = false;
    [[nodiscard]] auto members() { return std::tie(ratio, slip, limit, time, time_beyond, point, is_beyond); }
  };
  void add_large_sliding_contact(int contact);
  [[nodiscard]] double slip_of(Index point, const State& state) const;
  [[nodiscard]] std::vector<double> reference_position(Index point) const;
  void warn(const Largest& largest) const;
  void check_large_sliding(const State& state);
  void enter(LargeSlidingContact& contact, const State& state) const;
  void warn(const LargeSlidingContact& contact) const;
  void warn_of_frozen_step(const State& state);
  [[nodiscard]] bool is_point(Index point) const { return point >= -1 && point < problem_.contact.size(); }

  const SemidiscreteProblem& problem_;
  const std::vector<ContactPair>& pairs_;
  Vector limit_;                 ///< per point
  std::vector<Index> points_;    ///< between bodies
  std::vector<std::size_t> at_;  ///< per entry of points_: index into largest_
  std::vector<Largest> largest_;
  std::vector<LargeSlidingContact> large_sliding_;
  double size_ = 0.0;  ///< of the model
  bool frozen_step_warned_ = false;
  Vector gap_;
};

}  // namespace ricochet
