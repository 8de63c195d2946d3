#pragma once

#include <map>
#include <string>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/model/model.hpp"

/// @file Identity of the run to which a checkpoint belongs. A run resumes only with input that would have given the
/// same results so far.
namespace ricochet {

/// Returns the values of a case that decide its results (key path → value as text, defaults included). Title, end,
/// expectations, intervals of checkpoints and the path of the mesh file are excluded; the contents of the mesh are
/// compared instead.
[[nodiscard]] std::map<std::string, std::string> deciding_values(const Case& input);

void save_identity(const Case& input, const Model& model, Snapshot& snapshot);

/// Throws Error(invalid_input) that names the version, or the entries of the case with both values, that differ from
/// the earlier run. `before` names that run in the message.
void require_same_case(const Case& input, const std::string& version_before,
                       const std::map<std::string, std::string>& values_before, const std::string& before);
void require_same_case(const Case& input, const Snapshot& snapshot, const std::string& before);
/// Throws Error(invalid_input) that states which parts of the mesh differ. Returns a warning, or "": with other
/// libraries or another processor, results agree up to rounding only.
[[nodiscard]] std::string compare_model(const Case& input, const Model& model, const Snapshot& snapshot);

}  // namespace ricochet
