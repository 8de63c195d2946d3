#pragma once

#include <memory>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/gathered/gathered_contact.hpp"
#include "ricochet/solver/subdomain/near_contact.hpp"
#include "ricochet/solver/subdomain/points_nearby.hpp"

/// @file The contact zones of a body that is divided among ranks.
namespace ricochet {

class FactoredStage;

/// Zones have homes, the ranks that solve them: the first one has `contact`, and where there are several zones others,
/// those with most contact points first, take their share. The ranks send what A has near the contact, once for each
/// set of zones, and in every round the residual there and the gaps of their points; back come the motion and the
/// reactions. `layer`: at the first home, of `contact.nodes()`; all is one zone then. Keeps references to all but the
/// coefficients.
[[nodiscard]] std::unique_ptr<NearContact> make_gathered_zones(
    const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients, const std::vector<char>& solved,
    const StageProduct& product, PointsNearby& nearby, bool all_points, GatheredContact& contact, FactoredStage* layer);

}  // namespace ricochet
