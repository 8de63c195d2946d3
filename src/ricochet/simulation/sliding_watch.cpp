#include "ricochet/simulation/sliding_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/simulation/facet_sizes.hpp"

namespace ricochet {

SlidingWatch::SlidingWatch(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs)
    : problem_(problem), pairs_(pairs), limit_(slip_limits(body, problem.contact, pairs)) {
  const ContactBoundary& contact = problem.contact;
  size_ = extent(problem.nodes);
  for (Index point = 0; point < contact.size(); ++point) {
    if (contact.slides(point)) far_points_.push_back(point);
  }
  for (std::size_t number = 0; number < pairs.size(); ++number) {
    if (!pairs[number].has_two_sides() || pairs[number].slides_far) continue;
    Largest largest;
    largest.contact = static_cast<int>(number);
    for (Index point = 0; point < contact.size(); ++point) {
      if (contact.pair[static_cast<std::size_t>(point)] != largest.contact) continue;
      points_.push_back(point);
      at_.push_back(largest_.size());
    }
    largest_.push_back(largest);
  }
}

/// Of the mean vector across the gap what is along the surface: where facets were paired it is along the normal.
double SlidingWatch::slip_of(Index point, const State& state) const {
  const Index d = problem_.dimension;
  SpaceVector apart = SpaceVector::Zero(d);
  problem_.contact.visit_nodes(point, [&](Index node, double weight) {
    apart += weight * (problem_.nodes.col(node) + state.displacement.segment(node * d, d));
  });
  const SpaceVector normal = state.forces.rows->normal(point);
  return (apart - apart.dot(normal) * normal).norm();
}

/// A held step leaves a gap, or an overlap, at a point that carries a force.
void SlidingWatch::look_at_sliding_pairs(const State& state) {
  constexpr double settled = 1e-9;
  tell_of_held(state);
  if (has_told_ || state.step == 0 || !problem_.contact.geometry->has_held()) return;
  problem_.gaps(state.displacement, state.time, gap_);
  for (const Index point : far_points_) {
    if (!(state.forces.normal_reaction[point] > 0.0) || std::abs(gap_[point]) <= settled * size_ ||
        gap_[point] >= problem_.contact.out_of_sight)
      continue;
    const ContactPair& pair = pairs_[static_cast<std::size_t>(problem_.contact.pair[static_cast<std::size_t>(point)])];
    log::warning(fmt::format(
        "at t = {:.6g} what faces what of \"{}\" and \"{}\" changed from one round of the step to the next, and was "
        "held: "
        "the point at ({:.4g}) (reference position) carries a force at a gap of {:.3g}. No energy is made of that; "
        "smaller facets at edges and corners, all of the surface in the groups, and a smaller time.step avoid it. The "
        "column unsettled_gap has it for every step",
        state.time, pair.first_group(), pair.second_group(), fmt::join(place_of(point), ", "), gap_[point]));
    has_told_ = true;
    return;
  }
}

/// Of the first one, whatever it leaves.
void SlidingWatch::tell_of_held(const State& state) {
  if (has_told_held_ || !problem_.contact.geometry->has_held()) return;
  has_told_held_ = true;
  log::warning(
      fmt::format("at t = {:.6g} what faces what of bodies that slide far changed from one round of a step to the "
                  "next, and was held: "
                  "forces of such steps give no energy, but have a moment, which the angular momentum of free bodies "
                  "shows; smaller "
                  "facets at edges and corners, and a smaller time.step, avoid it",
                  state.time));
}

void SlidingWatch::look(const State& state) {
  if (!far_points_.empty()) look_at_sliding_pairs(state);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Index point = points_[i];
    if (!(state.forces.normal_reaction[point] > 0.0)) continue;
    Largest& largest = largest_[at_[i]];
    const double slip = slip_of(point, state);
    if (!(slip > largest.ratio * limit_[point])) continue;
    largest.ratio = slip / limit_[point];
    largest.slip = slip;
    largest.limit = limit_[point];
    largest.time = state.time;
    largest.point = point;
  }
  for (Largest& largest : largest_) {
    if (largest.is_beyond || !(largest.ratio > 1.0)) continue;
    largest.is_beyond = true;
    largest.time_beyond = largest.time;
    tell(largest);
  }
}

std::vector<double> SlidingWatch::place_of(Index point) const {
  Vector place = Vector::Zero(problem_.dimension);
  if (point >= 0)
    problem_.contact.visit_own_nodes(point,
                                     [&](Index node, double weight) { place += weight * problem_.nodes.col(node); });
  return {place.data(), place.data() + place.size()};
}

void SlidingWatch::tell(const Largest& largest) const {
  const ContactPair& pair = pairs_[static_cast<std::size_t>(largest.contact)];
  log::warning(fmt::format(
      "at t = {:.6g} the bodies of \"{}\" and \"{}\" have slid along each other by {:.3g} at ({:.4g}) (reference "
      "position), more than half of the smaller facet there ({:.3g}): a contact between bodies keeps the facets "
      "together that faced each other {}, and from here on its pressures act at other places than those that touch; "
      "set sliding = \"large\" in this [[contact]], limit the motion, or pair the bodies with pair_at where they are "
      "pressed",
      largest.time, pair.first_group(), pair.second_group(), largest.slip, fmt::join(place_of(largest.point), ", "),
      largest.limit, pair.pair_at.size() > 0 ? "at pair_at" : "at the start"));
}

std::vector<PairSliding> SlidingWatch::report() const {
  std::vector<PairSliding> result;
  for (const Largest& largest : largest_) {
    PairSliding pair;
    pair.contact = largest.contact;
    pair.slip = largest.slip;
    pair.limit = largest.limit;
    pair.time = largest.time;
    if (largest.point >= 0) pair.place = place_of(largest.point);
    if (largest.is_beyond) pair.time_beyond = largest.time_beyond;
    result.push_back(pair);
  }
  return result;
}

void SlidingWatch::save(Snapshot& snapshot, const std::string& name) const {
  Vector numbers(7 * static_cast<Index>(largest_.size()));
  for (std::size_t i = 0; i < largest_.size(); ++i) {
    const Largest& largest = largest_[i];
    numbers.segment<7>(7 * static_cast<Index>(i)) << largest.ratio, largest.slip, largest.limit, largest.time,
        largest.time_beyond, static_cast<double>(largest.point), largest.is_beyond ? 1.0 : 0.0;
  }
  snapshot.save(name, numbers);
  snapshot.save(name + ".has_told", std::int64_t{has_told_ ? 1 : 0} + std::int64_t{has_told_held_ ? 2 : 0});
}

void SlidingWatch::load(const Snapshot& snapshot, const std::string& name) {
  const Vector& numbers = snapshot.reals(name, 7 * static_cast<Index>(largest_.size()));
  const std::int64_t told = snapshot.integer(name + ".has_told");
  has_told_ = (told & 1) != 0;
  has_told_held_ = (told & 2) != 0;
  for (std::size_t i = 0; i < largest_.size(); ++i) {
    const auto of = numbers.segment<7>(7 * static_cast<Index>(i));
    const bool fits = of.allFinite() && of[5] >= -1.0 && of[5] < static_cast<double>(problem_.contact.size()) &&
                      of[5] == std::floor(of[5]) && (of[6] == 0.0 || of[6] == 1.0);
    if (!fits) throw Error(ErrorKind::invalid_input, "the checkpoint's record of sliding is damaged");
    Largest& largest = largest_[i];
    largest.ratio = of[0];
    largest.slip = of[1];
    largest.limit = of[2];
    largest.time = of[3];
    largest.time_beyond = of[4];
    largest.point = static_cast<Index>(of[5]);
    largest.is_beyond = of[6] != 0.0;
  }
}

}  // namespace ricochet
