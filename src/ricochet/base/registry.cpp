#include "ricochet/base/registry.hpp"

#include <fmt/format.h>

namespace ricochet {

namespace {

long& revision() {
  static long number = 0;
  return number;
}

}  // namespace

long registry_revision() { return revision(); }

void raise_registry_revision() { ++revision(); }

void check_parameter_keys(const std::vector<Key>& keys, const std::string& owner, bool reads_groups) {
  const auto refuse = [&](const Key& key, const std::string& why) {
    throw Error(ErrorKind::invalid_input, fmt::format("{}: the key \"{}\" {}", owner, key.name, why));
  };
  for (const Key& key : keys) {
    const bool is_scalar = key.type == KeyType::number || key.type == KeyType::integer || key.type == KeyType::text ||
                           key.type == KeyType::choice || (reads_groups && key.type == KeyType::groups);
    if (!is_scalar && key.type != KeyType::vector)
      refuse(key, "has an unsupported type: it must be a number, an integer, a vector, a text or a choice");
    if (!is_scalar && key.default_value) refuse(key, "is a vector, which cannot have a default");
    if (std::ranges::count_if(keys, [&](const Key& other) { return other.name == key.name; }) > 1)
      refuse(key, "is defined twice");
  }
}

}  // namespace ricochet
