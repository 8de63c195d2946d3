#include "ricochet/simulation/step_control.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"

namespace ricochet {

constexpr double order = 2.0;  ///< of the error of a step
constexpr int first_level = 4;
constexpr double most_created = 100.0;  ///< times the energy that the motion has without it
constexpr double most_growth = 4.0;     ///< of the largest energy in a step, in the measure of its error
constexpr double aim = 0.5;             ///< of the tolerance, for the next step
constexpr double part_of_prospect = 0.25;
/// Growth of the largest energy in an attempt above which more is about to come; less is rounding or gradual growth.
constexpr double growth_ahead = 1e-3;
constexpr int least_patience = 2, most_patience = 64;  ///< steps

StepControl::StepControl(const SemidiscreteProblem& problem, const StepControlOptions& options)
    : problem_(problem), options_(options) {
  const auto refuse = [](const std::string& what) { throw Error(ErrorKind::invalid_input, what); };
  if (!(options.smallest > 0.0) || options.smallest > options.largest)
    refuse(fmt::format("the smallest step, {:.6g}, must be positive and at most the largest, {:.6g}", options.smallest,
                       options.largest));
  const double halvings = std::ceil(std::log2(options.largest / options.smallest) - 1e-9);
  if (!(halvings <= most_levels))
    refuse(fmt::format("the smallest step, {:.6g}, is more than 2^{} times shorter than the largest, {:.6g}",
                       options.smallest, most_levels, options.largest));
  deepest_ = int(halvings);
  // An end that is a whole number of smallest steps up to rounding is taken as that number.
  const double ticks =
      std::ceil(options.end / step_of(deepest_) - std::min(1e-12 * options.end / step_of(deepest_), 0.5));
  if (!(ticks <= most_ticks))
    refuse(fmt::format(
        "{:.3g} of the smallest step, {:.6g}, are needed to reach the end, {:.6g}; at most {:.0e} are possible", ticks,
        options.smallest, options.end, most_ticks));
  end_ticks_ = std::max(std::int64_t{1}, std::int64_t(ticks));
  find_inertia();
}

void StepControl::find_inertia() {
  const Supports& supports = problem_.supports;
  const bool moves = std::any_of(supports.dofs().begin(), supports.dofs().end(),
                                 [&](Index dof) { return supports.expression(dof).depends_on_time(); });
  if (!problem_.ranks->any(moves)) return;
  problem_.mass.multiply(Vector::Ones(problem_.mass.size()), force_);
  inertia_ = problem_.mass.diagonal();
  const double scale = problem_.ranks->sum(force_.sum()) / problem_.ranks->sum(inertia_.sum());
  problem_.ranks->accumulate(inertia_);
  inertia_ *= scale;
  for (const Index dof : supports.dofs()) inertia_[dof] = 0.0;
}

double StepControl::energy_of_change() {
  if (inertia_.size() == 0) return problem_.ranks->sum(0.5 * problem_.mass.quadratic_form(change_));
  problem_.mass.multiply(change_, force_);
  at_nodes_ = force_;
  problem_.ranks->accumulate(at_nodes_);
  double sum = 0.0;
  for (Index dof = 0; dof < inertia_.size(); ++dof) {
    if (inertia_[dof] > 0.0) sum += 0.5 * force_[dof] * at_nodes_[dof] / inertia_[dof];
  }
  return problem_.ranks->sum(sum);
}

double StepControl::step_of(int level) const { return std::ldexp(options_.largest, -level); }

void StepControl::start(const State& state) {
  ticks_ = 0;
  level_ = required_level_ = last_level_ = finest_ = std::min(deepest_, first_level);
  acceleration_before_ = state.acceleration;
  // This acceleration is that at t = 0, while those of steps are at their midpoints.
  step_before_ = 0.0;
  fit_to_end();
}

bool StepControl::accept(const State& before, const State& after, double energy) {
  const double h = step();
  acceleration_ = (after.velocity - before.velocity) / h;
  change_ = acceleration_ - acceleration_before_;
  // The energy of a diverging attempt must not be the measure of its own error.
  const double scale =
      largest_energy_ > 0.0 ? std::clamp(energy, largest_energy_, most_growth * largest_energy_) : energy;
  const double own = energy_of_change();
  const double measure = std::max(scale, energy_ahead());
  error_ = own != 0.0 ? h * h / (6.0 * (h + step_before_)) * std::sqrt(own / measure) / options_.tolerance : 0.0;
  if (!std::isfinite(energy) || !std::isfinite(error_)) error_ = std::numeric_limits<double>::infinity();
  const bool grown = level_ < last_level_;
  needs_trial_step_ =
      !(error_ <= 1.0) && ticks_ >= energy_ahead_ticks_ && energy > (1.0 + growth_ahead) * largest_energy_;
  if (needs_trial_step_) {
    ++counts_.refused;
    return false;
  }
  if (!(error_ <= 1.0)) {
    if (level_ < deepest_) {
      ++counts_.refused;
      const double halvings = std::isfinite(error_) ? std::ceil(std::log2(error_ / aim) / order) : 3.0;
      level_ = required_level_ = std::min(deepest_, level_ + std::clamp(int(halvings), 1, 3));
      finest_ = std::max(finest_, required_level_);
      // Growth that fails is retried ever more rarely.
      backoff_ = grown ? std::min(2 * backoff_, most_patience) : least_patience;
      patience_ = backoff_;
      return false;
    }
    ++counts_.tolerated;
  }
  largest_energy_ = scale;
  counts_.largest_error = std::max(counts_.largest_error, error_);
  counts_.shortest = counts_.shortest == 0.0 ? h : std::min(counts_.shortest, h);
  counts_.longest = std::max(counts_.longest, h);
  ticks_ += ticks_of(level_);
  std::swap(acceleration_, acceleration_before_);
  step_before_ = h;
  last_level_ = level_;
  if (grown) {
    backoff_ = least_patience;
    patience_ = 0;
  }
  patience_ = std::max(patience_ - 1, -most_patience - 1);
  // Vibrations that no step of this size resolves have a smaller error with a longer step, so that growth is tried now
  // and then. They usually dominate the error, which then grows by less than the factor of four of a smooth motion.
  const bool may_grow = error_ <= aim ? patience_ < 0 : patience_ < -most_patience;
  if (may_grow && level_ == required_level_ && required_level_ > 0) --required_level_;
  level_ = required_level_;
  fit_to_end();
  return true;
}

void StepControl::watch(double energy, double created) {
  count_step();
  own_energy_ = std::max(own_energy_, energy - std::max(created, 0.0));
  if (!(created > most_created * own_energy_)) return;
  throw Error(
      ErrorKind::not_converged,
      fmt::format("t = {:.9g}: the time scheme has created an energy of {:.3g}, while the motion itself had {:.3g}; "
                  "shorter steps only make it create more: use scheme \"reduced-kane\" with mass \"equivalent\"",
                  time(), created, own_energy_));
}

/// No energy ahead counts once its time has come; one found after a refusal also serves the repeated attempt.
void StepControl::set_energy_ahead(int level, double energy) {
  energy_ahead_ = std::isfinite(energy) ? part_of_prospect * energy : 0.0;
  energy_ahead_ticks_ = ticks_ + ticks_of(level);
}

void StepControl::count_step() {
  if (ticks_ - stretch_ticks_ >= ticks_of(0)) {
    stretch_ticks_ = ticks_;
    stretch_steps_ = 0;
  }
  ++stretch_steps_;
  if (stretch_steps_ != many_steps && stretch_steps_ != most_steps) return;
  const double gone = double(ticks_ - stretch_ticks_) * step_of(deepest_);
  const std::string pace = fmt::format(
      "t = {:.9g}: the last {} steps have advanced by only {:.3g}, a fraction of time.largest = {:g}, and the last has "
      "an error of {:.2g} times time.tolerance: the motion has jumps that no step length resolves, or vibrations that "
      "require such steps",
      time(), stretch_steps_, gone, options_.largest, error_);
  const std::string advice = fmt::format(
      "set time.smallest = {:.3g}, a length at which no step is rejected, or a larger time.tolerance; if so many steps "
      "are intended, a smaller time.largest",
      step_of(first_level));
  if (stretch_steps_ == most_steps)
    throw Error(ErrorKind::not_converged,
                fmt::format("{}; history.csv would have a row for each of them; {}", pace, advice));
  log::warning(
      fmt::format("{}; at this rate the run needs {:.2g} steps, each with a row of history.csv, and it ends with an "
                  "error after {} of them; {}",
                  pace, double(stretch_steps_) * options_.end / gone, most_steps, advice));
}

bool StepControl::shorten() {
  if (level_ == deepest_) return false;
  ++counts_.unsolved;
  required_level_ = ++level_;
  finest_ = std::max(finest_, required_level_);
  patience_ = backoff_ = least_patience;
  return true;
}

/// Near the end lengths in use are preferred; of steps of the shortest of them the last may exceed the end.
void StepControl::fit_to_end() {
  while (level_ < finest_ && ticks_ + ticks_of(level_) > end_ticks_) ++level_;
}

void StepControl::persist(const SnapshotVisitor& visit) {
  int deepest = deepest_;
  visit.integers("ticks", {0, std::int64_t{1} << 60}, ticks_, energy_ahead_ticks_, stretch_ticks_, stretch_steps_);
  visit.integers("levels", {0, deepest_}, level_, required_level_, last_level_, deepest);
  visit.require(deepest == deepest_, "levels", "belongs to other step lengths");
  visit.integers("steps", {std::numeric_limits<int>::min() / 2, most_levels * most_patience}, finest_, patience_,
                 backoff_);
  visit.require(finest_ >= 0 && finest_ <= deepest_ && backoff_ >= 0, "steps", "does not belong to these step lengths");
  visit.integers("counts", {}, counts_.refused, counts_.unsolved, counts_.tolerated);
  const Vector numbers = visit.numbers("numbers", largest_energy_, step_before_, error_, counts_.largest_error,
                                       counts_.shortest, counts_.longest, own_energy_, energy_ahead_);
  visit.require((numbers.array() >= 0.0).all(), "numbers", "has entries that are negative or not numbers");
  visit("acceleration", acceleration_before_, problem_.dof_count());
  if (!visit.loads()) return;
  // The end may differ from the one that the saved length was fitted to.
  level_ = required_level_;
  fit_to_end();
}

}  // namespace ricochet
