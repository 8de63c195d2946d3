#pragma once

#include <memory>

#include "ricochet/problem/semidiscrete_problem.hpp"
#include "ricochet/solver/gathered/gathered_contact.hpp"
#include "ricochet/solver/subdomain/contact_neighbourhood.hpp"
#include "ricochet/solver/subdomain/contact_region.hpp"

/// @file Contact subdomains of a body that is divided among ranks.
namespace ricochet {

class FactoredStage;

/// Subdomains have roots, the ranks that solve them: the first one has `contact`; with several subdomains others take
/// their share, those with most contact points first. The ranks send A near the contact, once for each set of
/// subdomains, and in every iteration the residual there and the gaps of their points; they receive the motion and the
/// reactions. `condensed_stage` is at the first root, on `contact.nodes()`; there is a single subdomain then. Keeps
/// references to everything except the coefficients.
[[nodiscard]] std::unique_ptr<ContactRegion> make_gathered_subdomains(
    const SemidiscreteProblem& problem, const OperatorCoefficients& coefficients, const std::vector<char>& solved,
    const StageProduct& product, ContactNeighbourhood& neighbourhood, SharedContact& shared, GatheredContact& contact,
    FactoredStage* condensed_stage);

}  // namespace ricochet
