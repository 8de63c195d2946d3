#pragma once

#include <memory>

#include "ricochet/solver/stage/stage_solver.hpp"

/// @file Stages that are solved by conjugate gradients.
namespace ricochet {

class GatheredContact;

/// Conjugate gradients on all dofs around a direct solve near the contact. `gathered`: where there are several ranks,
/// and contact on some; kept. The layer is then that of its home.
[[nodiscard]] std::unique_ptr<StageSolver> make_iterative_stage(const SemidiscreteProblem& problem,
                                                                const OperatorCoefficients& coefficients,
                                                                const StepSolverOptions& options,
                                                                FactoredStage* layer = nullptr,
                                                                GatheredContact* gathered = nullptr);

}  // namespace ricochet
