#include "ricochet/simulation/impact/impacts.hpp"

#include <algorithm>
#include <cmath>

#include "ricochet/simulation/history/sensor.hpp"

namespace ricochet {

ImpactRecorder::ImpactRecorder(const SemidiscreteProblem& problem, const Scheme& scheme, const State& state,
                               const std::vector<ContactPair>& pairs, std::vector<int> body_of_node,
                               std::vector<double> separation)
    : problem_(problem),
      scheme_(scheme),
      rigid_(problem, std::move(body_of_node), int(separation.size())),
      separation_(std::move(separation)) {
  separation_.resize(rigid_.bodies().size(), 0.0);
  find_collision_pairs(pairs);
  open_.assign(collision_pairs_.size(), Interval{});
  for (std::size_t collision = 0; collision < collision_pairs_.size(); ++collision)
    open_[collision].collision = collision;
  completed_.reserve(most_impacts);
  current_.resize(collision_pairs_.size());
  find_forces(state.forces, state.obstacle_increment, previous_);
  store_velocity(state, velocity_before_);
  displacement_before_ = state.displacement;
}

/// Computes the velocity with which momenta are accounted for.
void ImpactRecorder::store_velocity(const State& state, Vector& velocity) {
  if (scheme_.traits().energy_instant == 0.0) {
    velocity = state.velocity;
  } else {
    scheme_.energy_state(state, scratch_, velocity);
  }
}

void ImpactRecorder::find_forces(const StepForces& acting, const ObstacleMotion& travel,
                                 std::vector<Force>& forces) const {
  forces.assign(collision_pairs_.size(), Force{});
  const int d = problem_.dimension;
  for (const auto& [point, collision, part] : parts_) {
    if (!carries_acting_force(acting, point)) continue;
    Force& force = forces[collision];
    const double pressing = std::abs(part) * acting.acting_normal()[point];
    const SpaceVector own = part * acting_contact_force(acting, point);
    ++force.points;
    if (const double size = own.norm(); force.leading < 0 || size > force.leading_size) {
      force.leading = point;
      force.leading_size = size;
    }
    if (problem_.axisymmetric) {
      add_along_axis(point, part, own, acting, travel, force);
      continue;
    }
    force.all.head(d) += own;
    force.normal.head(d) += part * acting.acting_normal()[point] * acting.rows->normal(point);
    force.pressing += pressing;
    if (travel.normal.size() == 0) continue;
    force.travel += pressing * travel.normal[point];
    force.sliding.head(d) += pressing * acting.rows->along_tangents(point, travel.tangential);
  }
  add_up_ranks(forces);
}

/// Among equal largest forces that of the first rank is the leading one.
void ImpactRecorder::add_up_ranks(std::vector<Force>& forces) const {
  if (!problem_.ranks->are_several()) return;
  NumberVisitor own;
  for (Force& force : forces) {
    if (force.leading >= 0) force.leading_position = reference_position(force.leading);
    own(force);
    force = {};
  }
  for (const std::vector<double>& of_rank : problem_.ranks->all_gather(own.written())) {
    const Vector numbers = Eigen::Map<const Vector>(of_rank.data(), Index(of_rank.size()));
    NumberVisitor reads(numbers, "forces");
    for (Force& force : forces) {
      Force part;
      reads(part);
      force.all += part.all;
      force.normal += part.normal;
      force.sliding += part.sliding;
      force.pressing += part.pressing;
      force.travel += part.travel;
      force.points += part.points;
      if (part.leading_size > force.leading_size) {
        force.leading_size = part.leading_size;
        force.leading_position = part.leading_position;
      }
    }
  }
}

/// Adds the part of a point's force, and of its obstacle's motion, that remains over the ring: for rings that press on
/// a cone the component along the axis.
void ImpactRecorder::add_along_axis(Index point, double part, const SpaceVector& own, const StepForces& acting,
                                    const ObstacleMotion& travel, Force& force) const {
  const double reaction = acting.acting_normal()[point], slope = acting.rows->normal(point)[1];
  force.all[1] += own[1];
  force.normal[1] += part * reaction * slope;
  const double pressing = std::abs(part) * reaction;
  force.pressing += pressing * std::abs(slope);
  if (travel.normal.size() > 0) force.travel += pressing * travel.normal[point];
}

void ImpactRecorder::find_other_forces() {
  const std::span<const OtherStageForces> parts = scheme_.last_step().other_stages;
  others_.resize(parts.size());
  for (std::size_t i = 0; i < parts.size(); ++i) {
    others_[i].weight = parts[i].weight;
    find_forces(parts[i].forces, parts[i].obstacle_increment, others_[i].forces);
  }
}

void ImpactRecorder::enter_impulse(const State& state) { store_velocity(state, velocity_before_); }

ImpactRecorder::Acting ImpactRecorder::acting_in(std::size_t collision) const {
  Acting acting;
  const Force &previous = previous_[collision], &current = current_[collision];
  if (scheme_.traits().work_rule.previous_weight != 0.0 && previous.any()) acting.previous = &previous;
  if (current.any()) acting.current = &current;
  for (const OtherForces& each : others_) {
    const Force& force = each.forces[collision];
    if (force.any() && (acting.other == nullptr || force.size() > acting.other->size())) acting.other = &force;
  }
  return acting;
}

void ImpactRecorder::enter_step(const State& state, double method_energy) {
  if (collision_pairs_.empty()) return;
  method_energy_ = method_energy;
  find_forces(state.forces, state.obstacle_increment, current_);
  find_other_forces();
  motion_ = nullptr;
  if (state.step <= 1 && first_step_ == 0.0) first_step_ = scheme_.step();
  const double instant = state.time + scheme_.acting_instant() * scheme_.step();
  for (std::size_t collision = 0; collision < collision_pairs_.size(); ++collision)
    enter_collision_pair(collision, instant);
  std::swap(previous_, current_);
  method_before_ = method_energy_;
  store_velocity(state, velocity_before_);
  displacement_before_ = state.displacement;
}

void ImpactRecorder::enter_collision_pair(std::size_t collision, double instant) {
  Interval& interval = open_[collision];
  const Acting acting = acting_in(collision);
  const bool touched = interval.phase == touching;
  if (acting.any() != touched && motion_ == nullptr) motion_ = &rigid_.motion(velocity_before_, displacement_before_);
  if (!acting.any()) {
    if (touched) release(interval);
    return;
  }
  if (!touched) touch(interval, acting, instant);
  add_impulses(interval, collision);
  const double h = scheme_.step();
  if (acting.current == nullptr) {
    if (acting.other == nullptr) return;
    // The other force acts before the instant of the forces in the state.
    interval.end = instant;
    interval.contact_time += 0.5 * h;
    update_largest(interval, *acting.other, instant);
    return;
  }
  const Force& current = *acting.current;
  interval.end = instant + 0.5 * h;
  interval.contact_time += h;
  interval.pressing += h * current.pressing;
  interval.travel += current.travel;
  interval.sliding += current.sliding;
  update_largest(interval, current, instant);
}

double ImpactRecorder::separation_at(const Interval& interval) const {
  const CollisionPair& collision = collision_pairs_[interval.collision];
  return std::max(separation(collision.body), collision.other < 0 ? 0.0 : separation(collision.other));
}

void ImpactRecorder::release(Interval& interval) const {
  const CollisionPair& collision = collision_pairs_[interval.collision];
  interval.after = motion_of(collision.body);
  if (collision.other >= 0) interval.other_after = motion_of(collision.other);
  interval.method_after = method_energy_;  // the release also changes the energy
  interval.phase = apart;
}

void ImpactRecorder::touch(Interval& interval, const Acting& acting, double instant) {
  const double h = scheme_.step();
  const bool acts_before = acting.previous != nullptr;
  // A force acts before the first instant of the steps only at the start of the run.
  const double time = acts_before ? 0.0 : std::max(0.0, instant - 0.5 * h);
  if (interval.phase == apart && time - interval.end < std::max(2.0 * h, separation_at(interval))) {
    ++interval.intervals;
  } else {
    if (interval.phase == apart) file(interval);
    begin(interval, time, acting.first());
  }
  interval.phase = touching;
  if (!acts_before) return;
  // The force acts in the first half of the step, possibly as the only one.
  interval.end = instant - 0.5 * h;
  interval.contact_time += 0.5 * h;
  update_largest(interval, *acting.previous, instant - h);
}

void ImpactRecorder::add_impulses(Interval& interval, std::size_t collision) const {
  const WorkRule rule = scheme_.traits().work_rule;
  const double h = scheme_.step();
  const auto add_impulse = [&](const Force& force, double weight) {
    interval.impulse += h * weight * force.all;
    interval.normal_impulse += h * weight * force.normal;
  };
  add_impulse(previous_[collision], rule.previous_weight);
  add_impulse(current_[collision], rule.current_weight);
  for (const OtherForces& each : others_) add_impulse(each.forces[collision], each.weight);
}

void ImpactRecorder::update_largest(Interval& interval, const Force& force, double instant) {
  interval.most_points = std::max(interval.most_points, force.points);
  const double size = force.size();
  if (!(size > interval.largest)) return;
  interval.largest = size;
  interval.largest_time = instant;
}

/// Returns the position in the reference configuration.
Eigen::Vector3d ImpactRecorder::reference_position(Index point) const {
  Eigen::Vector3d collision = Eigen::Vector3d::Zero();
  double sum = 0.0;
  problem_.contact.visit_own_nodes(point, [&](Index node, double weight) {
    collision.head(problem_.dimension) += weight * problem_.nodes.col(node);
    sum += weight;
  });
  return collision / sum;
}

void ImpactRecorder::begin(Interval& interval, double time, const Force& first) {
  const std::size_t collision = interval.collision;
  interval = {};
  interval.collision = collision;
  interval.begin = interval.end = time;
  interval.from_start = !(time > 0.0);
  // The first instant with a force can be the end of the first step.
  const bool in_first_step = time < first_step_;
  interval.from_inside = in_first_step && collision_pairs_[collision].begins_inside;
  interval.intervals = 1;
  interval.first_position = first.leading >= 0 ? reference_position(first.leading) : first.leading_position;
  const CollisionPair& at = collision_pairs_[interval.collision];
  interval.before = motion_of(at.body);
  if (at.other >= 0) interval.other_before = motion_of(at.other);
  interval.method_before = method_before_;
  compute_rotations(interval);
}

void ImpactRecorder::file(const Interval& interval) {
  if (completed_.size() < most_impacts) {
    completed_.push_back(interval);
  } else {
    ++left_out_;
  }
}

Impact ImpactRecorder::describe(const Interval& interval) const {
  const CollisionPair& collision = collision_pairs_[interval.collision];
  Impact result;
  result.body = collision.body;
  result.obstacle = collision.obstacle;
  result.begin = interval.begin;
  result.end = interval.end;
  result.ended = interval.phase != touching;
  result.from_start = interval.from_start;
  result.from_inside = interval.from_inside;
  result.intervals = interval.intervals;
  result.contact_time = interval.contact_time;
  result.impulse = interval.impulse;
  result.normal_impulse = interval.normal_impulse;
  result.largest_force = interval.largest;
  result.largest_force_time = interval.largest_time;
  result.contact_points = interval.most_points;
  result.all_contact_points = collision.points;
  result.first_position.assign(interval.first_position.begin(), interval.first_position.begin() + problem_.dimension);
  if (interval.pressing > 0.0) {
    result.obstacle_velocity = interval.travel / interval.pressing;
    result.obstacle_sliding = interval.sliding / interval.pressing;
  }
  const RigidBody& body = rigid_.bodies()[std::size_t(collision.body)];
  result.mass = body.mass;
  result.held = body.held;
  result.before = interval.before;
  if (result.ended) result.after = interval.after;
  if (collision.other >= 0) {
    const RigidBody& other = rigid_.bodies()[std::size_t(collision.other)];
    result.other = OtherBody{collision.other, other.mass, interval.other_before, {}, other.held};
    if (result.ended) result.other->after = interval.other_after;
  }
  result.method_energy = (result.ended ? interval.method_after : method_before_) - interval.method_before;
  if (result.ended) result.rotation_growth = growth_in(interval, result);
  return result;
}

std::vector<Impact> ImpactRecorder::impacts() const {
  std::vector<Impact> result;
  for (const Interval& interval : completed_) result.push_back(describe(interval));
  for (const Interval& interval : open_) {
    if (interval.phase != no_contact) result.push_back(describe(interval));
  }
  std::ranges::stable_sort(result, {}, &Impact::begin);
  return result;
}

}  // namespace ricochet
