#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>

#include "case_text.hpp"
#include "ricochet/case/keys.hpp"
#include "ricochet/case/names.hpp"
#include "ricochet/simulation/history/probe_kind.hpp"
#include "support/paths.hpp"

namespace ricochet::case_test {

namespace {

using Json = nlohmann::json;

// Returns the object that holds a section's keys, below lists and names.
const Json& entry_schema(const Json& schema, const Section& section) {
  if (section.kind == SectionKind::top) return schema;
  const Json& found = schema.at("properties").at(section.name);
  if (section.kind == SectionKind::list) return found.at("items");
  return section.kind == SectionKind::named ? found.at("additionalProperties") : found;
}

void expect_keys(const Json& schema, const std::vector<Key>& keys) {
  EXPECT_EQ(schema.at("additionalProperties"), false);
  for (const Key& key : keys) {
    SCOPED_TRACE(key.name);
    const Json& found = schema.at("properties").at(key.name);
    EXPECT_NE(found.at("description").get<std::string>().find(key.doc), std::string::npos);
    EXPECT_EQ(found.contains("default"), key.default_value.has_value());
    const Json required = schema.value("required", Json::array());
    // A key of one type is required where that type is named; one that gives way, only without the others.
    const bool always = key.required && key.only_for.empty() && key.replaced_by.empty();
    EXPECT_EQ(std::find(required.begin(), required.end(), key.name) != required.end(), always);
    if (key.type == KeyType::table) expect_keys(found, key.keys);
  }
}

std::string file_text(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

}  // namespace

TEST(CaseSchema, HasEveryKeyAndNoOther) {
  const Json schema = Json::parse(case_schema());
  EXPECT_EQ(schema.at("$schema"), "https://json-schema.org/draft/2020-12/schema");
  EXPECT_EQ(schema.at("required"), (Json{"material", "time"}));
  for (const Section& section : case_sections()) {
    SCOPED_TRACE(section.name);
    const Json& entry = entry_schema(schema, section);
    expect_keys(entry, section.keys);
    const std::size_t sections = section.kind == SectionKind::top ? case_sections().size() - 1 : 0;
    EXPECT_EQ(entry.at("properties").size(), section.keys.size() + sections);
  }
}

TEST(CaseSchema, AsksForTheKeysOfTheTypeThatIsNamed) {
  const Json schema = Json::parse(case_schema());
  const Json& obstacle = schema.at("properties").at("obstacle").at("additionalProperties");
  std::map<std::string, Json> required;
  for (const Json& condition : obstacle.at("allOf")) {
    const Json& type = condition.at("if").at("properties").at("type").at("const");
    required[type.get<std::string>()] = condition.at("then").at("required");
    EXPECT_TRUE(condition.at("then").contains("not")) << "keys of other types";
  }
  EXPECT_EQ(required.at("plane"), (Json{"point", "normal"}));
  EXPECT_EQ(required.at("sphere"), (Json{"centre", "radius"}));
}

TEST(CaseSchema, TakesTheDefaultForChosen) {
  const Json schema = Json::parse(case_schema());
  for (const Json& condition : schema.at("properties").at("time").at("allOf")) {
    const Json& given = condition.at("if");
    const bool is_default = given.at("properties").at("scheme").at("const") == "reduced-kane";
    EXPECT_EQ(given.contains("required"), !is_default) << given.dump();
  }
}

TEST(CaseSchema, AsksForAMeshOrForParts) {
  const Json schema = Json::parse(case_schema());
  const Json& alone = schema.at("oneOf").at(0);
  EXPECT_EQ(alone.at("required"), Json{"mesh"});
  EXPECT_EQ(alone.at("properties").at("mesh").at("required"), Json{"file"});
  EXPECT_EQ(alone.at("properties").at("part").at("maxProperties"), 0);
  const Json& parts = schema.at("oneOf").at(1);
  EXPECT_EQ(parts.at("required"), Json{"part"});
  EXPECT_EQ(parts.at("properties").at("mesh").at("not").at("anyOf").size(), 9U);
  const Json& part = schema.at("properties").at("part").at("additionalProperties");
  EXPECT_EQ(part.at("required"), Json{"file"});
  const Json& spin = part.at("properties").at("spin").at("anyOf");
  EXPECT_EQ(spin.at(0).at("type"), "number");
  EXPECT_EQ(spin.at(1).at("minItems"), 3);
  EXPECT_EQ(spin.at(1).at("maxItems"), 3);
}

TEST(CaseSchema, CarriesBoundsChoicesAndUnits) {
  const Json properties = Json::parse(case_schema()).at("properties");
  const Json& time = properties.at("time").at("properties");
  EXPECT_EQ(time.at("scheme").at("enum"), Json(scheme_names()));
  EXPECT_EQ(time.at("end").at("exclusiveMinimum"), 0);
  EXPECT_EQ(time.at("step").at("anyOf").at(0).at("exclusiveMinimum"), 0);
  EXPECT_EQ(time.at("step").at("anyOf").at(1).at("enum"), Json{"adaptive"});
  EXPECT_NE(time.at("step").at("description").get<std::string>().find("Unit: time."), std::string::npos);
  EXPECT_EQ(properties.at("mesh").at("properties").at("degree").at("enum"), (Json{1, 2}));
  EXPECT_EQ(properties.at("mesh").at("properties").at("scale").at("default"), 1);
  const Json& poisson = properties.at("material").at("items").at("properties").at("poisson");
  EXPECT_EQ(poisson.at("exclusiveMinimum"), -1);
  EXPECT_EQ(poisson.at("exclusiveMaximum"), 0.5);
  // Either pair of constants of a law that has such pairs.
  const Json& law = properties.at("material").at("items").at("allOf").at(0);
  EXPECT_EQ(law.at("if").at("properties").at("law").at("const"), "linear");
  EXPECT_EQ(law.at("then").at("oneOf").size(), 2U);
  EXPECT_TRUE(properties.at("expect").at("items").at("properties").contains("when"));
}

TEST(CaseKeys, AreDocumentedAndHaveUnits) {
  for (const Section& section : case_sections()) {
    EXPECT_FALSE(section.doc.empty()) << section.name;
    for (const Key& key : section.keys) {
      EXPECT_FALSE(key.doc.empty()) << section.name << '.' << key.name;
      const bool is_number = key.type == KeyType::number || key.type == KeyType::integer ||
                             key.type == KeyType::vector || key.type == KeyType::formula ||
                             key.type == KeyType::formulas || key.type == KeyType::axial ||
                             key.type == KeyType::axial_formulas;
      EXPECT_EQ(!key.unit.empty(), is_number) << section.name << '.' << key.name;
      EXPECT_FALSE(key.required && key.default_value.has_value()) << section.name << '.' << key.name;
    }
  }
}

/// Returns whether a registered type or kind of probe reads the key.
bool is_of_a_type(const Section& section, const Key& key) {
  const auto has_key = [&](const auto& type) { return find_key(type.keys, key.name) != nullptr; };
  const auto& kinds = probe_registry().all();
  return std::ranges::any_of(section.types, has_key) ||
         (section.name == "probe" && std::ranges::any_of(kinds, has_key));
}

/// Adds the keys that nothing binds to a member, except named numbers for expressions and the keys of types.
void add_unbound_keys(const Section& section, const std::vector<Key>& keys, std::vector<std::string>& names) {
  for (const Key& key : keys) {
    if (key.members.empty() && !is_of_a_type(section, key) && key.type != KeyType::parameters)
      names.push_back(section.name + "." + key.name);
    add_unbound_keys(section, key.keys, names);
  }
}

TEST(CaseKeys, FillMembers) {
  std::vector<std::string> names;
  for (const Section& section : case_sections()) add_unbound_keys(section, section.keys, names);
  EXPECT_EQ(names, (std::vector<std::string>{"time.largest"})) << "read_sections.cpp reads it";
}

TEST(CaseReference, IsTheDocumentationPage) {
  EXPECT_EQ(file_text(test_support::source_path("docs/case-file.md")), case_reference())
      << "docs/case-file.md is generated: write case_reference() into it";
}

TEST(CaseReference, ShowsValidCases) {
  const std::string page = case_reference(), opening = "```toml\n";
  std::vector<std::string> titles;
  for (std::size_t at = page.find(opening); at < page.find("## Rules"); at = page.find(opening, at)) {
    at += opening.size();
    titles.push_back(read_text(page.substr(at, page.find("```", at) - at)).title);
  }
  EXPECT_EQ(titles, (std::vector<std::string>{"", "Elastic disc on a rigid foundation"}));
}

}  // namespace ricochet::case_test
