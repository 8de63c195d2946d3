#include "ricochet/case/keys_override.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/case/keys_check.hpp"

namespace ricochet {

namespace {

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

/// Refuses a list or a table that is invalid in TOML: as a word it would be a name that nothing has.
void refuse_unquoted(const std::string& text) {
  if (text.empty() || (text.front() != '[' && text.front() != '{') || parse_toml_value(text, {})) return;
  throw Error(ErrorKind::invalid_input,
              fmt::format("{} is not a {}: texts within it need double quotes, and the whole argument single quotes, "
                          "as in --set 'contact.0.group=[\"a\", \"b\"]'",
                          text, text.front() == '[' ? "list" : "table"));
}

TomlNode parse_value(const std::string& text, const SourceLocation& location) {
  if (std::optional<TomlNode> value = parse_toml_value(text, location)) return *value;
  TomlNode word;  // so that --set time.scheme=midpoint needs no quotes
  word.kind = TomlNode::Kind::text;
  word.text = text;
  word.location = word.key_location = location;
  return word;
}

// Returns the table of that name, created if absent.
TomlNode& enter_table(TomlNode& parent, const std::string& name, const SourceLocation& location) {
  if (TomlNode* found = parent.find(name)) return *found;
  TomlNode& child = parent.children.emplace_back();
  child.key = name;
  child.location = child.key_location = location;
  return child;
}

// Returns a sub-table, or the one that the path names in a list of sub-tables.
TomlNode* enter_sub_table(TomlNode& node, const KeyPath& path) {
  if (path.sub_entry.empty() && !node.is_list_of_tables()) return &node;
  const std::size_t count = node.is_list_of_tables() ? node.children.size() : 0;
  const auto number = path.sub_entry.empty() ? count : std::size_t(std::stol(path.sub_entry));
  if (number < count) return &node.children[number];
  throw Error(ErrorKind::invalid_input,
              count == 0 ? fmt::format("\"{0}\" is not a list of tables: write {0}.{1}", path.sub_table, path.key->name)
                         : fmt::format("\"{0}\" is a list: specify the entry, from {0}.0.{1} to {0}.{2}.{1}",
                                       path.sub_table, path.key->name, count - 1));
}

// Returns the table that holds the key, or nullptr if the document has another value there, which check_tree reports.
TomlNode* enter_section(TomlNode& root, const KeyPath& path, const SourceLocation& location) {
  TomlNode* table = &root;
  if (path.section->kind == SectionKind::list) {
    std::string problem;
    static_cast<void>(find_entry(root, path, problem));
    if (!problem.empty()) throw Error(ErrorKind::invalid_input, problem);
    table = &root.find(path.section->name)->children[std::size_t(std::stol(path.entry))];
  } else if (path.section->kind != SectionKind::top) {
    table = &enter_table(root, path.section->name, location);
    if (path.section->kind == SectionKind::named && table->is_table())
      table = &enter_table(*table, path.entry, location);
  }
  if (table->is_table() && !path.sub_table.empty())
    table = enter_sub_table(enter_table(*table, path.sub_table, location), path);
  return table->is_table() ? table : nullptr;
}

void apply(TomlNode& root, const std::string& path_text, const std::string& value_text,
           const SourceLocation& location) {
  const KeyPath path = parse_key_path(path_text);
  TomlNode* table = enter_section(root, path, location);
  if (table == nullptr) return;
  if (path.key->type != KeyType::text) refuse_unquoted(value_text);
  TomlNode value = parse_value(value_text, location);
  value.key = path.member.empty() ? path.key->name : path.member;
  if (TomlNode* present = table->find(value.key)) {
    *present = value;
  } else {
    table->children.push_back(value);
  }
}

}  // namespace

std::vector<std::string> apply_overrides(TomlNode& root, const std::vector<std::string>& overrides,
                                         Problems& problems) {
  std::vector<std::string> paths;
  for (const std::string& text : overrides) {
    const std::size_t equals = text.find('=');
    const std::string path = trimmed(text.substr(0, equals));
    if (equals == std::string::npos || path.empty()) {
      throw Error(ErrorKind::usage,
                  fmt::format("--set {}: write --set key.path=value, as in --set time.step=1e-4", text));
    }
    const SourceLocation location{"--set " + text, 0, 0};
    try {
      apply(root, path, trimmed(text.substr(equals + 1)), location);
    } catch (const Error& problem) {
      problems.add(location, problem.what());
    }
    if (std::ranges::find(paths, path) == paths.end()) paths.push_back(path);
  }
  return paths;
}

std::string override_value_text(const std::string& text) {
  const TomlNode value = parse_value(trimmed(text), {});
  return value.kind == TomlNode::Kind::date ? trimmed(text) : value_text(value);  // whose value_text is just "date"
}

std::string normal_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) return trimmed(text);
  return trimmed(text.substr(0, equals)) + "=" + override_value_text(text.substr(equals + 1));
}

}  // namespace ricochet
