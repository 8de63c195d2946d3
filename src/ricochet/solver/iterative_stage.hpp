#pragma once

#include <memory>

#include "ricochet/solver/stage/stage_solver.hpp"

/// @file Stages that are solved by conjugate gradients.
namespace ricochet {

class GatheredContact;

/// Conjugate gradients on all dofs around a direct solve near the contact. `gathered`, to which a reference is kept, is
/// required on several ranks with contact on some; `condensed_stage` is then at its root.
[[nodiscard]] std::unique_ptr<StageSolver> make_iterative_stage(const SemidiscreteProblem& problem,
                                                                const OperatorCoefficients& coefficients,
                                                                const StepSolverOptions& options, SharedContact& shared,
                                                                FactoredStage* condensed_stage = nullptr,
                                                                GatheredContact* gathered = nullptr);

}  // namespace ricochet
