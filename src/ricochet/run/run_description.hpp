#pragma once

#include "ricochet/io/contact_export.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/simulation/simulation.hpp"

/// @file Description of a run, in words and numbers, before its steps.
namespace ricochet {

/// Returns the contacts of a case as listed in the summary, without the facing of bodies.
[[nodiscard]] std::vector<ContactDescription> describe_contacts(const Case& input);
/// Returns how the sides of a contact face each other; none for obstacles and tied surfaces.
[[nodiscard]] std::optional<PairingDescription> describe_facing(const Model& model, std::size_t contact);

[[nodiscard]] RunSummary describe_run(const Case& input, const Model& model, const Scheme& scheme,
                                      const Simulation& simulation);

/// Returns the origin of exported contact problems.
[[nodiscard]] ContactProvenance describe_provenance(const Case& input, const RunSummary& summary);

}  // namespace ricochet
