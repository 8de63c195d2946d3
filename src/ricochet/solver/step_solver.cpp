#include "ricochet/solver/step_solver.hpp"

#include <fmt/format.h>
#include <stdexcept>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/solver/choose_method.hpp"
#include "ricochet/solver/corotated/corotated_stage.hpp"
#include "ricochet/solver/delassus/direct_stage.hpp"
#include "ricochet/solver/gathered/gathered_contact.hpp"
#include "ricochet/solver/gathered/gathered_stage.hpp"
#include "ricochet/solver/iterative_stage.hpp"
#include "ricochet/solver/stage_newton.hpp"
#include "ricochet/solver/step_estimate.hpp"
#include "ricochet/solver/tangent_iterations.hpp"

namespace ricochet {

namespace {

constexpr const char* methods_entry = "methods";  ///< of a snapshot

/// Operations from which a factorization takes seconds and is announced.
constexpr double long_factorization = 1e11;

constexpr const char* kept = "as at the beginning of the run";

void log_factorization(const ChosenMethod& chosen, std::size_t unknowns) {
  if (chosen.predicted_operations < long_factorization) return;
  log::info(fmt::format("factorizing an operator of {} unknowns: {:.3g} entries ({:.2g} GB), {:.2g} operations ({})",
                        unknowns, chosen.predicted_entries, 1e-9 * sizeof(double) * chosen.predicted_entries,
                        chosen.predicted_operations, chosen.reason));
}

void log_iterations(const ChosenMethod& chosen) {
  log::info(fmt::format("solved by iterations: {} (a factor of {:.2g} GB would take {:.2g} operations)", chosen.reason,
                        1e-9 * sizeof(double) * chosen.predicted_entries, chosen.predicted_operations));
}

class StagesStepSolver final : public StepSolver {
 public:
  StagesStepSolver(const SemidiscreteProblem& problem, const std::vector<OperatorCoefficients>& operators,
                   const StepSolverOptions& options)
      : problem_(problem),
        operators_(operators),
        shared_{.all_points = options.all_points},
        tangent_iterations_(problem),
        newton_(problem),
        debts_(Vector::Zero(Index(operators.size()) * FactorDebt::numbers)) {
    if (!problem.internal_force->is_linear()) frame_ = std::make_unique<CorotatedFrame>(problem);
    const bool is_divided = problem.ranks->are_several();
    if (is_divided && problem.ranks->any(problem.contact.size() > 0))
      gathered_ = std::make_unique<GatheredContact>(problem);
    for (const OperatorCoefficients& coefficients : operators) {
      if (is_divided) {
        add_divided_stage(problem, coefficients, options);
      } else {
        add_stage(problem, coefficients, options);
      }
    }
    find_renewal_price();
  }

  void solve(std::size_t number, Stage& stage, StageSolution& solution) override {
    StageSolver& solver = *stages_.at(number);
    const auto solve_linear = [&](const Stage& linear, StageSolution& result) {
      solver.solve(linear.linear(), result);
    };
    if (stage.linearization.displacement.size() > 0) {
      rotate_operators(stage.linearization.displacement);
      const auto renew = [this](const Vector& displacement) { renew_operators(displacement, displacement); };
      FactorDebt debt(debts_.segment(Index(number) * FactorDebt::numbers, FactorDebt::numbers));
      newton_.solve({operators_[number], renewal_price_, solve_linear, renew, debt}, stage, solution);
    } else {
      solve_linear(stage, solution);
      if (stage.motion) tangent_iterations_.follow_motion(solver, stage, solution);
      solution.newton_iterations = 1;
    }
    solver.show_contact();
  }
  void refactorize(std::size_t number, const Vector& displacement) override {
    stages_.at(number)->refactorize(displacement);
  }
  void renew_operators(const Vector& displacement, const Vector& of_contact_nodes) override {
    log::debug("new factors of all stages");
    debts_.setZero();
    if (problem_.pressure) factor_pressure_ = problem_.pressure->last();
    if (!make_factors(displacement, of_contact_nodes) && !leave_pressure_out(displacement, of_contact_nodes) &&
        !go_part_way(displacement, of_contact_nodes)) {
      log::debug("factors of the undeformed body");
      factor_displacement_.resize(0);
      contact_factor_displacement_.resize(0);
      refactorize_all(factor_displacement_, factor_displacement_);
    }
    if (!frame_) return;
    frame_->restart(factor_displacement_);
    frame_->follow(displacement);
  }
  [[nodiscard]] double renewal_price() const override { return renewal_price_; }
  void rotate_operators(const Vector& displacement) override {
    if (frame_) frame_->follow(displacement);
  }
  void observe_contact(const ContactObserver& observer) override { shared_.observer = observer; }
  [[nodiscard]] double contact_seconds() const override { return shared_.solver_seconds; }
  [[nodiscard]] std::size_t factor_entries() const override { return shared_.factor_entries; }
  [[nodiscard]] IterationCounts iteration_counts() const override {
    IterationCounts sum;
    for (const auto& stage : stages_) sum += stage->iteration_counts();
    return sum;
  }
  void persist(const SnapshotVisitor& visit) override {
    if (!visit.loads()) {  // saved_methods() loads them, before the stages are made
      std::vector<SolverMethod> methods;
      for (const ChosenMethod& chosen : methods_) methods.push_back(chosen.method);
      visit(methods_entry, methods);
    }
    if (frame_) persist_factors(visit);
    for (std::size_t i = 0; i < stages_.size(); ++i) stages_[i]->persist(visit.part(i));
  }
  [[nodiscard]] const std::vector<ChosenMethod>& methods() const override { return methods_; }

 private:
  /// The factors are made again with the pressure of their forces; the last forces may have another one.
  void persist_factors(const SnapshotVisitor& visit) {
    const FollowerPressure* const pressure = problem_.pressure.get();
    Vector made_at = factor_displacement_, contact_made_at = contact_factor_displacement_;
    visit("made_at", made_at, 0, problem_.dof_count());
    visit("contact_made_at", contact_made_at, made_at.size());
    Vector debts = debts_;
    visit("factor_debts", debts, debts_.size());
    FollowerPressure::Instant last;
    if (pressure != nullptr) {
      last = pressure->last();
      visit.numbers("pressure_at", factor_pressure_.time, factor_pressure_.part, last.time, last.part);
      if (visit.loads()) pressure->set_last(factor_pressure_);
    }
    if (visit.loads() && made_at.size() > 0) renew_operators(made_at, contact_made_at);
    debts_ = debts;
    if (visit.loads() && pressure != nullptr) pressure->set_last(last);
    frame_->persist(visit.part("frame"));
  }
  /// Returns false if an operator is not positive definite.
  bool make_factors(const Vector& displacement, const Vector& of_contact_nodes) {
    try {
      refactorize_all(displacement, of_contact_nodes);
    } catch (const Error& problem) {
      if (problem.kind() != ErrorKind::invalid_input) throw;
      return false;
    }
    factor_displacement_ = displacement;
    contact_factor_displacement_ = of_contact_nodes;
    return true;
  }
  /// The stiffness of a pressure is symmetric except at the edges of its surface; the contribution of these has no
  /// sign, and may push a body that only contact holds.
  bool leave_pressure_out(const Vector& displacement, const Vector& of_contact_nodes) {
    if (!problem_.pressure) return false;
    factor_pressure_.part = 0.0;
    problem_.pressure->set_last(factor_pressure_);
    return make_factors(displacement, of_contact_nodes);
  }
  /// The tangent of a body squeezed against an obstacle may be indefinite, as contact is not part of it; with a part of
  /// the strains it is not.
  bool go_part_way(const Vector& displacement, const Vector& of_contact_nodes) {
    Vector strained, contact_strained;
    for (const double part : {0.75, 0.5, 0.25}) {
      frame_->scale_strains(displacement, part, strained);
      frame_->scale_strains(of_contact_nodes, part, contact_strained);
      if (make_factors(strained, contact_strained)) {
        log::debug(fmt::format("factors with {:.2g} of the strains", part));
        return true;
      }
    }
    return false;
  }
  /// Refactorizes in order: a stage of contact nodes precedes the stage that refers to it.
  void refactorize_all(const Vector& displacement, const Vector& of_contact_nodes) {
    for (std::size_t i = 0; i < stages_.size(); ++i)
      stages_[i]->refactorize(operators_[i].dofs == StageDofs::contact ? of_contact_nodes : displacement);
  }
  [[nodiscard]] FactoredStage* condensed_stage_of(const OperatorCoefficients& coefficients) const {
    const int number = coefficients.condensed_operator;
    return number >= 0 ? stages_.at(std::size_t(number))->factored() : nullptr;
  }
  /// Adds a stage of a body on several ranks, which has a factor only on the dofs of contact nodes.
  void add_divided_stage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                         const StepSolverOptions& options) {
    if (coefficients.dofs == StageDofs::contact) {
      stages_.push_back(make_gathered_stage(problem, coefficients, shared_, *gathered_));
      methods_.push_back({.method = SolverMethod::direct, .reason = "solved on one of the processes"});
      return;
    }
    FactoredStage* const condensed_stage = condensed_stage_of(coefficients);
    stages_.push_back(make_iterative_stage(problem, coefficients, options, shared_, condensed_stage, gathered_.get()));
    const std::string kind = options.preconditioner == "auto" ? "" : ", preconditioned by " + options.preconditioner;
    methods_.push_back({.method = SolverMethod::iterative, .reason = "the body is divided among processes" + kind});
  }
  void add_stage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                 const StepSolverOptions& options) {
    const SolverMethod before = options.chosen.empty() ? SolverMethod::automatic : options.chosen[methods_.size()];
    ChosenMethod chosen{.method = options.method, .reason = "requested by the case"};
    AnalysedOperator analysed;
    Timer timer;
    if (options.method == SolverMethod::automatic && before == SolverMethod::iterative) {
      chosen.method = before;
      chosen.reason = kept;
      log::info("solved by iterations, as at the beginning of the run");
    } else if (chosen.method != SolverMethod::iterative || coefficients.dofs == StageDofs::contact) {
      analysed = analyse_operator(problem, coefficients);
      chosen = choose_method(problem, analysed.factor.predicted(), coefficients, options);
      if (before == SolverMethod::direct && chosen.method != before) {
        chosen.method = before;
        chosen.reason = kept;
      }
      chosen.ordering_seconds = timer.restart();
      if (chosen.method == SolverMethod::iterative) log_iterations(chosen);
    }
    FactoredStage* const condensed_stage = condensed_stage_of(coefficients);
    if (coefficients.condensed_operator >= 0 && condensed_stage == nullptr)
      throw std::logic_error("the contact nodes of a stage need a factor, but their operator is solved by iterations");
    if (chosen.method == SolverMethod::direct) {
      log_factorization(chosen, analysed.dofs.size());
      stages_.push_back(make_direct_stage(problem, coefficients, std::move(analysed), shared_, condensed_stage));
      chosen.factorization_seconds = timer.seconds();
    } else {
      analysed = {};
      stages_.push_back(make_iterative_stage(problem, coefficients, options, shared_, condensed_stage));
    }
    if (frame_) stages_.back() = make_corotated_stage(std::move(stages_.back()), *frame_);
    methods_.push_back(chosen);
  }

  /// Counts at fixed rates, so that results do not depend on the load of the machine. Forces count as those of the
  /// whole body: where a scheme evaluates those of the cells at contact nodes alone, factors are renewed a little
  /// early.
  void find_renewal_price() {
    if (problem_.internal_force->is_linear()) return;
    // An iteration evaluates D, f(u₁) and the loads; a tangent took 25 to 35 times as long as D on tetrahedra and
    // hexahedra.
    constexpr double forces_per_iteration = 3.0, forces_per_tangent = 30.0;
    const double force = problem_.internal_force->estimated_seconds();
    double factors = forces_per_tangent * force, iteration = forces_per_iteration * force;
    for (const ChosenMethod& chosen : methods_) {
      factors += chosen.predicted_operations / estimated_operations_per_second;
      iteration += 2.0 * sizeof(double) * chosen.predicted_entries / estimated_bytes_per_second;
    }
    renewal_price_ = factors / iteration;
    log::debug(fmt::format("new factors of all stages cost as much as {:.3g} iterations", renewal_price_));
  }

  const SemidiscreteProblem& problem_;
  std::vector<OperatorCoefficients> operators_;
  double renewal_price_ = 0.0;
  SharedContact shared_;
  std::unique_ptr<CorotatedFrame> frame_;  ///< null if the internal force is linear
  Vector factor_displacement_,
      contact_factor_displacement_;            ///< displacement of the factors; empty: the undeformed body
  FollowerPressure::Instant factor_pressure_;  ///< likewise
  TangentIterations tangent_iterations_;
  StageNewton newton_;
  Vector debts_;                               ///< numbers of a FactorDebt per operator
  std::unique_ptr<GatheredContact> gathered_;  ///< on several ranks with contact
  std::vector<std::unique_ptr<StageSolver>> stages_;
  std::vector<ChosenMethod> methods_;
};

}  // namespace

std::vector<SolverMethod> saved_methods(const SnapshotVisitor& saved,
                                        const std::vector<OperatorCoefficients>& operators) {
  std::vector<SolverMethod> methods;
  saved(methods_entry, methods, {std::int64_t(SolverMethod::direct), std::int64_t(SolverMethod::iterative)});
  saved.require(methods.size() == operators.size(), methods_entry, "belongs to another number of operators");
  for (std::size_t i = 0; i < methods.size(); ++i)
    saved.require(operators[i].dofs != StageDofs::contact || methods[i] == SolverMethod::direct, methods_entry,
                  "solves contact nodes by iterations");
  return methods;
}

std::unique_ptr<StepSolver> make_step_solver(const SemidiscreteProblem& problem,
                                             const std::vector<OperatorCoefficients>& operators,
                                             const StepSolverOptions& options) {
  return std::make_unique<StagesStepSolver>(problem, operators, options);
}

}  // namespace ricochet
