#include "ricochet/scheme/semi_explicit/tracked_critical_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/base/rounded.hpp"
#include "ricochet/linear_algebra/largest_eigenvalue.hpp"
#include "ricochet/scheme/critical_step.hpp"
#include "ricochet/scheme/requirements.hpp"

namespace ricochet {

namespace {

// Keys of State::memory.
/// (Names this short are looked up without allocating.)
constexpr const char* critical_numbers = "critical_step";        ///< see CriticalNumbers
constexpr const char* critical_displacement = "critical.place";  ///< displacement at the last check
constexpr const char* critical_mode = "critical.mode";           ///< eigenvector M^{½}x found there

/// Indices of the numbers in the state's memory.
enum CriticalNumbers : Index { last_found, smallest_found, near_warned, found_at, evaluations_made };

/// Products with K per check.
constexpr int products = 8;
/// Size of the random part of their starting vector, relative to the last eigenvector.
constexpr double random_part = 0.3;
/// Relative change of a distance that makes a check due: least and largest, and as a part of the remaining margin.
constexpr double min_change = 0.02, part_of_room = 0.5, max_change = 0.15;
/// Part of the energy in the highest frequencies that indicates an instability, and steps between such checks.
constexpr double high_frequency_part = 0.5;
constexpr double rest_between = 16.0;
/// Fractions of the critical step: above the first the run warns; the second is advised if it is likely to fall
/// further.
constexpr double near_fraction = 0.9, careful_fraction = 0.8;
/// Size of ε x relative to the shortest distance of neighbours.
constexpr double difference = 1e-6;

double critical_of(double eigenvalue) {
  return eigenvalue > 0.0 ? 2.0 / std::sqrt(eigenvalue) : std::numeric_limits<double>::infinity();
}

}  // namespace

void TrackedCriticalStep::analyse(const SemidiscreteProblem& problem, double undeformed) {
  inverse_root_ = inverse_root_mass(problem, exponent_);
  smallest_ = undeformed;
  find_pairs(problem);
}

void TrackedCriticalStep::find_pairs(const SemidiscreteProblem& problem) {
  const SparseMatrix tangent = problem.internal_force->tangent();
  const Index d = problem.dimension;
  const Vector by_mass = tangent.diagonal().cwiseProduct(inverse_root_.cwiseAbs2());
  const Vector stiffness = by_mass.reshaped(d, problem.nodes.cols()).colwise().maxCoeff();
  const double stiffest = stiffness.size() > 0 ? stiffness.maxCoeff() : 0.0;
  pairs_.clear();
  shortest_ = std::numeric_limits<double>::infinity();
  for (Index second = 0; second < problem.nodes.cols(); ++second) {
    Index last = -1;
    for (SparseMatrix::InnerIterator entry(tangent, second * d); entry; ++entry) {
      const Index first = entry.row() / d;
      if (first >= second) break;
      if (first == last) continue;
      last = first;
      const double stiffer = std::max(stiffness[first], stiffness[second]);
      if (stiffer == 0.0) continue;
      pairs_.push_back({first, second, stiffer / stiffest});
      shortest_ = std::min(shortest_, (problem.nodes.col(first) - problem.nodes.col(second)).norm());
    }
  }
}

void TrackedCriticalStep::start(const SemidiscreteProblem& problem, double step, bool check, State& state) {
  const double critical = central_difference_limit(problem, state.displacement);
  // A warning for the undeformed body is not repeated.
  if (check && (step >= critical || step <= near_fraction * smallest_)) check_critical_step(scheme_, step, critical);
  state.memory[critical_numbers].setZero(State::memory_numbers);
  state.memory[critical_numbers][smallest_found] = critical;
  state.memory[critical_numbers][near_warned] = check && step > near_fraction * critical ? 1.0 : 0.0;
  state.memory[critical_mode].setZero(problem.dof_count());
  store(critical, state);
}

/// Stores a critical step with the displacement of the state.
void TrackedCriticalStep::store(double critical, State& state) {
  Vector& numbers = state.memory.at(critical_numbers, State::memory_numbers);
  numbers[last_found] = critical;
  smallest_ = numbers[smallest_found] = std::min(numbers[smallest_found], critical);
  numbers[found_at] = double(state.step);
  state.memory[critical_displacement] = state.displacement;
}

std::string TrackedCriticalStep::location_text(const SemidiscreteProblem& problem, const State& state) const {
  const Vector& mode = state.dof_memory(critical_mode);
  Index at = 0;
  if (mode.cwiseProduct(inverse_root_).cwiseAbs().maxCoeff(&at) == 0.0) return "";
  const Index node = at / problem.dimension;
  const Vector where =
      problem.nodes.col(node) + state.displacement.segment(node * problem.dimension, problem.dimension);
  return fmt::format(" by the cells at the node now at ({:.6g})", fmt::join(where, ", "));
}

void TrackedCriticalStep::require_stable(const SemidiscreteProblem& problem, double step, const State& state) {
  const Vector& numbers = state.memory.at(critical_numbers, State::memory_numbers);
  smallest_ = numbers[smallest_found];
  const double critical = numbers[last_found];
  if (step < critical) return;
  throw Error(
      ErrorKind::not_converged,
      fmt::format(
          "the bodies are deformed so much that the critical step of \"{}\" is {:.6g} (determined{}): time.step = "
          "{:.6g} is {:.3g} times that, and the motion would grow without bound; set time.step = {:.3g} or less, as "
          "the critical step may decrease further, or use scheme \"reduced-kane\", which is stable for any step",
          scheme_, critical, location_text(problem, state), step, step / critical,
          rounded_down(careful_fraction * critical, 3)));
}

/// Largest relative change of a distance of neighbours since the last check, weighted.
double TrackedCriticalStep::change_since(const SemidiscreteProblem& problem, const State& state) const {
  const Vector& before = state.dof_memory(critical_displacement);
  const double* const u = state.displacement.data();
  const double* const u0 = before.data();
  const double* const x = problem.nodes.data();
  const Index d = problem.dimension;
  struct Largest {
    double value = 0.0;
    Largest& operator+=(const Largest& other) {
      value = std::max(value, other.value);
      return *this;
    }
  };
  const Largest largest = parallel_sum<Largest>(Index(pairs_.size()), [&](Index begin, Index end) {
    Largest part;
    for (Index i = begin; i < end; ++i) {
      const Pair& pair = pairs_[std::size_t(i)];
      const Index a = d * pair.first, b = d * pair.second;
      double length = 0.0, change = 0.0;
      for (Index k = 0; k < d; ++k) {
        const double at = x[b + k] - x[a + k];
        const double then = at + (u0[b + k] - u0[a + k]), now_at = at + (u[b + k] - u[a + k]);
        length += then * then;
        change += (now_at - then) * (now_at + then);
      }
      part.value = std::max(part.value, pair.weight * std::abs(change) / length);
    }
    return part;
  });
  return 0.5 * largest.value;
}

bool TrackedCriticalStep::is_due(const SemidiscreteProblem& problem, double step, double energy,
                                 const State& state) const {
  const Vector& numbers = state.memory.at(critical_numbers, State::memory_numbers);
  if (!std::isfinite(numbers[last_found])) return false;  // no dof has both mass and freedom
  const double room = 1.0 - step / numbers[last_found];
  if (change_since(problem, state) > std::clamp(part_of_room * room, min_change, max_change)) return true;
  if (double(state.step) < numbers[found_at] + rest_between) return false;
  const double high = 0.125 * step * step * problem.mass.quadratic_form(state.acceleration);
  return high > high_frequency_part * (0.5 * problem.mass.quadratic_form(state.velocity) + std::abs(energy));
}

/// Computes λ by some products from the last eigenvector.
double TrackedCriticalStep::find(const SemidiscreteProblem& problem, const Vector& force, State& state) {
  const auto multiply = [&](const Vector& x, Vector& y) {
    displacement_ = inverse_root_.cwiseProduct(x);
    const double size = displacement_.lpNorm<Eigen::Infinity>();
    if (size == 0.0) {
      y.setZero(x.size());
      return;
    }
    const double scale = difference * shortest_ / size;
    displacement_ = state.displacement + scale * displacement_;
    problem.internal_force->evaluate(displacement_, force_);
    y = inverse_root_.cwiseProduct(force_ - force) / scale;
  };
  Vector& mode = state.dof_memory(critical_mode);
  // Each check has another random part: the next ones find what one misses.
  std::mt19937_64 generator(static_cast<std::uint64_t>(state.step));
  std::normal_distribution<double> normal;
  const double part = mode.isZero(0.0) ? 1.0 : random_part / std::sqrt(double(mode.size()));
  for (Index i = 0; i < mode.size(); ++i) mode[i] = inverse_root_[i] > 0.0 ? mode[i] + part * normal(generator) : 0.0;
  const double eigenvalue = improve_largest_eigenvalue(multiply, products, mode);
  return std::ldexp(eigenvalue, -exponent_) / (1.0 - frequency_spread);
}

void TrackedCriticalStep::track(const SemidiscreteProblem& problem, double step, const Vector& force, double energy,
                                State& state) {
  if (!is_due(problem, step, energy, state)) return;
  const double critical = critical_of(find(problem, force, state));
  store(critical, state);
  Vector& numbers = state.memory.at(critical_numbers, State::memory_numbers);
  numbers[evaluations_made] += products;
  if (log::enabled(log::Level::debug)) {
    log::debug(fmt::format(
        "critical step {:.6g}{}: the step is {:.3g} of it; {:.0f} evaluations of the internal force so far to find it",
        critical, location_text(problem, state), step / critical, numbers[evaluations_made]));
  }
  if (step < near_fraction * critical || step >= critical || numbers[near_warned] != 0.0) return;
  numbers[near_warned] = 1.0;
  log::warning(fmt::format(
      "scheme \"{}\": at t = {:.6g} the bodies are deformed so much that the critical step is {:.6g} (determined{}); "
      "time.step = {:.6g} is {:.3g} of it, and the run stops when it exceeds the critical step; use {:.3g} or less",
      scheme_, state.time + step, critical, location_text(problem, state), step, step / critical,
      rounded_down(careful_fraction * critical, 3)));
}

std::string TrackedCriticalStep::explain(const SemidiscreteProblem& problem, double step, const State& state) const {
  const double critical = central_difference_limit(problem, state.displacement);
  return fmt::format("before this step the critical step was {:.6g}, and time.step = {:.6g} is {:.3g} of it", critical,
                     step, step / critical);
}

}  // namespace ricochet
