#pragma once

#include "ricochet/io/contact_export.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/model/model.hpp"
#include "ricochet/simulation/simulation.hpp"

/// @file What a run is, in words and numbers, before it has run.
namespace ricochet {

/// The contacts of a case as a summary lists them; of contacts between bodies without how they face each other.
[[nodiscard]] std::vector<ContactDescription> describe_contacts(const Case& input);
/// None of a contact with an obstacle, or of tied surfaces.
[[nodiscard]] std::optional<FacingDescription> describe_facing(const Model& model, std::size_t contact);

[[nodiscard]] RunSummary describe_run(const Case& input, const Model& model, const Scheme& scheme,
                                      const Simulation& simulation);

/// Where exported contact problems come from.
[[nodiscard]] ContactProvenance describe_provenance(const Case& input, const RunSummary& summary);

}  // namespace ricochet
