#include "ricochet/solver/choose_method.hpp"

#include "ricochet/base/memory.hpp"

namespace ricochet {

namespace {

/// Part of the machine's memory that factors may take. While one is made, half as much again is needed.
constexpr double memory_part = 0.5;
/// Of a factorization: some ten minutes of one core. Reading a factor that takes longer to make is slower, too, than
/// the iterations of most time steps.
constexpr double most_operations = 2e13;

}  // namespace

ChosenMethod choose_method(const SparseCholesky::Prediction& predicted, const OperatorCoefficients& coefficients,
                           const StepSolverOptions& options) {
  ChosenMethod chosen{
      .method = options.method, .predicted_entries = predicted.entries, .predicted_operations = predicted.operations};
  // The contact dofs alone are few, and their matrix has no inertia that would help an iteration.
  if (coefficients.dofs == StageDofs::contact) chosen.method = SolverMethod::direct;
  if (chosen.method != SolverMethod::automatic) return chosen;
  const double limit = options.memory > 0.0 ? options.memory : memory_part * physical_memory();
  const bool fits = predicted.possible && sizeof(double) * predicted.entries <= limit;
  chosen.method = fits && predicted.operations <= most_operations ? SolverMethod::direct : SolverMethod::iterative;
  return chosen;
}

}  // namespace ricochet
