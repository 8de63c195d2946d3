#pragma once

#include <optional>
#include <string>
#include <vector>

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

/// Holds the vectors of a document against one another: all are of one dimension, that of the mesh.
class DimensionCheck {
 public:
  /// Looks at a value that is not refused.
  void note(const Key& key, const std::string& title, const TomlNode& value);
  void run(Problems& problems);

 private:
  struct Found {
    SourceLocation location;
    std::string name;
    std::size_t dimension;
    std::string what;  ///< "has 3 entries"
  };
  std::vector<Found> vectors_;
  std::vector<SourceLocation> third_components_;  ///< where "z" stands in a list of components
};

/// Checks the key paths and values of `when` in [[expect]]; both spellings of a path become one.
void check_conditions(TomlNode& root, Problems& problems);

/// The node at a key path, or nullptr; `problem` then says why ("there is no [[contact]] number 7: …").
[[nodiscard]] const TomlNode* find_entry(const TomlNode& root, const KeyPath& path, std::string& problem);

}  // namespace ricochet
