#include "ricochet/base/error.hpp"
#include "ricochet/scheme/reduced/finite_layer.hpp"

/// @file How the rounds of a step go on where they come no nearer.
namespace ricochet {

namespace {

/// Rounds after which pairs of facets that change all the time are held.
constexpr int patience_of_pairs = 80;

}  // namespace

/// From now on, until the step is done. False: there is nothing to hold, or it is held already.
bool FiniteLayer::hold_pairs(const SemidiscreteProblem& problem) {
  if (!problem.contact.follows_motion() || !problem.contact.geometry->hold()) return false;
  progress_.restart();
  acceleration_.restart();
  return true;
}

void FiniteLayer::heed(const SemidiscreteProblem& problem, NewtonProgress::Advice advice, const Round& round,
                       StageSolve& stages) {
  // What faces what may change from round to round.
  const bool is_stuck = advice == NewtonProgress::Advice::failed ||
                        (advice == NewtonProgress::Advice::renew && progress_.rounds() > patience_of_pairs);
  if (is_stuck && hold_pairs(problem)) return;
  if (advice == NewtonProgress::Advice::failed) throw progress_.failure(round.correction);
  if (advice != NewtonProgress::Advice::renew) return;
  stages.renew(middle_, end_);
  progress_.count_renewal();
  progress_.restart();
  acceleration_.restart();
}

/// Throws Error(not_converged) that names a cell which the places of this round turn inside out: operators there mean
/// nothing, and what a stage says of them does not tell why.
void FiniteLayer::name_inverted_cell(const SemidiscreteProblem& problem) {
  problem.internal_force->evaluate(end_, product_);
  problem.internal_force->evaluate(middle_, product_);
}

void FiniteLayer::halve_where_inverted(const SemidiscreteProblem& problem, double step, const State& state, bool near) {
  constexpr int most_halvings = 5;
  for (int halving = 0;; ++halving) {
    try {
      evaluate(problem, step, state, near);
      return;
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::not_converged || halving == most_halvings) throw;
    }
    middle_ = 0.5 * (middle_ + last_middle_);
    end_ = 0.5 * (end_ + last_end_);
  }
}

}  // namespace ricochet
