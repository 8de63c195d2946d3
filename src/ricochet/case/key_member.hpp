#pragma once

#include <type_traits>
#include <utility>

#include "ricochet/case/case.hpp"
#include "ricochet/case/section_reader.hpp"

/// @file Binds keys to members of the structs in case.hpp; the entry in the table then suffices to read them. Not part
/// of the public interface.
namespace ricochet {

template <class Struct, class Value>
[[nodiscard]] KeyMember member(Value Struct::*target) {
  return {&typeid(Struct), [target](const SectionReader& section, const Key& key, void* object) {
            section.read(key, static_cast<Struct*>(object)->*target);
          }};
}

/// Member that becomes true if the value is this choice.
template <class Struct>
[[nodiscard]] KeyMember is_choice(bool Struct::*target, const std::string& choice) {
  return {&typeid(Struct), [target, choice](const SectionReader& section, const Key& key, void* object) {
            static_cast<Struct*>(object)->*target = section.text(key.name) == choice;
          }};
}

/// Path of a file that the value names relative to the folder of the case file.
template <class Struct>
[[nodiscard]] KeyMember path(std::string Struct::*target) {
  return {&typeid(Struct), [target](const SectionReader& section, const Key& key, void* object) {
            static_cast<Struct*>(object)->*target = section.path(section.text(key.name));
          }};
}

/// Parameters of the type that the value names, a type of that section.
template <class Struct>
[[nodiscard]] KeyMember type_parameters(Parameters Struct::*target, const std::string& section_name) {
  return {&typeid(Struct), [target, section_name](const SectionReader& section, const Key& /*key*/, void* object) {
            static_cast<Struct*>(object)->*target = section.type_parameters(*find_section(section_name));
          }};
}

template <class Value, class... Types>
constexpr bool is_one_of = (std::is_same_v<Value, Types> || ...);

/// Returns the type of the keys whose values are stored as this type, unless the table names another.
template <class Value>
[[nodiscard]] constexpr KeyType key_type() {
  if (is_one_of<Value, std::string>) return KeyType::text;
  if (is_one_of<Value, double, std::optional<double>>) return KeyType::number;
  if (is_one_of<Value, int, long, std::optional<long>>) return KeyType::integer;
  if (is_one_of<Value, bool>) return KeyType::flag;
  if (is_one_of<Value, std::vector<double>>) return KeyType::vector;
  if (is_one_of<Value, std::vector<int>>) return KeyType::components;
  if (is_one_of<Value, std::vector<std::string>>) return KeyType::names;
  if (is_one_of<Value, Expression>) return KeyType::formula;
  if (is_one_of<Value, std::vector<Expression>>) return KeyType::formulas;
  if (is_one_of<Value, std::map<std::string, std::string>>) return KeyType::conditions;
  static_assert(std::is_class_v<Value> || is_one_of<Value, double, int, long, bool>, "keys have no such values");
  return requires(Value value) { value.front(); }
  ? KeyType::tables : KeyType::table;
}

/// Key of the table. `properties` is everything but its name, members and documentation. Its type follows from the
/// member unless they state one other than `text`, which stands for none; a text with choices is a choice.
[[nodiscard]] inline Key key(std::string name, std::vector<KeyMember> members, Key properties, std::string doc) {
  properties.name = std::move(name);
  properties.members = std::move(members);
  properties.doc = std::move(doc);
  if (properties.type == KeyType::text && !properties.choices.empty()) properties.type = KeyType::choice;
  return properties;
}
template <class Struct, class Value>
[[nodiscard]] Key key(std::string name, Value Struct::*target, Key properties, std::string doc) {
  if (properties.type == KeyType::text) properties.type = key_type<Value>();
  return key(std::move(name), {member(target)}, std::move(properties), std::move(doc));
}

}  // namespace ricochet
