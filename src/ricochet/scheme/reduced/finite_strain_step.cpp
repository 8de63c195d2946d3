#include "ricochet/scheme/reduced/finite_strain_step.hpp"

#include <algorithm>
#include <limits>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/scheme/reduced/massless_contact_step.hpp"
#include "ricochet/step/factor_debt.hpp"

namespace ricochet {

namespace {

/// Keys of State::memory: two waits (Wait), that of the kept factor and that of the exact tangent, and the start from
/// which the latter succeeded last; and a FactorDebt.
constexpr const char* newton_waits = "newton_waits";
constexpr const char* factor_debt = "factor_debt";
constexpr Index last_start = 4;

Vector& numbers_of(State& state, const char* key) {
  Vector& numbers = state.memory[key];
  if (numbers.size() == 0) numbers.setZero(State::memory_numbers);
  return numbers;
}

}  // namespace

/// Attempts for which a way to solve a step is not tried after it failed: more, the more often it has failed.
class FiniteStrainStep::Wait {
 public:
  Wait(State& state, Index number) : memory_(numbers_of(state, newton_waits)), first_(2 * number) {}
  /// Counts an attempt; returns whether the way is to be left out.
  [[nodiscard]] bool goes_on() {
    if (!(memory_[first_] > 0.0)) return false;
    memory_[first_] -= 1.0;
    return true;
  }
  void record(bool has_failed) {
    memory_[first_ + 1] = has_failed ? std::min(2.0 * memory_[first_ + 1] + 1.0, most) : 0.0;
    memory_[first_] = memory_[first_ + 1];
  }

 private:
  static constexpr double most = 31.0;
  Vector& memory_;
  Index first_;
};

void FiniteStrainStep::analyse(const SemidiscreteProblem& problem, double step) {
  iterate_.analyse(problem, step);
  exact_.analyse(problem);
}

std::vector<OperatorCoefficients> FiniteStrainStep::operators(const SemidiscreteProblem& problem, double step,
                                                              ActingReaction acting) {
  OperatorCoefficients midpoint{.mass = 4.0 / (step * step), .stiffness = 1.0, .damping = 2.0 / step};
  midpoint.relaxation_step = step;
  if (!problem.has_contact_dofs()) return {midpoint};
  midpoint.condensed_operator = int(MasslessContactStep::condensed_stage);
  midpoint.acting = acting;
  OperatorCoefficients contact_operator{.mass = 0.0, .stiffness = 1.0, .damping = 0.0, .dofs = StageDofs::contact};
  contact_operator.relaxation_step = step;
  return {contact_operator, midpoint};
}

/// Takes a step from the flight with factors that are kept, and renewed where they have become too old.
void FiniteStrainStep::advance_with_kept_factor(const StepTask& task, Persistence persistence, Vector& increment) {
  auto& [problem, acting, step, state, stages] = task;
  FactorDebt debt(numbers_of(state, factor_debt));
  if (debt.is_due(stages.renewal_price())) {
    stages.renew_operators(state.displacement, state.displacement);
    debt.clear();
  }
  iterate_.start(task);
  stages.rotate_operators(iterate_.now().middle);
  iterate_.evaluate();
  newton_.solve(kept_, {iterate_.rounding_of_positions(), stages.renewal_price(), stages.newton_tolerance()},
                persistence);
  iterate_.finish(kept_.solution(), increment);
  if (newton_.progress().renewals() > 0) debt.clear();
  if ((state.forces.normal_reaction.array() > 0.0).any()) debt.add_step(newton_.progress().iterations());
}

void FiniteStrainStep::advance_exactly_from(NewtonStart from, const StepTask& task, Vector& increment) {
  if (from == NewtonStart::flight) {
    log::debug("exact tangent: begins with the flight");
    iterate_.start(task);
  } else {
    log::debug("exact tangent: begins with the start of the step");
    iterate_.start_at_rest(task);
  }
  // Velocities of quasi-static motion, which alternate from step to step, may lead far away: a part of the flight that
  // inverts no cell is taken.
  (void)ContactNewton::evaluate_with_halving(exact_);
  exact_.start(task.state);
  if (from == NewtonStart::descent) ContactNewton::descend(exact_, {});
  exact_newton_.solve(
      exact_,
      {iterate_.rounding_of_positions(), std::numeric_limits<double>::infinity(), task.stages.newton_tolerance()},
      Persistence::brief);
  iterate_.finish(exact_.solution(), increment);
}

/// Takes a step by Newton's method with the exact tangent: first from where it succeeded last. Returns false if nothing
/// converges.
bool FiniteStrainStep::advance_exactly(const StepTask& task, Vector& increment) {
  std::vector<NewtonStart> starts{NewtonStart::flight, NewtonStart::start_of_step, NewtonStart::descent};
  const double last = numbers_of(task.state, newton_waits)[last_start];
  std::ranges::stable_sort(starts, {}, [&](NewtonStart start) { return double(start) == last ? 0 : 1; });
  for (const NewtonStart from : starts) {
    try {
      advance_exactly_from(from, task, increment);
      numbers_of(task.state, newton_waits)[last_start] = double(from);
      return true;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged) throw;
      if (log::enabled(log::Level::debug)) log::debug(std::string("exact tangent: ") + error.what());
    }
  }
  return false;
}

/// Tries iterations with a kept factor and the exact tangent, in this order or, where the former have just failed, in
/// the other one; finally the former without a limit, and with frozen pairs. With the exact tangent the reactions of
/// the end act, which lose energy in an impact: schemes that conserve it take shorter steps as long as they can.
void FiniteStrainStep::advance(const StepTask& task, Vector& increment) {
  const bool conserves = task.acting == ActingReaction::path_mean && task.stages.may_be_shortened();
  if (!task.stages.solves_exactly() || conserves) return advance_with_kept_factor(task, Persistence::full, increment);
  Wait kept(task.state, 0), exact(task.state, 1);
  const auto try_exactly = [&] {
    if (exact.goes_on()) return false;
    const bool is_done = advance_exactly(task, increment);
    exact.record(!is_done);
    return is_done;
  };
  const bool exact_first = kept.goes_on();
  if (exact_first && try_exactly()) return;
  try {
    advance_with_kept_factor(task, Persistence::brief, increment);
    kept.record(false);
    return;
  } catch (const Error& error) {
    if (error.kind() != ErrorKind::not_converged) throw;
    if (log::enabled(log::Level::debug)) log::debug(std::string("kept factor: ") + error.what());
    kept.record(true);
  }
  if (!exact_first && try_exactly()) return;
  advance_with_kept_factor(task, Persistence::full, increment);
}

}  // namespace ricochet
