#include <fmt/format.h>

#include <algorithm>
#include <list>
#include <mutex>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/keys_table.hpp"

namespace ricochet {

// The sections in their order, each by a function in one of the files keys_table_*.cpp.
// clang-format off
#define RICOCHET_CASE_SECTIONS(section)                                                               \
  section(mesh_section) section(part_section) section(material_section) section(obstacle_section)     \
  section(contact_section) section(support_section) section(traction_section)                         \
  section(pressure_section) section(load_section) section(initial_section) section(motion_section)    \
  section(mass_section) section(time_section) section(solver_section) section(probe_section)          \
  section(output_section) section(check_section) section(expect_section)
// clang-format on
#define RICOCHET_DECLARE_SECTION(section) Section section();
#define RICOCHET_MAKE_SECTION(section) section(),
RICOCHET_CASE_SECTIONS(RICOCHET_DECLARE_SECTION)

namespace {

Section top_section() {
  Section section{.name = "", .kind = SectionKind::top, .doc = "Keys before the first section."};
  section.keys = {
      key("title", &Case::title, {.default_value = ""}, "One line about the case, repeated in its results.")};
  return section;
}

std::vector<std::string> types_with(const std::string& key, const std::vector<TypeKeys>& types) {
  std::vector<std::string> names;
  for (const TypeKeys& type : types) {
    if (find_key(type.keys, key) != nullptr) names.push_back(type.name);
  }
  return names;
}

}  // namespace

void add_type_keys(Section& section, const std::string& type_key, std::vector<TypeKeys> types, KeyMember parameters) {
  std::vector<Key> added;
  for (const TypeKeys& type : types) {
    for (Key key : type.keys) {
      const Key* const other = find_key(added, key.name);
      if (find_key(section.keys, key.name) != nullptr || (other != nullptr && other->type != key.type)) {
        throw Error(ErrorKind::invalid_input,
                    fmt::format("the {} \"{}\" has a key \"{}\", which {} already has with another meaning", type_key,
                                type.name, key.name, section_title(section)));
      }
      if (other != nullptr) continue;
      const std::vector<std::string> names = types_with(key.name, types);
      if (names.size() < types.size()) {
        key.only_for = names;
        if (key.doc.ends_with('.')) key.doc.pop_back();
        key.doc += fmt::format("; for the {} {} only.", type_key, join_names(names));
      }
      added.push_back(std::move(key));
    }
  }
  const auto at = std::ranges::find_if(section.keys, [&](const Key& key) { return key.name == type_key; });
  at->type = KeyType::choice;
  at->members.push_back(std::move(parameters));
  for (const TypeKeys& type : types) at->choices.push_back(type.name);
  section.keys.insert(at + 1, added.begin(), added.end());
  section.type_key = type_key;
  section.types = std::move(types);
}

const std::vector<Section>& case_sections() {
  // Types may be registered while a program runs; earlier tables are kept, as they may still be in use.
  static std::list<std::vector<Section>> tables;
  static long revision = -1;
  static std::mutex in_use;
  const std::lock_guard<std::mutex> lock(in_use);
  if (revision != registry_revision()) {
    revision = registry_revision();
    tables.push_back({top_section(), RICOCHET_CASE_SECTIONS(RICOCHET_MAKE_SECTION)});
  }
  return tables.back();
}

}  // namespace ricochet
