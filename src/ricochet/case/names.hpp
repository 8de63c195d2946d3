#pragma once

#include <string>
#include <vector>

#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "ricochet/fem/material_law.hpp"
#include "ricochet/io/fields/field_source.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/rigid/obstacle.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "ricochet/simulation/history/history.hpp"

/// @file Names in case files that are defined by other parts of the program: scheme_names(), mass_names(),
/// multiplier_space_names() and field_names() come from their registries, so that registration suffices to make a name
/// valid in a case.
namespace ricochet {

/// Columns of history.csv that any run may have, in 2D or 3D. Probes must not have these names.
[[nodiscard]] inline std::vector<std::string> history_column_names() {
  std::vector<std::string> names = names_of(HistoryRecorder::standard_columns(2));
  for (std::string& name : names_of(HistoryRecorder::standard_columns(3))) names.push_back(std::move(name));
  for (std::string& name : names_of(HistoryRecorder::finite_strain_columns())) names.push_back(std::move(name));
  for (std::string& name : names_of(HistoryRecorder::relaxation_columns())) names.push_back(std::move(name));
  for (std::string& name : names_of(HistoryRecorder::sliding_columns(true))) names.push_back(std::move(name));
  return names;
}

/// Value of time.step that selects adaptive step lengths.
inline constexpr const char* adaptive_steps = "adaptive";

}  // namespace ricochet
