#pragma once

#include <string>
#include <vector>

/// @file Names a case file may use that other parts of the program define.
namespace ricochet {

/// The time schemes, in the order in which messages and documentation list them: the registry of scheme/registry.cpp,
/// declared here again so that the table of keys need not see what a scheme is.
[[nodiscard]] std::vector<std::string> scheme_names();

/// Columns of history.csv that every run may have; vectors are listed with all their components. No probe may be named
/// like one of them.
[[nodiscard]] inline std::vector<std::string> history_column_names() {
  std::vector<std::string> names{"step",
                                 "time",
                                 "kinetic_energy",
                                 "elastic_energy",
                                 "load_potential",
                                 "load_work",
                                 "algorithmic_energy",
                                 "total_energy",
                                 "contact_work",
                                 "friction_work",
                                 "support_work",
                                 "obstacle_work",
                                 "damping_work",
                                 "numerical_dissipation",
                                 "energy_residual",
                                 "max_rotation",
                                 "active_contacts",
                                 "sticking",
                                 "slipping",
                                 "max_penetration",
                                 "iterations"};
  for (const char* vector : {"contact_force", "momentum", "angular_momentum"}) {
    for (const char* component : {"", "_x", "_y", "_z"}) names.push_back(std::string(vector) + component);
  }
  return names;
}

}  // namespace ricochet
