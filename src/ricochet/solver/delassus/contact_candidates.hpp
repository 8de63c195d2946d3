#pragma once

#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/base/snapshot.hpp"
#include "ricochet/problem/stage.hpp"

/// @file Which contact points take part in the contact problem of a stage. Nothing is left out for good: after every
/// stage the points that were not asked are looked at, and where one of them would penetrate it is taken up and the
/// stage is solved again.
namespace ricochet {

class ContactCandidates {
 public:
  explicit ContactCandidates(Index points, const Ranks& ranks = one_rank())
      : ranks_(&ranks), number_(static_cast<std::size_t>(points), -1) {}

  /// In the order in which they were taken up.
  [[nodiscard]] const std::vector<Index>& points() const { return points_; }
  /// Place of a point among them, or −1.
  [[nodiscard]] Index number(Index point) const { return number_[static_cast<std::size_t>(point)]; }
  void take_up(const std::vector<Index>& points);
  void clear();

  /// All but the points themselves, which are taken up in another way.
  void save_history(Snapshot& snapshot, const std::string& name) const;
  void load_history(const Snapshot& snapshot, const std::string& name);

  /// Before a stage is asked about: how far it may move points. All ranks come here together.
  void look_at(const Stage& stage);
  /// Some eligible point may touch in this stage: its y at δ = 0 is within reach of what stages have moved points by.
  [[nodiscard]] bool some_may_touch(const Stage& stage) const;
  /// Points that may touch and are no candidates, with those near them in time, so that the set does not grow in every
  /// step. Of many the nearest: a body that moves far in a step may touch with all of its skin, and does with little.
  /// Empty: there are none that may touch.
  [[nodiscard]] std::vector<Index> approaching(const Stage& stage) const;
  /// After a stage with these G δ (per point): eligible points that penetrate by more than rounding, of many the
  /// deepest. Candidates are looked at only where they were `left_out` of the stage. Empty: the stage is solved.
  [[nodiscard]] std::vector<Index> penetrating(const Stage& stage, const Vector& motion, bool left_out) const;
  /// Remembers how far a solved stage has moved points, and that so many carry a force. All ranks together.
  void learn(const Stage& stage, const Vector& motion, std::size_t closed);
  /// Many more candidates than points near the obstacle, for long, or very many: those that are worth keeping. Empty:
  /// nothing to do.
  [[nodiscard]] std::vector<Index> worth_keeping(const Stage& stage);
  /// There are so many candidates that those far from the obstacle should go at once.
  [[nodiscard]] bool are_too_many() const;
  /// Eligible points near the obstacle, candidates or not; of many the nearest. Ascending.
  [[nodiscard]] std::vector<Index> nearest(const Stage& stage) const;

 private:
  /// The point is eligible, a candidate or not, and its gap at δ = 0 is at most `limit`.
  [[nodiscard]] bool is_below(const Stage& stage, Index point, double limit, bool candidates) const;
  [[nodiscard]] std::size_t count_below(const Stage& stage, double limit, bool candidates) const;
  [[nodiscard]] std::size_t most() const;

  const Ranks* ranks_;
  std::vector<Index> points_;
  std::vector<Index> number_;  ///< per point
  double largest_motion_ = 0.0;
  double reach_ = 0.0;  ///< in the units of y
  std::size_t closed_ = 0;
  int oversized_stages_ = 0;
};

}  // namespace ricochet
