#include "ricochet/solver/step_solver.hpp"

#include <fmt/format.h>

#include "ricochet/base/log.hpp"
#include "ricochet/base/memory.hpp"
#include "ricochet/base/timer.hpp"
#include "ricochet/solver/stage_solver.hpp"

namespace ricochet {

namespace {

/// Part of the machine's memory that factors may take. While one is made, half as much again is needed.
constexpr double memory_part = 0.5;
/// Of a factorization: some ten minutes of one core. Reading a factor that takes longer to make is slower, too, than
/// the iterations of most time steps.
constexpr double most_operations = 2e13;

class StagesStepSolver final : public StepSolver {
 public:
  StagesStepSolver(const SemidiscreteProblem& problem, const std::vector<OperatorCoefficients>& operators,
                   const StepSolverOptions& options) {
    for (const OperatorCoefficients& coefficients : operators) add_stage(problem, coefficients, options);
  }

  void solve(std::size_t number, const Stage& stage, StageSolution& solution) override {
    stages_.at(number)->solve(stage, solution);
  }
  void observe_contact(const ContactObserver& observer) override {
    for (const auto& stage : stages_) stage->observe_contact(observer);
  }
  [[nodiscard]] double contact_seconds() const override {
    double sum = 0.0;
    for (const auto& stage : stages_) sum += stage->contact_seconds();
    return sum;
  }
  [[nodiscard]] std::size_t factor_entries() const override {
    std::size_t sum = 0;
    for (const auto& stage : stages_) sum += stage->factor_entries();
    return sum;
  }
  void save(Snapshot& snapshot, const std::string& name) const override {
    for (std::size_t i = 0; i < stages_.size(); ++i) stages_[i]->save(snapshot, fmt::format("{}.{}", name, i));
  }
  void load(const Snapshot& snapshot, const std::string& name) override {
    for (std::size_t i = 0; i < stages_.size(); ++i) stages_[i]->load(snapshot, fmt::format("{}.{}", name, i));
  }
  [[nodiscard]] const std::vector<ChosenMethod>& methods() const override { return methods_; }

 private:
  void add_stage(const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients,
                 const StepSolverOptions& options) {
    ChosenMethod chosen{.method = options.method};
    // The contact dofs alone are few, and their matrix has no inertia that would help an iteration.
    if (coefficients.dofs == StageDofs::contact) chosen.method = SolverMethod::direct;
    AnalysedOperator analysed;
    Timer timer;
    if (chosen.method != SolverMethod::iterative) {
      analysed = analyse_operator(problem, coefficients);
      chosen.ordering_seconds = timer.restart();
      decide(analysed.factor.predicted(), options, chosen);
    }
    if (chosen.method == SolverMethod::direct) {
      stages_.push_back(make_direct_stage(problem, coefficients, std::move(analysed), options));
      chosen.factorization_seconds = timer.seconds();
    } else {
      analysed = {};
      stages_.push_back(make_iterative_stage(problem, coefficients, options));
    }
    methods_.push_back(chosen);
  }

  static void decide(const SparseCholesky::Prediction& predicted, const StepSolverOptions& options,
                     ChosenMethod& chosen) {
    chosen.predicted_entries = predicted.entries;
    chosen.predicted_operations = predicted.operations;
    if (chosen.method != SolverMethod::automatic) return;
    const double limit = options.memory > 0.0 ? options.memory : memory_part * physical_memory();
    const bool fits = predicted.possible && sizeof(double) * predicted.entries <= limit;
    chosen.method = fits && predicted.operations <= most_operations ? SolverMethod::direct : SolverMethod::iterative;
    if (chosen.method == SolverMethod::iterative) {
      log::info(fmt::format("solved by iterations: a factor would take {:.2g} GB and {:.2g} operations to make",
                            1e-9 * sizeof(double) * predicted.entries, predicted.operations));
    }
  }

  std::vector<std::unique_ptr<StageSolver>> stages_;
  std::vector<ChosenMethod> methods_;
};

}  // namespace

std::unique_ptr<StepSolver> make_step_solver(const SemidiscreteProblem& problem,
                                             const std::vector<OperatorCoefficients>& operators,
                                             const StepSolverOptions& options) {
  return std::make_unique<StagesStepSolver>(problem, operators, options);
}

}  // namespace ricochet
