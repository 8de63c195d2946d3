#pragma once

#include "ricochet/base/registry.hpp"
#include "ricochet/case/key_member.hpp"
#include "ricochet/case/keys.hpp"

/// @file Parts of the table of keys, in keys_table*.cpp. No other part of the program lists the keys of a case file.
/// Not part of the public interface.
namespace ricochet {

/// Inserts the keys of registered types into a section, behind the key that names the type. `parameters` receives their
/// values.
void add_type_keys(Section& section, const std::string& type_key, std::vector<TypeKeys> types, KeyMember parameters);
template <class Type, class Struct>
[[nodiscard]] Section with_types(Section section, const std::string& type_key, const Registry<Type>& registry,
                                 Parameters Struct::*parameters) {
  std::vector<TypeKeys> types;
  for (const Registration<Type>& entry : registry.all())
    types.push_back({entry.name, entry.keys, entry.alternatives, entry.check});
  add_type_keys(section, type_key, std::move(types), type_parameters(parameters, section.name));
  return section;
}

/// `kind` is "cells" or "boundary facets", `built_in` the name of all of them.
[[nodiscard]] Key group_key(KeyMember member, const char* kind, const char* built_in);

/// Returns whether the `group` of a [[contact]] represents bodies: "all" or a pattern, possibly among others.
[[nodiscard]] bool names_bodies(const TomlNode& contact);

}  // namespace ricochet
