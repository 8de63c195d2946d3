#pragma once

#include <optional>
#include <string>

#include "ricochet/case/keys.hpp"
#include "ricochet/case/problems.hpp"
#include "ricochet/case/toml_tree.hpp"

/// @file Checking a document against the table of keys.
namespace ricochet {

/// Checks everything that the table says: unknown, missing and misplaced keys, types, choices, bounds, vectors of one
/// dimension. Fills in the defaults, turns integers into reals where numbers are wanted, and marks refused values.
void check_tree(TomlNode& root, Problems& problems);

/// Checks one value against its key, likewise. Marks it refused when there is a problem with it.
void check_value(const Key& key, TomlNode& value, Problems& problems);

/// Checks the key paths and values of `when` in [[expect]]; both spellings of a path become one.
void check_conditions(TomlNode& root, Problems& problems);

/// The node at a key path, or nullptr; `problem` then says why ("there is no [[contact]] number 7: …").
[[nodiscard]] const TomlNode* find_entry(const TomlNode& root, const KeyPath& path, std::string& problem);

}  // namespace ricochet
