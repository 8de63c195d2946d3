#pragma once

#include "ricochet/base/registry.hpp"
#include "ricochet/case/keys.hpp"

/// @file Parts of the table of keys, in keys_table*.cpp. No other part of the program lists the keys of a case file.
/// Not part of the public interface.
namespace ricochet {

/// Inserts the keys of registered types into a section, behind the key that names the type.
void add_type_keys(Section& section, const std::string& type_key, std::vector<TypeKeys> types);
template <class Type>
[[nodiscard]] Section with_types(Section section, const std::string& type_key, const Registry<Type>& registry) {
  std::vector<TypeKeys> types;
  for (const Registration<Type>& entry : registry.all())
    types.push_back({entry.name, entry.keys, entry.alternatives, entry.check});
  add_type_keys(section, type_key, std::move(types));
  return section;
}

/// `kind` is "cells" or "boundary facets", `built_in` the name of all of them.
[[nodiscard]] Key group_key(const char* kind, const char* built_in);

// keys_table_bodies.cpp: bodies, their positions and initial motion.
[[nodiscard]] Section mesh_section();
[[nodiscard]] Section part_section();
[[nodiscard]] Section motion_section();
/// Returns whether the `group` of a [[contact]] represents bodies: "all" or a pattern, possibly among others.
[[nodiscard]] bool names_bodies(const TomlNode& contact);
// keys_table_model.cpp: other parts of the model.
[[nodiscard]] Section material_section();
[[nodiscard]] Section obstacle_section();
[[nodiscard]] Section contact_section();
[[nodiscard]] Section support_section();
[[nodiscard]] Section traction_section();
[[nodiscard]] Section pressure_section();
[[nodiscard]] Section load_section();
[[nodiscard]] Section initial_section();
// keys_table_method.cpp: numerical method.
[[nodiscard]] Section mass_section();
[[nodiscard]] Section time_section();
[[nodiscard]] Section solver_section();
// keys_table_results.cpp: recorded, written, checked and expected quantities.
[[nodiscard]] Section probe_section();
[[nodiscard]] Section output_section();
[[nodiscard]] Section check_section();
[[nodiscard]] Section expect_section();

}  // namespace ricochet
