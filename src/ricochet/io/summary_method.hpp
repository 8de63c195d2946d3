#pragma once

#include "ricochet/base/json.hpp"
#include "ricochet/io/summary.hpp"

/// @file What the method did, as entries of summary.json: the budget of energy, the reactions that acted, and what
/// steps took. Not part of the public interface.
namespace ricochet {

/// What there was, what the method has lost and created, and what each has come to at the end; null in results of a
/// version that did not tell.
[[nodiscard]] Json energy_budget_to_json(const RunSummary& summary);
/// Null where the scheme has no choice.
[[nodiscard]] Json reactions_to_json(const RunSummary& summary);
/// Null where all steps are of one length.
[[nodiscard]] Json adaptive_steps_to_json(const RunSummary& summary);
/// Contacts that slide far, of which held steps have left points at a gap; an empty list if there is none.
[[nodiscard]] Json unsettled_contacts_to_json(const RunSummary& summary);
/// Null where there is one.
[[nodiscard]] Json processes_to_json(const RunSummary& summary);
/// Null where steps are solved directly.
[[nodiscard]] Json iterations_to_json(const RunSummary& summary);
/// Reads those that the summary has. Throws Json::Exception.
void read_method(const Json& json, RunSummary& summary);

}  // namespace ricochet
