#pragma once

#include <string>
#include <vector>

#include "ricochet/case/keys.hpp"
#include "ricochet/case/problems.hpp"
#include "ricochet/case/toml_tree.hpp"

/// @file Validation of a document against the table of keys.
namespace ricochet {

/// Checks all rules of the table: unknown, missing and misplaced keys, types, choices, bounds, vectors of one
/// dimension. Fills in the defaults, converts integers to reals where numbers are required, and marks refused values.
void check_tree(TomlNode& root, Problems& problems);

/// Checks one value against its key, likewise. Marks it as refused if it has a problem.
void check_value(const Key& key, TomlNode& value, Problems& problems);

/// Compares the vectors of a document: all must have the dimension of the mesh.
class DimensionCheck {
 public:
  /// Records a value that is not refused.
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
  std::vector<SourceLocation> third_components_;  ///< positions of "z" in lists of components
};

/// Checks the key paths and values of `when` in [[expect]]; unifies both spellings of a path.
void check_conditions(TomlNode& root, Problems& problems);

/// Node at a key path, or nullptr; `problem` then states the reason ("there is no [[contact]] number 7: …").
[[nodiscard]] const TomlNode* find_entry(const TomlNode& root, const KeyPath& path, std::string& problem);

}  // namespace ricochet
