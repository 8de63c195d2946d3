#pragma once

#include <vector>

#include "ricochet/base/ranks.hpp"
#include "ricochet/base/snapshot.hpp"
#include "ricochet/step/stage.hpp"

/// @file Contact points that take part in the contact problem of a stage. None is left out for good: after every stage
/// the points outside of the problem are checked, and if one of them would penetrate it is added and the stage is
/// solved again.
namespace ricochet {

class ContactCandidates {
 public:
  explicit ContactCandidates(Index points, const Ranks& ranks = one_rank())
      : ranks_(&ranks), number_(std::size_t(points), -1) {}

  /// Candidates in the order in which they were added.
  [[nodiscard]] const std::vector<Index>& points() const { return points_; }
  /// Index of a point among them, or −1.
  [[nodiscard]] Index number(Index point) const { return number_[std::size_t(point)]; }
  void add_candidates(const std::vector<Index>& points);
  void clear();

  /// Saves and loads everything except the points themselves, which are added separately.
  void persist_history(const SnapshotVisitor& visit);

  /// Estimates, before a stage, how far it may move points. Collective over the ranks.
  void estimate_reach(const ContactConditions& conditions);
  /// True if some eligible point may touch in this stage: its y at δ = 0 is within reach of the motion of earlier
  /// stages.
  [[nodiscard]] bool some_may_touch(const ContactConditions& conditions) const;
  /// Points that may touch and are no candidates, with those that will be near soon, so that the set does not grow in
  /// every step. Of many, the nearest: a body that moves far in a step may touch with its whole surface, and does with
  /// a small part. Empty if none may touch.
  [[nodiscard]] std::vector<Index> approaching(const ContactConditions& conditions) const;
  /// After a stage with this G δ (per point): eligible points that penetrate by more than rounding; of many, the
  /// deepest. Candidates are checked only if they were `left_out` of the stage. Empty: the stage is solved.
  [[nodiscard]] std::vector<Index> penetrating(const ContactConditions& conditions, const Vector& motion,
                                               bool left_out) const;
  /// Remembers how far a solved stage has moved points, and how many carry a force. Collective over the ranks.
  void update_history(const ContactConditions& conditions, const Vector& motion, std::size_t closed);
  /// Candidates to be kept, if they have long been many more than the points near the obstacle, or are very many;
  /// empty: no change.
  [[nodiscard]] std::vector<Index> worth_keeping(const ContactConditions& conditions);
  /// True if there are so many candidates that those far from the obstacle should be dropped at once.
  [[nodiscard]] bool are_too_many() const;
  /// Eligible points near the obstacle, candidates or not; of many, the nearest. Ascending.
  [[nodiscard]] std::vector<Index> nearest(const ContactConditions& conditions) const;

 private:
  /// True if the point is eligible, among the `candidates` or not, and its gap at δ = 0 is at most `limit`.
  [[nodiscard]] bool is_below(const ContactConditions& conditions, Index point, double limit, bool candidates) const;
  [[nodiscard]] std::size_t count_below(const ContactConditions& conditions, double limit, bool candidates) const;
  [[nodiscard]] std::size_t max_count() const;

  const Ranks* ranks_;
  std::vector<Index> points_;
  std::vector<Index> number_;  ///< per point
  double largest_motion_ = 0.0;
  double reach_ = 0.0;  ///< in the units of y
  std::size_t closed_ = 0;
  int oversized_stages_ = 0;
};

}  // namespace ricochet
