#include <fmt/format.h>

#include <cstdlib>

#include "ricochet/base/json.hpp"
#include "ricochet/case/keys.hpp"
#include "ricochet/case/read_case.hpp"

namespace ricochet {

namespace {

Json number_schema(const char* type, const Range& range) {
  Json schema{{"type", type}};
  // Integer bounds are written as integers, as usual in "minimum": 1.
  const auto bound = [](double value) { return Json::parse(fmt::format("{}", value)); };
  if (range.above) schema["exclusiveMinimum"] = bound(*range.above);
  if (range.at_least) schema["minimum"] = bound(*range.at_least);
  if (range.below) schema["exclusiveMaximum"] = bound(*range.below);
  if (range.at_most) schema["maximum"] = bound(*range.at_most);
  return schema;
}

Json vector_schema(const Json& items) {
  return {{"type", "array"}, {"items", items}, {"minItems", 2}, {"maxItems", 3}};
}

Json integer_schema(const Key& key) {
  if (key.choices.empty()) return number_schema("integer", key.range);
  Json values = Json::array();
  for (const std::string& choice : key.choices) values.push_back(Json::parse(choice));
  return {{"type", "integer"}, {"enum", values}};
}

Json or_choices(const Json& schema, const Key& key) {
  if (key.choices.empty()) return schema;
  return {{"anyOf", Json::array({schema, Json{{"enum", key.choices}}})}};
}

Json keys_schema(const std::vector<Key>& keys);

Json text_schema(const Key& key) {
  Json schema{{"type", "string"}};
  if (key.required) schema["minLength"] = 1;
  return schema;
}

Json type_schema(const Key& key) {
  switch (key.type) {
    case KeyType::text:
      return text_schema(key);
    case KeyType::choice:
      return {{"type", "string"}, {"enum", key.choices}};
    case KeyType::number:
      return or_choices(number_schema("number", key.range), key);
    case KeyType::integer:
      return integer_schema(key);
    case KeyType::flag:
      return {{"type", "boolean"}};
    case KeyType::vector:
      return vector_schema({{"type", "number"}});
    case KeyType::numbers:
      return {{"type", "array"}, {"items", number_schema("number", key.range)}, {"minItems", 1}};
    case KeyType::axial: {
      const Json vector{{"type", "array"}, {"items", {{"type", "number"}}}, {"minItems", 3}, {"maxItems", 3}};
      return {{"anyOf", Json::array({Json{{"type", "number"}}, vector})}};
    }
    case KeyType::axial_formulas: {
      const Json entry{{"type", {"number", "string"}}};
      const Json vector{{"type", "array"}, {"items", entry}, {"minItems", 3}, {"maxItems", 3}};
      return {{"anyOf", Json::array({entry, vector})}};
    }
    case KeyType::formula:
      return {{"type", {"number", "string"}}};
    case KeyType::formulas:
      return or_choices(vector_schema({{"type", {"number", "string"}}}), key);
    case KeyType::components:
    case KeyType::names:
      return {{"type", "array"}, {"items", {{"enum", key.choices}}}, {"minItems", 1}, {"uniqueItems", true}};
    case KeyType::groups: {
      const Json name{{"type", "string"}, {"minLength", 1}};
      const Json list{{"type", "array"}, {"items", name}, {"minItems", 1}, {"uniqueItems", true}};
      return {{"anyOf", Json::array({name, list})}};
    }
    case KeyType::parameters:
      return {
          {"type", "object"},
          {"propertyNames", {{"pattern", "^[A-Za-z_][A-Za-z0-9_]*$"}, {"not", {{"enum", {"x", "y", "z", "t", "pi"}}}}}},
          {"additionalProperties", {{"type", "number"}}}};
    case KeyType::conditions:
      return {{"type", "object"}};
    case KeyType::table:
      return keys_schema(key.keys);
    case KeyType::tables: {
      const Json table = keys_schema(key.keys);
      const Json list{{"type", "array"}, {"items", table}, {"minItems", 1}};
      return {{"anyOf", Json::array({table, list})}};
    }
  }
  return {};
}

Json default_value(const Key& key) {
  const bool is_number = key.type == KeyType::number || key.type == KeyType::integer || key.type == KeyType::formula;
  return is_number || key.type == KeyType::flag ? Json::parse(*key.default_value) : Json(*key.default_value);
}

Json key_schema(const Key& key) {
  Json schema = type_schema(key);
  std::string description = key.doc;
  if (!key.variables.empty()) description += fmt::format(" Expressions in {}.", key.variables);
  if (!key.unit.empty()) description += fmt::format(" Unit: {}.", key.unit);
  schema["description"] = description;
  if (key.default_value) schema["default"] = default_value(key);
  return schema;
}

Json keys_schema(const std::vector<Key>& keys) {
  Json schema{{"type", "object"}, {"properties", Json::object()}};
  Json required = Json::array();
  for (const Key& key : keys) {
    schema["properties"][key.name] = key_schema(key);
    if (key.required && key.only_for.empty() && key.replaced_by.empty()) required.push_back(key.name);
  }
  if (!required.empty()) schema["required"] = required;
  schema["additionalProperties"] = false;
  return schema;
}

// Requires exactly one set of keys, completely: each set excludes every key of the others.
void add_alternatives(const KeySets& alternatives, Json& schema, bool may_lack = false) {
  if (alternatives.empty()) return;
  Json options = Json::array();
  for (const auto& chosen : alternatives) {
    Json refused = Json::array();
    for (const auto& other : alternatives) {
      if (&other == &chosen) continue;
      for (const std::string& name : other) refused.push_back({{"required", Json::array({name})}});
    }
    options.push_back({{"required", chosen}, {"not", {{"anyOf", refused}}}});
  }
  if (may_lack) {
    Json refused = Json::array();
    for (const auto& set : alternatives) refused.push_back({{"required", set}});
    options.push_back({{"not", {{"anyOf", refused}}}});
  }
  schema["oneOf"] = options;
}

// Conditions for entries of one type: its required keys must be present, and keys of other types absent.
Json type_conditions(const Section& section, const TypeKeys& type) {
  Json then = Json::object(), required = Json::array(), foreign = Json::array();
  for (const Key& key : section.keys) {
    if (key.only_for.empty()) continue;
    const Key* const own = find_key(type.keys, key.name);
    if (own == nullptr) foreign.push_back({{"required", Json::array({key.name})}});
    if (own != nullptr && own->required) required.push_back(key.name);
  }
  if (!required.empty()) then["required"] = required;
  if (!foreign.empty()) then["not"] = {{"anyOf", foreign}};
  add_alternatives(type.alternatives, then);
  return then;
}

void add_types(const Section& section, Json& schema) {
  if (section.types.size() == 1) return add_alternatives(section.types.front().alternatives, schema);
  Json conditions = Json::array();
  for (const TypeKeys& type : section.types) {
    const Json then = type_conditions(section, type);
    if (then.empty()) continue;
    // Without "required" the condition also holds for entries that leave the choice at its default.
    Json given{{"properties", {{section.type_key, {{"const", type.name}}}}}};
    if (find_key(section.keys, section.type_key)->default_value != type.name)
      given["required"] = Json::array({section.type_key});
    conditions.push_back({{"if", given}, {"then", then}});
  }
  if (!conditions.empty()) schema["allOf"] = conditions;
}

Json section_schema(const Section& section) {
  Json entry = keys_schema(section.keys);
  add_alternatives(section.alternatives, entry, section.stands_alone != nullptr);
  if (!section.types.empty()) add_types(section, entry);
  Json schema = entry;
  if (section.kind == SectionKind::list) schema = {{"type", "array"}, {"items", entry}};
  if (section.kind == SectionKind::list && section.required) schema["minItems"] = 1;
  if (section.kind == SectionKind::named) {
    schema = {
        {"type", "object"}, {"propertyNames", {{"pattern", "^[A-Za-z0-9_-]+$"}}}, {"additionalProperties", entry}};
  }
  schema["description"] = section.doc;
  return schema;
}

// Requires either a section with its required keys, or entries of the section that replaces it and none of its
// replaceable keys.
Json one_of_two(const Section& section) {
  Json required = Json::array(), given = Json::array();
  for (const Key& key : section.keys) {
    if (key.replaced_by.empty()) continue;
    if (key.required) required.push_back(key.name);
    given.push_back({{"required", Json::array({key.name})}});
  }
  const std::string& other = section.replaced_by;
  const Json alone{{"required", Json::array({section.name})},
                   {"properties", {{section.name, {{"required", required}}}, {other, {{"maxProperties", 0}}}}}};
  const Json replaced{{"required", Json::array({other})},
                      {"properties", {{section.name, {{"not", {{"anyOf", given}}}}}, {other, {{"minProperties", 1}}}}}};
  return Json::array({alone, replaced});
}

}  // namespace

std::string case_schema() {
  const std::vector<Section>& sections = case_sections();
  Json root = keys_schema(sections.front().keys);
  Json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "Ricochet case file"},
              {"description", "Use any consistent units."}};
  for (const auto& [name, value] : root.items()) schema[name] = value;
  Json required = Json::array();
  for (const Section& section : sections) {
    if (section.kind == SectionKind::top) continue;
    schema["properties"][section.name] = section_schema(section);
    if (!section.replaced_by.empty()) {
      schema["oneOf"] = one_of_two(section);
    } else if (section.required) {
      required.push_back(section.name);
    }
  }
  schema["required"] = required;
  return schema.dump(2) + "\n";
}

}  // namespace ricochet
