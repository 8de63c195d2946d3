#include "ricochet/solver/contact/active_set.hpp"

#include <cmath>
#include <limits>

#include "ricochet/solver/contact/alart_curnier.hpp"
#include "ricochet/solver/contact/iteration_record.hpp"
#include "ricochet/solver/contact/iterative_contact_solver.hpp"

namespace ricochet {

namespace {
/// Block steps without fewer violations before single ones are taken.
constexpr int block_patience = 8;
/// Rounding of u, relative to the data, above which reactions are so large that they may balance nothing but the
/// rounding of a singular W.
constexpr double trusted = 1e-9;

double hidden_part(const ContactSystem& system, const ContactIterate& iterate) {
  double largest = 0.0;
  for (const ContactPoint& point : system.points())
    largest = std::max(largest, sum_rounding * iterate.size[point.row] / std::sqrt(point.diagonal));
  return largest / system.data();
}
}  // namespace

/// Maps the factor, which has rows of another selection of points, to this system.
void PrimalDualActiveSet::renumber(const ContactSystem& system) {
  renumbered_.clear();
  for (const Index row : base_) {
    const Index found = system.system_row(row);
    if (found < 0) {
      reset();
      return;
    }
    renumbered_.push_back(found);
  }
  if (!has_base_to_factor_) return factor_.renumber_base(renumbered_);
  if (!factor_.set_base(*system.dense(), renumbered_)) return reset();
  has_base_to_factor_ = false;
}

/// Solves W_AA r_A = −q_A for r on the active points, with one refinement, and evaluates u everywhere.
bool PrimalDualActiveSet::solve_active(const ContactSystem& system, ContactIterate& current) {
  if (!factor_.set_indices(*system.dense(), indices_)) {
    reset();  // the factor has lost its base
    return false;
  }
  const auto count = Index(indices_.size());
  right_.resize(count);
  current.reaction.setZero(system.rows());
  current.motion = system.offset();
  for (int pass = 0; pass < 2; ++pass) {
    for (Index i = 0; i < count; ++i) right_[i] = -current.motion[indices_[std::size_t(i)]];
    factor_.solve(right_, solution_);
    for (Index i = 0; i < count; ++i) current.reaction[indices_[std::size_t(i)]] += solution_[i];
    system.evaluate(current);
  }
  return solution_.allFinite();
}

void PrimalDualActiveSet::find_violations(const ContactSystem& system, const ContactIterate& current) {
  violations_.clear();
  for (std::size_t k = 0; k < system.points().size(); ++k) {
    const ContactPoint& point = system.points()[k];
    const bool wrong = active_[k] != 0 ? current.reaction[point.row] < 0.0
                                       : current.motion[point.row] < -system.floor_of(point, current).normal;
    if (wrong) violations_.push_back(k);
  }
}

std::string PrimalDualActiveSet::solve(const ContactSystem& system, double tolerance, ContactIterate& current,
                                       int& iterations, int& factorizations, const Watch& watch) {
  start_ = current;
  renumber(system);
  const std::string reason = pivot(system, current, iterations, factorizations, watch);
  const bool solved = reason.empty() && system.is_solved(current, std::max(tolerance, loosest_residual));
  const double hidden = solved ? hidden_part(system, current) : std::numeric_limits<double>::infinity();
  if (hidden <= trusted) return "";
  // From any result of pivoting: a few steps lead to the solution from its starting point.
  std::swap(current, start_);
  const std::string why = dependent_.solve(system, current, iterations);
  if (solved && dependent_.contradiction().empty() && !(why.empty() && hidden_part(system, current) < hidden)) {
    std::swap(current, start_);
    return "";
  }
  if (watch) watch(current);
  return why;
}

std::string PrimalDualActiveSet::pivot(const ContactSystem& system, ContactIterate& current, int& iterations,
                                       int& factorizations, const Watch& watch) {
  const std::vector<ContactPoint>& points = system.points();
  active_.assign(points.size(), 0);
  if (current.reaction.isZero(0.0)) {
    find_violations(system, current);
    for (const std::size_t k : violations_) active_[k] = 1;
  } else {
    for (std::size_t k = 0; k < points.size(); ++k) active_[k] = current.reaction[points[k].row] > 0.0 ? 1 : 0;
  }
  const int limit = 1000 + 20 * int(points.size());
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int blocks_left = block_patience;
  for (int k = 0; k < limit; ++k) {
    indices_.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (active_[i] != 0) indices_.push_back(points[i].row);
    }
    ++iterations;
    if (!solve_active(system, current))
      return "the contact operator is not positive definite: contact conditions depend on one another";
    if (factor_.has_factored()) {
      ++factorizations;
      base_.clear();
      for (const Index row : factor_.base()) base_.push_back(system.problem_row(row));
    }
    if (watch) watch(current);
    find_violations(system, current);
    if (violations_.empty()) return "";
    if (violations_.size() < fewest) {
      fewest = violations_.size();
      blocks_left = block_patience;
    } else if (blocks_left > 0) {
      --blocks_left;
    }
    if (blocks_left > 0) {
      for (const std::size_t i : violations_) active_[i] ^= 1;
    } else {
      active_[violations_.back()] ^= 1;
    }
  }
  return "the active set still changes at the iteration limit";
}

namespace {

/// Without friction PrimalDualActiveSet; with friction in two dimensions full Alart–Curnier steps, which are an active
/// set method over open, stick and slip to either side.
class ActiveSetSolver final : public IterativeContactSolver {
 protected:
  [[nodiscard]] bool works_on_candidates() const override { return true; }
  void forget() override {
    frictionless_.reset();
    step_.reset();
  }
  [[nodiscard]] std::string refuses(const ContactSystem& system) const override {
    if (system.dense() == nullptr) return "the active set method needs a dense W";
    for (const ContactPoint& point : system.points()) {
      if (point.size > 2)
        return "the active set method supports friction in two dimensions only, where slip has two directions";
    }
    return "";
  }
  std::string iterate(const ContactSystem& system, const ContactOptions& options, ContactIterate& current,
                      ContactSolution& solution) override;

 private:
  PrimalDualActiveSet frictionless_;
  AlartCurnierStep step_;
  ContactIterate next_;
};

std::string ActiveSetSolver::iterate(const ContactSystem& system, const ContactOptions& options,
                                     ContactIterate& current, ContactSolution& solution) {
  bool friction = false;
  for (const ContactPoint& point : system.points()) friction = friction || point.has_friction();
  if (!friction) {
    const std::string reason =
        frictionless_.solve(system, options.tolerance, current, solution.newton_steps, solution.factorizations);
    if (!reason.empty()) solution.contradiction = frictionless_.contradiction();
    note_iteration(system, options, "active set", system.residual(current), current.reaction, solution);
    return reason;
  }
  const int limit = options.iteration_limit > 0 ? options.iteration_limit : 100;
  for (int k = 0; k < limit; ++k) {
    if (system.is_solved(current, options.tolerance)) return "";
    ++solution.newton_steps;
    if (!step_.step(system, current, next_.reaction)) return "the system of the active points is singular";
    if (step_.has_factored()) ++solution.factorizations;
    system.evaluate(next_);
    if (step_.refine(next_, next_.reaction)) system.evaluate(next_);
    std::swap(current, next_);
    note_iteration(system, options, "active set", system.residual(current), current.reaction, solution);
  }
  return "the states of the points still change at the iteration limit";
}

}  // namespace

ContactSolverRegistration active_set_solver() {
  return {"active-set",
          {[] { return std::make_unique<ActiveSetSolver>(); },
           "primal-dual active set: without friction, and with friction in two dimensions"}};
}

}  // namespace ricochet
