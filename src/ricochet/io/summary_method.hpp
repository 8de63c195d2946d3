#pragma once

#include "ricochet/base/json.hpp"
#include "ricochet/io/summary.hpp"

/// @file Numerical method in summary.json: energy budget, acting reactions, and the cost of steps. Not part of the
/// public interface.
namespace ricochet {

/// Total energy, losses and gains due to the method, and the contributions of all works at the end; null in older
/// results without it.
[[nodiscard]] Json energy_budget_to_json(const RunSummary& summary);
/// Null if the scheme has no choice.
[[nodiscard]] Json reactions_to_json(const RunSummary& summary);
/// Null if all steps have the same length.
[[nodiscard]] Json adaptive_steps_to_json(const RunSummary& summary);
/// Contacts with large sliding in which frozen steps have left points at a gap; an empty list if there are none.
[[nodiscard]] Json unsettled_contacts_to_json(const RunSummary& summary);
/// Null on a single process.
[[nodiscard]] Json processes_to_json(const RunSummary& summary);
/// Null if steps are solved directly.
[[nodiscard]] Json iterations_to_json(const RunSummary& summary);
/// Reads the entries that the summary contains. Throws Json::Exception.
void read_method(const Json& json, RunSummary& summary);

}  // namespace ricochet
