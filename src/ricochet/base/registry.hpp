#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/base/error.hpp"
#include "ricochet/base/parameters.hpp"
#include "ricochet/base/text.hpp"

/// @file Types that are asked for by name: schemes, masses, obstacles, material laws, multiplier spaces, contact
/// solvers. A type is one file and one registration.
namespace ricochet {

/// A type by its name, with the keys that it alone has and what it does.
template <class Type>
struct Registration {
  std::string name;
  Type type;                   ///< its constructor, and what is known of the type as such
  std::vector<Key> keys = {};  ///< of a case file, of this type alone
  KeySets alternatives = {};   ///< of these keys
  /// Checks that concern several keys, when a case file is read. May change the values to those that count.
  std::function<void(const ParameterCheck& place, Parameters& values)> check = {};
};

/// Raised by every addition: tables made from registries are then made again.
[[nodiscard]] inline long& registry_revision() {
  static long revision = 0;
  return revision;
}

template <class Type>
class Registry {
 public:
  /// `noun`: what a type is, for messages ("scheme").
  Registry(std::string noun, std::vector<Registration<Type>> known) : noun_(std::move(noun)), all_(std::move(known)) {}

  /// Of a program of one's own, before the first case is read: case files may name the type from then on. Throws
  /// Error(invalid_input) where the name is taken.
  void add(Registration<Type> added) {
    for (const Registration<Type>& entry : all_) {
      if (entry.name == added.name)
        throw Error(ErrorKind::invalid_input, "there is a " + quoted(added.name) + " already");
    }
    all_.push_back(std::move(added));
    ++registry_revision();
  }

  /// Takes back what was added.
  void remove(const std::string& name) {
    std::erase_if(all_, [&](const Registration<Type>& entry) { return entry.name == name; });
    ++registry_revision();
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
    const auto found = std::find_if(all_.begin(), all_.end(), same);
    if (found != all_.end()) return *found;
    throw Error(ErrorKind::invalid_input, "unknown " + quoted(name) + "; known: " + join_names(names()));
  }
  /// The registration with its values: defaults added. Throws as Parameters::complete does.
  [[nodiscard]] const Registration<Type>& find(const std::string& name, Parameters& values) const {
    const Registration<Type>& entry = find(name);
    values.complete(entry.keys, quoted(name));
    return entry;
  }

 private:
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
