#pragma once

#include <map>
#include <string>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/model/model.hpp"

/// @file Which run a checkpoint belongs to. A run goes on only with what would have given the same results so far.
namespace ricochet {

/// The values of a case that decide its results (key path → value as text, defaults included): not its title, its
/// end, what it expects, how often checkpoints are written, nor where its mesh file lies, whose content is compared.
[[nodiscard]] std::map<std::string, std::string> deciding_values(const Case& input);

void save_identity(const Case& input, const Model& model, Snapshot& snapshot);

/// Throws Error(invalid_input) that names the version, or the entries of the case with both values, that differ from
/// what ran before. `before` names that run in the message.
void require_same_case(const Case& input, const std::string& version_before,
                       const std::map<std::string, std::string>& values_before, const std::string& before);
void require_same_case(const Case& input, const Snapshot& snapshot, const std::string& before);
/// Throws Error(invalid_input) that says what of the mesh differs. Returns a warning, or nothing: with other libraries
/// or another processor results agree to rounding only.
[[nodiscard]] std::string compare_model(const Case& input, const Model& model, const Snapshot& snapshot);

}  // namespace ricochet
