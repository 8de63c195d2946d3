#pragma once

#include <memory>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/gathered_contact.hpp"
#include "ricochet/solver/near_contact.hpp"
#include "ricochet/solver/points_nearby.hpp"

/// @file The contact zones of a body that is divided among ranks, gathered on one of them.
namespace ricochet {

class FactoredStage;

/// The ranks send what A has near the contact, once for each set of zones, and in every round the residual there and
/// the gaps of their points; back come the motion and the reactions. `layer`: at home, of `contact.nodes()`. Keeps
/// references to all but the coefficients.
[[nodiscard]] std::unique_ptr<NearContact> make_gathered_zones(
    const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients, const std::vector<char>& solved,
    const StageProduct& product, PointsNearby& nearby, bool all_points, GatheredContact& contact, FactoredStage* layer);

/// Parts of a symmetric matrix on the dofs of these nodes (ascending; on all ranks those of `gathered`), added up at
/// home on all dofs there; elsewhere empty.
[[nodiscard]] SparseMatrix gather_matrix(const Ranks& ranks, const SparseMatrix& on_nodes,
                                         const std::vector<Index>& nodes, int d, const GatheredNodes& gathered);

}  // namespace ricochet
