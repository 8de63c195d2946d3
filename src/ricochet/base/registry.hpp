#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/parameters.hpp"
#include "ricochet/base/text.hpp"

/// @file Types selected by name: schemes, masses, obstacles, material laws, multiplier spaces, contact solvers. A type
/// is one file and one registration.
namespace ricochet {

/// A type with its name and the keys that it alone has.
template <class Type>
struct Registration {
  std::string name;
  Type type;                   ///< its constructor and its static properties
  std::vector<Key> keys = {};  ///< of a case file, of this type alone
  KeySets alternatives = {};   ///< sets of these keys, of which one must be given
  /// Checks that involve several keys, made when a case file is read. May replace values by those that take effect.
  std::function<void(const ParameterCheck& check, Parameters& values)> check = {};
};

/// Changes with every addition, so that tables made from registries are made again.
[[nodiscard]] long registry_revision();
void raise_registry_revision();
/// Throws Error(invalid_input) that names `owner` if a type's own keys are of a kind that Parameters do not hold: only
/// numbers, integers, vectors, texts, choices and, if they are read, groups are allowed, and vectors have no default.
void check_parameter_keys(const std::vector<Key>& keys, const std::string& owner, bool reads_groups);

/// Whether groups of the mesh may be among the keys of a type.
template <class Type>
inline constexpr bool reads_groups = false;

template <class Type>
class Registry {
 public:
  /// `noun` names the kind of type in messages ("scheme").
  Registry(std::string noun, std::vector<Registration<Type>> entries)
      : noun_(std::move(noun)), all_(std::move(entries)) {
    for (const Registration<Type>& entry : all_) check_keys(entry);
  }

  /// Adds a type of the user's own program, which case files that are read from then on may name. Throws
  /// Error(invalid_input) if the name is taken or a key is not admissible for a type. Invalidates references returned
  /// by `find`.
  void add(Registration<Type> added) {
    check_keys(added);
    for (const Registration<Type>& entry : all_) {
      if (entry.name == added.name)
        throw Error(ErrorKind::invalid_input, "there is a " + quoted(added.name) + " already");
    }
    all_.push_back(std::move(added));
    raise_registry_revision();
  }

  /// Removes a type that was added. Throws as `find` does.
  void remove(const std::string& name) {
    static_cast<void>(find(name));
    std::erase_if(all_, [&](const Registration<Type>& entry) { return entry.name == name; });
    raise_registry_revision();
  }

  [[nodiscard]] const std::vector<Registration<Type>>& all() const { return all_; }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> result;
    for (const Registration<Type>& entry : all_) result.push_back(entry.name);
    return result;
  }
  /// Throws Error(invalid_input) that lists the names.
  [[nodiscard]] const Registration<Type>& find(const std::string& name) const {
    const auto same = [&](const Registration<Type>& entry) { return entry.name == name; };
    const auto found = std::ranges::find_if(all_, same);
    if (found != all_.end()) return *found;
    throw Error(ErrorKind::invalid_input, "unknown " + quoted(name) + "; known: " + join_names(names()));
  }
  /// Returns the registration and adds the defaults to its values. Throws as Parameters::complete does.
  [[nodiscard]] const Registration<Type>& find(const std::string& name, Parameters& values) const {
    const Registration<Type>& entry = find(name);
    values.complete(entry.keys, quoted(name));
    return entry;
  }

 private:
  void check_keys(const Registration<Type>& entry) const {
    check_parameter_keys(entry.keys, quoted(entry.name), reads_groups<Type>);
  }
  [[nodiscard]] std::string quoted(const std::string& name) const { return noun_ + " \"" + name + '"'; }

  std::string noun_;
  std::vector<Registration<Type>> all_;
};

/// Defines `Registry<Type>& FUNCTION()`, which holds what the functions of LIST return. LIST is a macro that applies
/// its argument to each of them, one line per type; each is defined in the file of its type as `Registration<Type>
/// name()`.
#define RICOCHET_DEFINE_REGISTRY(FUNCTION, Type, noun, LIST)           \
  Registry<Type>& FUNCTION() {                                         \
    using Entry = Registration<Type>;                                  \
    LIST(RICOCHET_DECLARE_ENTRY)                                       \
    static Registry<Type> registry(noun, {LIST(RICOCHET_MAKE_ENTRY)}); \
    return registry;                                                   \
  }
#define RICOCHET_DECLARE_ENTRY(registration) extern Entry registration();
#define RICOCHET_MAKE_ENTRY(registration) registration(),

}  // namespace ricochet
