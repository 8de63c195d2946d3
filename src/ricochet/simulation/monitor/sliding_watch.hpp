#pragma once

#include <string>
#include <vector>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/scheme/state.hpp"
#include "ricochet/simulation/monitor/sliding_report.hpp"

/// @file Slip between bodies beyond what their pairing allows: facets that faced each other at the start are taken to
/// face each other for the whole run. Of pairs that slide far, the force that held steps put at stake.
namespace ricochet {

class SlidingWatch {
 public:
  /// Keeps references to problem and pairs.
  SlidingWatch(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs);
  void save(Snapshot& snapshot, const std::string& name) const;
  void load(const Snapshot& snapshot, const std::string& name);

  /// After every step, and of the starting state: looks at the points between bodies that are pressed. Warns, once, of
  /// each contact whose slip exceeds its limit. Allocates nothing where there is nothing to tell.
  void look(const State& state);
  /// Of each contact between bodies.
  [[nodiscard]] std::vector<PairSliding> report() const;
  /// Report on each contact that slides far and had such points.
  [[nodiscard]] std::vector<UnsettledContact> unsettled() const;

 private:
  /// Record of a contact that slides far.
  struct FarContact {
    int contact = 0;
    bool is_self = false;
    std::vector<Index> points;
    std::vector<double> stiffness;  ///< of each: no less than the force that moves it along a normal by one
    double largest_force = 0.0;     ///< normal, of all points
    double force = 0.0;             ///< the largest at stake
    double missing = 0.0;           ///< part of it that should be there besides
    long steps = 0;
    double first_time = 0.0, time = 0.0, gap = 0.0;
    Index point = -1;
    bool is_told = false;
    [[nodiscard]] double share() const { return force > 0.0 ? force / (largest_force + missing) : 0.0; }
  };
  /// Of a contact between bodies.
  struct Largest {
    int contact = 0;
    double ratio = 0.0, slip = 0.0, limit = 0.0, time = 0.0, time_beyond = 0.0;
    Index point = -1;
    bool is_beyond = false;
  };
  void add_far_contact(int contact);
  [[nodiscard]] double slip_of(Index point, const State& state) const;
  [[nodiscard]] std::vector<double> place_of(Index point) const;
  void tell(const Largest& largest) const;
  void look_at_far_contacts(const State& state);
  void enter(FarContact& contact, const State& state) const;
  void tell(const FarContact& contact) const;
  void tell_of_held(const State& state);
  void load_far(const Snapshot& snapshot, const std::string& name);

  const SemidiscreteProblem& problem_;
  const std::vector<ContactPair>& pairs_;
  Vector limit_;                 ///< per point
  std::vector<Index> points_;    ///< between bodies
  std::vector<std::size_t> at_;  ///< of these: in largest_
  std::vector<Largest> largest_;
  std::vector<FarContact> far_;
  double size_ = 0.0;  ///< of the model
  bool has_told_held_ = false;
  Vector gap_;
};

}  // namespace ricochet
