#include "ricochet/simulation/monitor/sliding_watch.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/contact/contact_boundary.hpp"
#include "ricochet/simulation/monitor/facet_sizes.hpp"

namespace ricochet {

SlidingWatch::SlidingWatch(const Body& body, const SemidiscreteProblem& problem, const std::vector<ContactPair>& pairs)
    : problem_(problem), pairs_(pairs), limit_(slip_limits(body, problem.contact, pairs)) {
  const ContactBoundary& contact = problem.contact;
  size_ = extent(problem.nodes);
  for (std::size_t number = 0; number < pairs.size(); ++number) {
    if (!pairs[number].has_two_sides()) continue;
    if (pairs[number].large_sliding) {
      add_large_sliding_contact(int(number));
      continue;
    }
    Largest largest;
    largest.contact = int(number);
    for (Index point = 0; point < contact.size(); ++point) {
      if (contact.pair[std::size_t(point)] != largest.contact) continue;
      points_.push_back(point);
      at_.push_back(largest_.size());
    }
    largest_.push_back(largest);
  }
}

void SlidingWatch::add_large_sliding_contact(int number) {
  const ContactBoundary& contact = problem_.contact;
  const Index d = problem_.dimension;
  const Vector stiffness = problem_.internal_force->stiffness_diagonal();
  LargeSlidingContact& sliding = large_sliding_.emplace_back();
  sliding.contact = number;
  sliding.is_self = pairs_[std::size_t(number)].is_self();
  for (Index point = 0; point < contact.size(); ++point) {
    if (!contact.slides(point) || contact.pair[std::size_t(point)] != number) continue;
    // Moves the nodes of the point along its row and holds all others, including those of the opposite side.
    double sum = 0.0, squares = 0.0;
    contact.visit_own_nodes(point, [&](Index node, double weight) {
      sum += weight * weight * stiffness.segment(node * d, d).maxCoeff();
      squares += weight * weight;
    });
    sliding.points.push_back(point);
    sliding.stiffness.push_back(squares > 0.0 ? sum / (squares * squares) : 0.0);
  }
}

/// Returns the component along the surface of the mean vector across the gap, which is normal where facets were paired.
double SlidingWatch::slip_of(Index point, const State& state) const {
  const Index d = problem_.dimension;
  SpaceVector apart = SpaceVector::Zero(d);
  problem_.contact.visit_nodes(point, [&](Index node, double weight) {
    apart += weight * (problem_.nodes.col(node) + state.displacement.segment(node * d, d));
  });
  const SpaceVector normal = state.forces.rows->normal(point);
  return (apart - apart.dot(normal) * normal).norm();
}

/// A frozen step leaves a gap, or an overlap, at points that carry a force.
void SlidingWatch::check_large_sliding(const State& state) {
  warn_of_frozen_step(state);
  if (state.step == 0) return;
  const bool has_frozen = problem_.contact.geometry->has_frozen();
  if (has_frozen) problem_.gaps(state.displacement, state.time, gap_);
  for (LargeSlidingContact& contact : large_sliding_) {
    double force = 0.0;
    for (const Index point : contact.points) force += std::max(0.0, state.forces.normal_reaction[point]);
    contact.largest_force = std::max(contact.largest_force, force);
    if (!has_frozen) continue;
    enter(contact, state);
    if (contact.is_warned || contact.share() <= UnsettledContact::doubtful) continue;
    contact.is_warned = true;
    warn(contact);
  }
}

/// Enters a contact with the gaps at the end of a step. (On a surface that touches itself, other points stand for those
/// without a force.)
void SlidingWatch::enter(LargeSlidingContact& contact, const State& state) const {
  constexpr double settled = 1e-9;
  double force = 0.0, missing = 0.0;
  Index widest = -1;
  for (std::size_t i = 0; i < contact.points.size(); ++i) {
    const Index point = contact.points[i];
    const double reaction = state.forces.normal_reaction[point], gap = gap_[point];
    if (std::abs(gap) <= settled * size_ || gap >= problem_.contact.unpaired_gap) continue;
    if (!(reaction > 0.0) && (gap > 0.0 || contact.is_self)) continue;
    if (gap > 0.0) force += reaction;
    if (gap < 0.0) missing -= gap * contact.stiffness[i];
    if (widest < 0 || std::abs(gap) > std::abs(gap_[widest])) widest = point;
  }
  if (widest < 0) return;
  if (contact.steps++ == 0) contact.first_time = state.time;
  if (!(force + missing > contact.force)) return;
  contact.force = force + missing;
  contact.missing = missing;
  contact.time = state.time;
  contact.gap = gap_[widest];
  contact.point = widest;
}

void SlidingWatch::warn(const LargeSlidingContact& contact) const {
  const ContactPair& pair = pairs_[std::size_t(contact.contact)];
  log::warning(fmt::format(
      "at t = {:.6g} the pairing of {} did not settle: it changed from one iteration of the step to the next and was "
      "frozen. Points are left at {} of up to {:.3g}, for example at ({:.4g}) (reference "
      "position), which nothing {} while they are pressed, and up to {:.3g} % of the force of this contact "
      "is at stake. This creates no energy. The column unsettled_gap has the gap of every step, "
      "\"unsettled_contacts\" in summary.json the share of the largest force",
      contact.time, pair_names(pair.first_group(), pair.second_group()), contact.gap < 0.0 ? "overlaps" : "gaps",
      std::abs(contact.gap), fmt::join(reference_position(contact.point), ", "),
      contact.gap < 0.0 ? "removes" : "closes", 100.0 * contact.share()));
}

/// Warns of the first frozen step, whatever its effect.
void SlidingWatch::warn_of_frozen_step(const State& state) {
  if (frozen_step_warned_ || !problem_.contact.geometry->has_frozen()) return;
  frozen_step_warned_ = true;
  log::warning(
      fmt::format("at t = {:.6g} the pairing of bodies with large sliding changed from one iteration of a step to the "
                  "next and was frozen: the forces of such steps create no energy, but they have a moment, which shows "
                  "in the angular momentum of free bodies",
                  state.time));
}

void SlidingWatch::check(const State& state) {
  if (!large_sliding_.empty()) check_large_sliding(state);
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
    warn(largest);
  }
}

std::vector<double> SlidingWatch::reference_position(Index point) const {
  Vector position = Vector::Zero(problem_.dimension);
  if (point >= 0)
    problem_.contact.visit_own_nodes(point,
                                     [&](Index node, double weight) { position += weight * problem_.nodes.col(node); });
  return {position.data(), position.data() + position.size()};
}

void SlidingWatch::warn(const Largest& largest) const {
  const ContactPair& pair = pairs_[std::size_t(largest.contact)];
  log::warning(fmt::format(
      "at t = {:.6g} the bodies of \"{}\" and \"{}\" have slid along each other by {:.3g} at ({:.4g}) (reference "
      "position), more than half of the smaller facet there ({:.3g}): a contact between bodies keeps the facets paired "
      "that faced each other {}, and from here on its pressures no longer act where the bodies touch; set sliding = "
      "\"large\" in this [[contact]], limit the motion, or pair the bodies with pair_at where they are pressed",
      largest.time, pair.first_group(), pair.second_group(), largest.slip,
      fmt::join(reference_position(largest.point), ", "), largest.limit,
      pair.pair_at.size() > 0 ? "at pair_at" : "at the start"));
}

std::vector<PairSliding> SlidingWatch::report() const {
  std::vector<PairSliding> result;
  for (const Largest& largest : largest_) {
    PairSliding pair;
    pair.contact = largest.contact;
    pair.slip = largest.slip;
    pair.limit = largest.limit;
    pair.time = largest.time;
    if (largest.point >= 0) pair.position = reference_position(largest.point);
    if (largest.is_beyond) pair.time_beyond = largest.time_beyond;
    result.push_back(pair);
  }
  return result;
}

std::vector<UnsettledContact> SlidingWatch::unsettled() const {
  std::vector<UnsettledContact> result;
  for (const LargeSlidingContact& sliding : large_sliding_) {
    if (sliding.steps == 0) continue;
    result.push_back({sliding.contact, sliding.share(), sliding.steps, sliding.first_time, sliding.time, sliding.gap,
                      reference_position(sliding.point)});
  }
  return result;
}

void SlidingWatch::persist(const SnapshotVisitor& visit) {
  constexpr std::int64_t frozen_step = 2, most_steps = 1'000'000'000'000'000;
  std::int64_t warned = frozen_step_warned_ ? frozen_step : 0;
  visit("has_told", warned);
  frozen_step_warned_ = (warned & frozen_step) != 0;
  bool fits = visit.numbers("", largest_).allFinite();
  fits = visit.numbers("far", large_sliding_).allFinite() && fits;
  for (const Largest& each : largest_) fits = fits && is_point(each.point);
  for (const LargeSlidingContact& each : large_sliding_)
    fits = fits && is_point(each.point) && each.steps >= 0 && each.steps < most_steps;
  if (visit.loads() && !fits) throw Error(ErrorKind::invalid_input, "the checkpoint's record of sliding is damaged");
}

}  // namespace ricochet
