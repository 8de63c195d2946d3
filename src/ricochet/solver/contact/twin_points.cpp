#include "ricochet/solver/contact/twin_points.hpp"

#include <algorithm>
#include <cmath>

#include "ricochet/solver/contact/contact_system.hpp"

namespace ricochet {

namespace {

/// Two points are twins if equal and opposite reactions on them cause less than this part of the energy that either
/// causes alone. Planes at an angle below the root of this are nearly parallel.
constexpr double alike = 1e-12;
constexpr int exchange_limit = 20;

/// Returns whether the points have the same law: only then any of them may carry the reaction.
bool have_one_law(const ContactProblem& problem, const std::vector<Index>& points) {
  const Index one = points.front();
  return std::ranges::all_of(points, [&](Index other) {
    return problem.is_eligible(other) && problem.friction_coefficient[other] == problem.friction_coefficient[one] &&
           problem.bound(other) == problem.bound(one);
  });
}

double normal_motion(const ContactProblem& problem, const Vector& motion, Index point) {
  return motion[problem.row_offset[std::size_t(point)]];
}

Index deepest_of(const ContactProblem& problem, const Vector& motion, const std::vector<Index>& points) {
  return *std::ranges::min_element(points, [&](Index one, Index other) {
    return normal_motion(problem, motion, one) < normal_motion(problem, motion, other);
  });
}

bool penetrates(const ContactProblem& problem, const Vector& motion, Index point) {
  const Index row = problem.row_offset[std::size_t(point)];
  const double offset_rounding = problem.offset_rounding.size() > 0 ? problem.offset_rounding[row] : 0.0;
  return motion[row] < -(offset_rounding + sum_rounding * std::abs(problem.offset[row]));
}

}  // namespace

bool TwinPoints::any(const ContactOperator& w, const std::vector<Index>& first) {
  if (is_analysed_ || w.dense() == nullptr) return !groups_.empty();
  is_analysed_ = true;
  const Matrix& entries = *w.dense();
  const auto rows_of = [&](Index point) {
    const auto at = std::size_t(point);
    return std::pair(first[at], first[at + 1] - first[at]);
  };
  const auto are_alike = [&](Index one, Index other) {
    const auto [a, size] = rows_of(one);
    const auto [b, other_size] = rows_of(other);
    if (size != other_size) return false;
    for (Index k = 0; k < size; ++k) {
      const double sum = entries(a + k, a + k) + entries(b + k, b + k);
      if (!(sum - 2.0 * entries(a + k, b + k) <= alike * sum)) return false;
    }
    return true;
  };
  std::vector<Group> groups;
  for (Index point = 0; point + 1 < Index(first.size()); ++point) {
    const auto own =
        std::ranges::find_if(groups, [&](const Group& group) { return are_alike(group.points.front(), point); });
    if (own != groups.end()) {
      own->points.push_back(point);
    } else {
      groups.push_back({{point}, -1});
    }
  }
  std::ranges::copy_if(groups, std::back_inserter(groups_), [](const Group& group) { return group.points.size() > 1; });
  return !groups_.empty();
}

/// Moves the reactions of the group to one point.
void TwinPoints::replace(const ContactProblem& problem, Group& group, Index point, std::vector<char>& selected,
                         Vector& reaction) {
  const auto at = std::size_t(point);
  const Index size = problem.row_offset[at + 1] - problem.row_offset[at];
  PointVector sum = PointVector::Zero(size);
  for (const Index other : group.points) {
    auto part = reaction.segment(problem.row_offset[std::size_t(other)], size);
    sum += part;
    part.setZero();
    selected[std::size_t(other)] = 0;
  }
  reaction.segment(problem.row_offset[at], size) = sum;
  selected[at] = 1;
  group.chosen = point;
}

void TwinPoints::choose(const ContactProblem& problem, const Vector& motion, std::vector<char>& selected,
                        Vector& reaction) {
  exchanges_left_ = exchange_limit;
  for (Group& group : groups_) {
    group.chosen = -1;
    const bool is_in = std::ranges::any_of(group.points, [&](Index k) { return selected[std::size_t(k)]; });
    if (is_in && have_one_law(problem, group.points))
      replace(problem, group, deepest_of(problem, motion, group.points), selected, reaction);
  }
}

bool TwinPoints::exchange(const ContactProblem& problem, const Vector& motion, std::vector<char>& selected,
                          Vector& reaction) {
  if (exchanges_left_-- <= 0) return false;
  bool found = false;
  for (Group& group : groups_) {
    if (group.chosen < 0) continue;
    const Index deepest = deepest_of(problem, motion, group.points);
    if (deepest == group.chosen || !penetrates(problem, motion, deepest)) continue;
    replace(problem, group, deepest, selected, reaction);
    found = true;
  }
  return found;
}

}  // namespace ricochet
