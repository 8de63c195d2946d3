#include "ricochet/solver/delassus/contact_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace ricochet {

/// Factor by which a stage may move points farther than the last one did.
constexpr double reserve = 2.0;
/// Points within so many reaches are added together.
constexpr double ahead = 8.0;
/// Largest number of points that are added in advance, and as a multiple of those that carried a force in the last
/// stage. The others are added when they penetrate.
constexpr std::size_t max_ahead = 512;
constexpr std::size_t room_to_grow = 3;
/// Multiple of that number beyond which candidates are dropped at once.
constexpr std::size_t flood = 4;
/// Among the points that penetrate, those by more than this part of the deepest are added at once, but not more than
/// there are candidates: a body that nothing held has fallen through its obstacle with all points, and the deepest ones
/// may suffice to hold it.
constexpr double deep = 0.5;
/// Candidates are dropped if they are so many times those near the obstacle, and more than these, for so many stages.
constexpr std::size_t oversize = 3;
constexpr std::size_t few_points = 32;
constexpr int patience = 100;

void ContactCandidates::add_candidates(const std::vector<Index>& points) {
  for (const Index point : points) {
    number_[std::size_t(point)] = Index(points_.size());
    points_.push_back(point);
  }
}

void ContactCandidates::clear() {
  for (const Index point : points_) number_[std::size_t(point)] = -1;
  points_.clear();
  oversized_stages_ = 0;
}

void ContactCandidates::persist_history(const SnapshotVisitor& visit) {
  visit("largest_motion", largest_motion_);
  visit("oversized_stages", oversized_stages_);
  visit("closed", closed_, {0, Index(number_.size())});
}

/// Uses the motion of earlier stages, or that which this one requires if points are inside at δ = 0.
void ContactCandidates::estimate_reach(const ContactConditions& conditions) {
  double deepest = 0.0;
  for (Index i = 0; i < conditions.gap.offset.size(); ++i) {
    if (conditions.eligible[std::size_t(i)] != 0) deepest = std::max(deepest, -conditions.gap.offset[i]);
  }
  reach_ = reserve * std::max(ranks_->maximum(deepest), conditions.gap.factor * largest_motion_);
}

bool ContactCandidates::is_below(const ContactConditions& conditions, Index point, double limit,
                                 bool candidates) const {
  const auto at = std::size_t(point);
  return conditions.eligible[at] != 0 && (number_[at] >= 0) == candidates && conditions.gap.offset[point] <= limit;
}

std::size_t ContactCandidates::count_below(const ContactConditions& conditions, double limit, bool candidates) const {
  std::size_t count = 0;
  for (Index i = 0; i < conditions.gap.offset.size(); ++i) count += is_below(conditions, i, limit, candidates) ? 1 : 0;
  return count;
}

bool ContactCandidates::some_may_touch(const ContactConditions& conditions) const {
  for (Index i = 0; i < conditions.gap.offset.size(); ++i) {
    if (conditions.eligible[std::size_t(i)] != 0 && conditions.gap.offset[i] <= reach_) return true;
  }
  return false;
}

std::size_t ContactCandidates::max_count() const { return std::max(max_ahead, room_to_grow * closed_); }

bool ContactCandidates::are_too_many() const { return points_.size() > flood * max_count(); }

std::vector<Index> ContactCandidates::nearest(const ContactConditions& conditions) const {
  const double limit = ahead * reach_;
  std::vector<Index> result;
  for (Index i = 0; i < conditions.gap.offset.size(); ++i) {
    if (conditions.eligible[std::size_t(i)] != 0 && conditions.gap.offset[i] <= limit) result.push_back(i);
  }
  if (result.size() <= max_count()) return result;
  const auto last = result.begin() + std::ptrdiff_t(max_count());
  std::nth_element(result.begin(), last, result.end(), [&](Index a, Index b) {
    return std::pair(conditions.gap.offset[a], a) < std::pair(conditions.gap.offset[b], b);
  });
  result.erase(last, result.end());
  std::ranges::sort(result);
  return result;
}

std::vector<Index> ContactCandidates::approaching(const ContactConditions& conditions) const {
  if (count_below(conditions, reach_, false) == 0) return {};
  std::vector<Index> result = nearest(conditions);
  std::erase_if(result, [&](Index point) { return number(point) >= 0; });
  return result;
}

std::vector<Index> ContactCandidates::penetrating(const ContactConditions& conditions, const Vector& motion,
                                                  bool left_out) const {
  std::vector<Index> result;
  double deepest = 0.0;
  const auto gap = [&](Index point) { return conditions.gap.offset[point] + conditions.gap.factor * motion[point]; };
  for (Index i = 0; i < motion.size(); ++i) {
    const auto at = std::size_t(i);
    const bool was_included = number_[at] >= 0 && !left_out;
    if (conditions.eligible[at] == 0 || was_included || !(gap(i) < -conditions.gap.rounding[i])) continue;
    result.push_back(i);
    deepest = std::max(deepest, -gap(i));
  }
  std::erase_if(result, [&](Index point) { return -gap(point) < deep * deepest; });
  std::ranges::stable_sort(result, [&](Index a, Index b) { return gap(a) < gap(b); });
  result.resize(std::min(result.size(), std::max(few_points, points_.size())));
  return result;
}

void ContactCandidates::update_history(const ContactConditions& conditions, const Vector& motion, std::size_t closed) {
  closed_ = closed;
  largest_motion_ = 0.0;
  for (Index i = 0; i < motion.size(); ++i) {
    if (conditions.eligible[std::size_t(i)] != 0) largest_motion_ = std::max(largest_motion_, std::abs(motion[i]));
  }
  largest_motion_ = ranks_->maximum(largest_motion_);
}

std::vector<Index> ContactCandidates::worth_keeping(const ContactConditions& conditions) {
  if (points_.size() <= few_points) return {};
  const std::size_t near = std::min(count_below(conditions, ahead * reach_, true), max_count());
  const bool oversized = points_.size() > oversize * std::max(near, few_points);
  oversized_stages_ = oversized ? oversized_stages_ + 1 : 0;
  if (oversized_stages_ < patience && !are_too_many()) return {};
  std::vector<Index> result = nearest(conditions);
  std::erase_if(result, [&](Index point) { return number(point) < 0; });
  return result;
}

}  // namespace ricochet
