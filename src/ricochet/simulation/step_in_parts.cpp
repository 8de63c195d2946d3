#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/simulation/simulation.hpp"

/// @file Steps of fixed length, whole or in parts.
namespace ricochet {

namespace {

/// Level of parts from which the user is warned: the step then takes 2^k times as long.
constexpr int short_parts = 5;

}  // namespace

const char* Simulation::failure_reason() const {
  return has_tunnelled_                         ? "a node went through an obstacle"
         : problem_.internal_force->is_linear() ? "the contact forces did not settle"
                                                : "Newton's method found no solution";
}

/// Warns once in a run.
void Simulation::warn_of_short_parts() {
  if (part_lengths_.level() < short_parts || std::exchange(short_parts_warned_, true)) return;
  log::warning(fmt::format(
      "step {} is computed in parts as short as 1/{} of it, and possibly shorter ones, since {} in longer ones: this "
      "takes correspondingly longer, during which the progress does not advance, and it may still fail",
      state_.step + 1, 1L << part_lengths_.level(), failure_reason()));
}

/// Takes a step whole, or in parts if the last one needed them or it has no solution; calls `each_part` after parts.
/// Returns whether it was whole.
bool Simulation::take_fixed_step(const std::function<void(const State&)>& each_part) {
  const PartLengths before = part_lengths_;
  try {
    if (part_lengths_.level() == 0 && take_whole_step()) return true;
    take_step_in_parts(each_part);
  } catch (const Error& problem) {
    const bool has_parts = part_lengths_.done() > 0;
    part_lengths_ = before;
    if (problem.kind() != ErrorKind::not_converged || before.level() == 0 || has_parts) throw;
    return forget_parts(each_part);
  }
  return false;
}

/// Attempts a step from the whole length on, after parts of the remembered length had no solution at its start.
bool Simulation::forget_parts(const std::function<void(const State&)>& each_part) {
  const PartLengths before = std::exchange(part_lengths_, PartLengths());
  try {
    return take_fixed_step(each_part);
  } catch (const Error&) {
    part_lengths_ = before;
    throw;
  }
}

/// Returns false if the step has no solution and can be divided.
bool Simulation::take_whole_step() {
  try {
    take_step(!scheme_.traits().supports_step_changes);
  } catch (const Error& problem) {
    const bool is_nonlinear = !problem_.internal_force->is_linear() || problem_.contact.follows_motion();
    const bool may_cut = is_nonlinear && scheme_.traits().supports_step_changes;
    if (problem.kind() != ErrorKind::not_converged || !may_cut) throw;
    part_lengths_.record_failure();
    return false;
  }
  part_lengths_.record_solution();
  return true;
}

void Simulation::take_step_in_parts(const std::function<void(const State&)>& each_part) {
  const char* const reason = failure_reason();
  const State start = state_;
  const EnergyAccount account = *account_;
  std::vector<FreeMotion> bodies;
  for (const auto& body : problem_.free_bodies) bodies.push_back(*body);
  for (bool is_complete = false; !is_complete;) {
    use_level(part_lengths_.level());
    try {
      take_step(part_lengths_.is_shortest());
    } catch (const Error& problem) {
      if (problem.kind() == ErrorKind::not_converged && !part_lengths_.is_shortest()) {
        part_lengths_.record_failure();
        warn_of_short_parts();
        continue;
      }
      state_ = start;
      for (std::size_t k = 0; k < bodies.size(); ++k) *problem_.free_bodies[k] = bodies[k];
      use_level(0);  // enters a change of the step, unknown to the account of the start
      account_ = std::make_unique<EnergyAccount>(account);
      if (problem.kind() != ErrorKind::not_converged) throw;
      throw Error(problem.kind(), fmt::format("{}; parts of the step as short as 1/{} of it were tried", problem.what(),
                                              PartLengths::whole));
    }
    part_lengths_.record_solution();
    is_complete = part_lengths_.done() == 0;
    const long done = is_complete ? PartLengths::whole : part_lengths_.done();
    state_.time = start.time + whole_step_ * double(done) / double(PartLengths::whole);
    end_part(each_part);
  }
  use_level(0);
  if (cut_steps_++ == 0)
    log::info(fmt::format("step {} is computed in parts, since {} in the whole step", state_.step + 1, reason));
}

}  // namespace ricochet
