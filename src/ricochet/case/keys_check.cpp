#include "ricochet/case/keys_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

/// Types that have a key: scheme "newmark", types "sphere" and "cylinder".
std::string types_text(const Section& section, const Key& key) {
  return fmt::format("{}{} {}", section.type_key, key.only_for.size() > 1 ? "s" : "", join_names(key.only_for));
}

using Kind = TomlNode::Kind;

TomlNode default_node(const Key& key, const SourceLocation& location) {
  TomlNode node;
  node.key = key.name;
  node.location = node.key_location = location;
  node.is_default = true;
  if (key.type == KeyType::table) return node;
  if (key.type == KeyType::flag) {
    node.kind = Kind::boolean;
    node.boolean = *key.default_value == "true";
    return node;
  }
  const std::string& value = *key.default_value;
  const bool is_number = key.type == KeyType::number || key.type == KeyType::formula;
  node.kind = key.type == KeyType::integer ? Kind::integer : is_number ? Kind::real : Kind::text;
  if (node.kind == Kind::text) node.text = value;
  if (node.kind == Kind::real) node.real = std::strtod(value.c_str(), nullptr);
  if (node.kind == Kind::integer) node.integer = std::strtol(value.c_str(), nullptr, 10);
  return node;
}

bool is_key_of(const std::vector<Key>& keys, const TomlNode& member) { return find_key(keys, member.key) != nullptr; }

// Tests for an unknown key that was probably meant to be this one, whose absence is then not reported separately.
bool is_misspelt(const Key& key, const std::vector<Key>& keys, const TomlNode& table) {
  return std::ranges::any_of(table.children, [&](const TomlNode& member) {
    return !is_key_of(keys, member) && nearest_key(member.key, keys) == key.name;
  });
}

// Tests for a table that cannot be filled in with defaults alone: it is absent unless it is specified.
bool needs_a_user(const Key& table) {
  return std::ranges::any_of(table.keys, [](const Key& key) { return key.required; });
}

/// Table that [part.a.b] is in TOML; null if it may be a misspelt key.
const TomlNode* find_dotted(const Section& section, const TomlNode& entry) {
  const auto found = std::ranges::find_if(entry.children, [&](const TomlNode& member) {
    return member.is_table() && !is_key_of(section.keys, member) && nearest_key(member.key, section.keys).empty();
  });
  return found != entry.children.end() ? &*found : nullptr;
}

// Checks the document section by section, in the order of the table of keys.
class TreeChecker {
 public:
  TreeChecker(TomlNode& root, Problems& problems) : root_(root), problems_(problems) {}
  void run();

 private:
  void check_top();
  void check_top_member(const TomlNode& member);
  void check_section(const Section& section);
  void check_list(const Section& section, TomlNode& list);
  void check_named(const Section& section, TomlNode& sections);
  void check_entry(const Section& section, const std::string& title, TomlNode& table);
  void check_keys(const std::vector<Key>& keys, const std::string& title, TomlNode& table);
  void check_known(const std::vector<Key>& keys, const std::string& title, TomlNode& table);
  void check_known_of_type(const Section& section, const TypeKeys* type, const std::string& title,
                           const TomlNode& table);
  const TypeKeys* find_type_of(const Section& section, TomlNode& table);
  void check_foreign_key(const Section& section, const TypeKeys* type, const Key& key, const std::string& title,
                         TomlNode& table);
  void check_key(const Key& key, const std::string& title, TomlNode& value);
  [[nodiscard]] bool has_entries(const std::string& section) const;
  [[nodiscard]] bool is_replaced(const std::string& section) const;
  void check_alternatives(const KeySets& alternatives, const std::vector<Key>& keys, const std::string& title,
                          const TomlNode& table, const Section* section = nullptr);
  void report_missing_section(const Section& section);

  TomlNode& root_;
  Problems& problems_;
  DimensionCheck dimension_;
};

void TreeChecker::run() {
  check_top();
  for (const Section& section : case_sections()) {
    if (section.kind != SectionKind::top) check_section(section);
  }
  dimension_.run(problems_);
  check_conditions(root_, problems_);
}

void TreeChecker::check_top() {
  const Section& top = case_sections().front();
  for (const TomlNode& member : root_.children) check_top_member(member);
  for (const Key& key : top.keys) {
    if (TomlNode* value = root_.find(key.name)) {
      check_value(key, *value, problems_);
    } else if (key.default_value) {
      root_.children.push_back(default_node(key, root_.location));
    }
  }
}

void TreeChecker::check_top_member(const TomlNode& member) {
  const Section& top = case_sections().front();
  if (find_section(member.key) != nullptr || is_key_of(top.keys, member)) return;
  if (member.is_table() || member.is_list_of_tables()) {
    problems_.add(member.key_location, unknown_section_message(member.key));
    return;
  }
  // A key above the first section header was probably meant for a section.
  for (const Section& section : case_sections()) {
    if (!is_key_of(section.keys, member)) continue;
    problems_.add(member.key_location, fmt::format("the key \"{}\" is outside of any section; it belongs to {}",
                                                   member.key, section_title(section)));
    return;
  }
  problems_.add(member.key_location, unknown_key_message(member.key, section_title(top), top.keys));
}

void TreeChecker::check_section(const Section& section) {
  TomlNode* node = root_.find(section.name);
  if (node == nullptr) {
    if (section.required && !is_replaced(section.replaced_by)) return report_missing_section(section);
    if (section.kind != SectionKind::table) return;
    // An absent section has its defaults nevertheless.
    node = &root_.children.emplace_back();
    node->key = section.name;
    node->is_default = true;
    node->location = node->key_location = root_.location;
    return check_entry(section, section_title(section), *node);
  }
  if (section.kind == SectionKind::list) return check_list(section, *node);
  if (section.kind == SectionKind::named) return check_named(section, *node);
  if (node->is_table()) return check_entry(section, section_title(section), *node);
  node->is_refused = true;
  problems_.add(node->key_location, node->is_list_of_tables()
                                        ? fmt::format("there is only one {0}: write [{1}], not [[{1}]]",
                                                      section_title(section), section.name)
                                        : fmt::format("\"{}\" must be a section, {}; found {}", section.name,
                                                      section_title(section), describe(*node)));
}

void TreeChecker::check_list(const Section& section, TomlNode& list) {
  if (list.kind == Kind::list && list.children.empty()) {
    if (section.required)
      problems_.add(list.location, fmt::format("there must be at least one {}", section_title(section)));
    return;
  }
  if (!list.is_list_of_tables()) {
    list.is_refused = true;
    problems_.add(list.key_location, list.is_table()
                                         ? fmt::format("there can be several {0}: write [[{1}]], not [{1}]",
                                                       section_title(section), section.name)
                                         : fmt::format("\"{}\" must be a list of tables, {}; found {}", section.name,
                                                       section_title(section), describe(list)));
    return;
  }
  for (TomlNode& entry : list.children) check_entry(section, section_title(section), entry);
}

void TreeChecker::check_named(const Section& section, TomlNode& sections) {
  if (!sections.is_table()) {
    sections.is_refused = true;
    problems_.add(sections.key_location,
                  fmt::format("each {0} has a name: write [{0}.NAME], not {1}", section.name,
                              sections.is_list_of_tables() ? fmt::format("[[{}]]", section.name) : describe(sections)));
    return;
  }
  for (TomlNode& entry : sections.children) {
    const std::string title = fmt::format("[{}.{}]", section.name, entry.key);
    if (!entry.is_table()) {
      sections.is_refused = true;
      problems_.add(entry.key_location, fmt::format("\"{}\" is in [{}], which needs a name: write [{}.NAME]", entry.key,
                                                    section.name, section.name));
      return;  // the following keys have the same problem

    } else if (!is_plain_name(entry.key)) {
      entry.is_refused = true;
      problems_.add(entry.key_location, fmt::format("the name of {} can only contain letters, digits, _ and -", title));
    } else if (const TomlNode* const inner = find_dotted(section, entry)) {
      entry.is_refused = true;
      problems_.add(inner->key_location,
                    fmt::format("[{0}.{1}.{2}]: a name must not contain a dot; write [{0}.{1}-{2}], for instance",
                                section.name, entry.key, inner->key));
    } else {
      check_entry(section, title, entry);
    }
  }
}

/// Type that an entry names or has by default; null, with a problem reported, if the name is unknown.
const TypeKeys* TreeChecker::find_type_of(const Section& section, TomlNode& table) {
  const Key& key = *find_key(section.keys, section.type_key);
  TomlNode* const value = table.find(key.name);
  if (value == nullptr) return key.default_value ? find_type(section, *key.default_value) : nullptr;
  check_value(key, *value, problems_);
  return value->is_refused ? nullptr : find_type(section, value->text);
}

void TreeChecker::check_entry(const Section& section, const std::string& title, TomlNode& table) {
  if (section.type_key.empty()) {
    check_known(section.keys, title, table);
    check_keys(section.keys, title, table);
    return check_alternatives(section.alternatives, section.keys, title, table, &section);
  }
  const TypeKeys* const type = find_type_of(section, table);
  const TomlNode* const named = table.find(section.type_key);
  if (type == nullptr && named != nullptr && find_key(section.keys, section.type_key)->decides) {
    table.is_refused = true;
    return;
  }
  std::vector<Key> keys;
  for (const Key& key : section.keys) {
    const Key* const own = type != nullptr ? find_key(type->keys, key.name) : nullptr;
    const bool is_of_some_type = own != nullptr || !key.only_for.empty();
    if (!is_of_some_type) {
      if (key.name != section.type_key || named == nullptr) keys.push_back(key);
    } else if (own != nullptr) {
      keys.push_back(*own);
    } else {
      check_foreign_key(section, type, key, title, table);
    }
  }
  check_known_of_type(section, type, title, table);
  check_keys(keys, title, table);
  if (type != nullptr) check_alternatives(type->alternatives, type->keys, title, table);
}

/// Checks a key that the entry's type does not have. If --set replaced the type in the file, the key is ignored;
/// otherwise it is an error, also under the default type: without effect it would be believed to have one.
void TreeChecker::check_foreign_key(const Section& section, const TypeKeys* type, const Key& key,
                                    const std::string& title, TomlNode& table) {
  TomlNode* const value = table.find(key.name);
  if (value == nullptr) return;
  if (type == nullptr) return check_key(key, title, *value);
  const TomlNode* const named = table.find(section.type_key);
  if (named != nullptr && named->is_override() && !value->is_override()) {
    value->is_ignored = true;
    problems_.add_info(value->location,
                       fmt::format("\"{}\" is ignored: the {} is \"{}\"", key.name, section.type_key, type->name));
    return;
  }
  value->is_refused = true;
  problems_.add(value->location,
                fmt::format("\"{}\" is for the {} only; the {} is \"{}\"{}", key.name, types_text(section, key),
                            section.type_key, type->name, named == nullptr ? ", the default" : ""));
}

void TreeChecker::check_known(const std::vector<Key>& keys, const std::string& title, TomlNode& table) {
  for (const TomlNode& member : table.children) {
    if (!is_key_of(keys, member)) problems_.add(member.key_location, unknown_key_message(member.key, title, keys));
  }
}

/// Suggests no key that the entry's type does not have: it would be refused next.
void TreeChecker::check_known_of_type(const Section& section, const TypeKeys* type, const std::string& title,
                                      const TomlNode& table) {
  std::vector<Key> allowed;
  for (const Key& key : section.keys) {
    if (type == nullptr || key.only_for.empty() || find_key(type->keys, key.name) != nullptr) allowed.push_back(key);
  }
  for (const TomlNode& member : table.children) {
    if (is_key_of(section.keys, member)) continue;
    const Key* const meant = find_key(section.keys, nearest_key(member.key, section.keys));
    const bool is_foreign = meant != nullptr && nearest_key(member.key, allowed).empty();
    problems_.add(member.key_location,
                  is_foreign
                      ? fmt::format("unknown key \"{}\" in {}; \"{}\" is for the {} only; the {} is \"{}\"", member.key,
                                    title, meant->name, types_text(section, *meant), section.type_key, type->name)
                      : unknown_key_message(member.key, title, meant != nullptr ? allowed : section.keys));
  }
}

/// Returns whether the case has entries of that section; refused ones count.
bool TreeChecker::has_entries(const std::string& section) const {
  const TomlNode* const node = section.empty() ? nullptr : root_.find(section);
  return node != nullptr && !(node->is_table() && node->children.empty());
}

/// Returns whether that section replaces a key or section; also if its name is misspelt, which is reported separately.
bool TreeChecker::is_replaced(const std::string& section) const {
  if (section.empty()) return false;
  return has_entries(section) || std::ranges::any_of(root_.children, [&](const TomlNode& member) {
           return find_section(member.key) == nullptr && (member.is_table() || member.is_list_of_tables()) &&
                  nearest_section(member.key) == section;
         });
}

void TreeChecker::check_keys(const std::vector<Key>& keys, const std::string& title, TomlNode& table) {
  for (const Key& key : keys) {
    TomlNode* const value = table.find(key.name);
    if (value != nullptr && has_entries(key.replaced_by)) {
      value->is_refused = true;
      problems_.add(
          value->location,
          fmt::format("\"{0}\" of {1} and {2} exclude each other: each {2} has its own \"{0}\"; remove it here",
                      key.name, title, section_title(*find_section(key.replaced_by))));
    } else if (value != nullptr) {
      check_key(key, title, *value);
    } else if (is_misspelt(key, keys, table) || is_replaced(key.replaced_by)) {
      continue;
    } else if (key.required) {
      problems_.add(table.location,
                    fmt::format("{} has no \"{}\": {}. {}", title, key.name, admissible_with_unit(key), key.doc));
    } else if (key.default_value || (key.type == KeyType::table && !needs_a_user(key))) {
      TomlNode& added = table.children.emplace_back(default_node(key, table.location));
      if (key.type == KeyType::table) check_keys(key.keys, key.name, added);
    }
  }
}

void TreeChecker::check_key(const Key& key, const std::string& title, TomlNode& value) {
  check_value(key, value, problems_);
  if (value.is_refused) return;
  if (key.type == KeyType::table || key.type == KeyType::tables) {
    const std::string of_table = fmt::format("\"{}\" of {}", key.name, title);
    const auto check_table = [&](TomlNode& table) {
      check_known(key.keys, of_table, table);
      check_keys(key.keys, of_table, table);
    };
    if (value.is_table()) return check_table(value);
    for (TomlNode& table : value.children) check_table(table);
    return;
  }
  dimension_.note(key, title, value);
}

void TreeChecker::check_alternatives(const KeySets& alternatives, const std::vector<Key>& keys,
                                     const std::string& title, const TomlNode& table, const Section* section) {
  if (alternatives.empty()) return;
  std::vector<std::string> given, texts;
  std::size_t touched = 0, complete = 0;
  for (const std::vector<std::string>& names : alternatives) {
    texts.push_back(join_names(names));
    std::size_t present = 0;
    for (const std::string& name : names) {
      if (table.find(name) == nullptr && !is_misspelt(*find_key(keys, name), keys, table)) continue;
      given.push_back(name);
      ++present;
    }
    if (present > 0) ++touched;
    if (present == names.size()) ++complete;
  }
  if (touched == 1 && complete == 1) return;
  const bool may_lack = section != nullptr && section->stands_alone != nullptr;
  if (touched == 0 && may_lack && section->stands_alone(table)) return;
  problems_.add(table.location, fmt::format("{} needs either {}; found {}{}", title, join_names(texts, " or ", false),
                                            given.empty() ? "none of them" : join_names(given),
                                            touched == 0 && may_lack ? "; without them " + section->alone : ""));
}

void TreeChecker::report_missing_section(const Section& section) {
  for (const TomlNode& member : root_.children) {
    const bool is_unknown = find_section(member.key) == nullptr && !is_key_of(case_sections().front().keys, member);
    if (is_unknown && nearest_section(member.key) == section.name) return;  // misspelt, and reported as such
  }
  std::vector<std::string> names;
  for (const Key& key : section.keys) {
    if (key.required && key.only_for.empty()) names.push_back(key.name);
  }
  const std::string other = section.replaced_by.empty()
                                ? ""
                                : fmt::format(", and no {} either", section_title(*find_section(section.replaced_by)));
  problems_.add({root_.location.file, 1, 1},
                fmt::format("there is no section {}, which must have {}{}. {}", section_title(section),
                            join_names(names), other, section.doc));
}

}  // namespace

void check_tree(TomlNode& root, Problems& problems) { TreeChecker(root, problems).run(); }

}  // namespace ricochet
