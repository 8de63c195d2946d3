#pragma once

#include <memory>

#include "ricochet/solver/stage/stage_solver.hpp"

/// @file A stage of several ranks on the dofs of contact nodes.
namespace ricochet {

class GatheredContact;

/// Stage on the dofs of contact nodes on several ranks, with a factor on one of them. Keeps a reference to `gathered`.
[[nodiscard]] std::unique_ptr<StageSolver> make_gathered_stage(const SemidiscreteProblem& problem,
                                                               const OperatorCoefficients& coefficients,
                                                               SharedContact& shared, GatheredContact& gathered);

}  // namespace ricochet
