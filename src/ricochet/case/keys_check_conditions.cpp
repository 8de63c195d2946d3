#include <fmt/format.h>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/keys_check.hpp"

namespace ricochet {

namespace {

// `when = { time.scheme = "…" }` without quotes is a nested table in TOML: both spellings mean a path.
void flatten(const TomlNode& node, const std::string& prefix, std::vector<TomlNode>& conditions) {
  for (const TomlNode& child : node.children) {
    const std::string path = prefix.empty() ? child.key : prefix + "." + child.key;
    if (child.is_table() && !child.children.empty()) {
      flatten(child, path, conditions);
    } else {
      conditions.push_back(child);
      conditions.back().key = path;
    }
  }
}

void check_condition(const TomlNode& root, TomlNode& condition, Problems& problems) {
  try {
    const KeyPath path = parse_key_path(condition.key);
    std::string missing;
    if (path.key->type == KeyType::conditions ||
        ((path.key->type == KeyType::table || path.key->type == KeyType::tables) && path.member.empty())) {
      missing = "it holds several values: specify one";
    } else {
      static_cast<void>(find_entry(root, path, missing));
    }
    if (!missing.empty()) {
      problems.add(condition.key_location, fmt::format("\"when\" names \"{}\": {}", condition.key, missing));
    } else if (path.member.empty()) {
      Key key = *path.key;
      key.name = condition.key;
      check_value(key, condition, problems);
    } else {
      check_value({.name = condition.key, .type = KeyType::number, .doc = ""}, condition, problems);
    }
  } catch (const Error& error) {
    problems.add(condition.key_location, fmt::format("\"when\" names \"{}\": {}", condition.key, error.what()));
  }
}

}  // namespace

void check_conditions(TomlNode& root, Problems& problems) {
  TomlNode* list = root.find("expect");
  if (list == nullptr || list->is_refused) return;
  for (TomlNode& entry : list->children) {
    TomlNode* when = entry.find("when");
    if (when == nullptr || when->is_refused) continue;
    std::vector<TomlNode> conditions;
    flatten(*when, "", conditions);
    when->children = conditions;
    for (TomlNode& condition : when->children) check_condition(root, condition, problems);
  }
}

const TomlNode* find_entry(const TomlNode& root, const KeyPath& path, std::string& problem) {
  const TomlNode* node = path.section->kind == SectionKind::top ? &root : root.find(path.section->name);
  if (path.section->kind == SectionKind::list) {
    const std::size_t count = node != nullptr && node->is_list_of_tables() ? node->children.size() : 0;
    const auto number = std::size_t(std::stol(path.entry));
    if (number >= count) {
      problem = fmt::format("there is no entry {} of {}: {}", number, section_title(*path.section),
                            count == 0   ? "the case has none"
                            : count == 1 ? "there is only entry 0"
                                         : fmt::format("the entries are 0 to {}", count - 1));
      return nullptr;
    }
    return &node->children[number];
  }
  if (path.section->kind == SectionKind::named) {
    const TomlNode* named = node != nullptr ? node->find(path.entry) : nullptr;
    if (named == nullptr) problem = fmt::format("there is no [{}.{}]", path.section->name, path.entry);
    return named;
  }
  return node;
}

}  // namespace ricochet
