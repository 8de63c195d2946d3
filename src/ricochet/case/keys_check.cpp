#include "ricochet/case/keys_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <tuple>

#include "ricochet/base/error.hpp"
#include "ricochet/base/text.hpp"

namespace ricochet {

namespace {

using Kind = TomlNode::Kind;

TomlNode default_node(const Key& key, const SourceLocation& location) {
  TomlNode node;
  node.key = key.name;
  node.location = node.key_location = location;
  node.is_default = true;
  if (key.type == KeyType::table) return node;
  const std::string& value = *key.standard;
  const bool is_number = key.type == KeyType::number || key.type == KeyType::formula;
  node.kind = key.type == KeyType::integer ? Kind::integer : is_number ? Kind::real : Kind::text;
  if (node.kind == Kind::text) node.text = value;
  if (node.kind == Kind::real) node.real = std::strtod(value.c_str(), nullptr);
  if (node.kind == Kind::integer) node.integer = std::strtol(value.c_str(), nullptr, 10);
  return node;
}

bool is_key_of(const std::vector<Key>& keys, const TomlNode& member) {
  return find_key(keys, member.key) != nullptr;
}

// There is an unknown key that was probably meant to be this one: its absence is no second problem.
bool is_misspelt(const Key& key, const std::vector<Key>& keys, const TomlNode& table) {
  return std::any_of(table.children.begin(), table.children.end(), [&](const TomlNode& member) {
    return !is_key_of(keys, member) && nearest_key(member.key, keys) == key.name;
  });
}

// A table that cannot be filled in with defaults alone: it is absent where nobody gives it.
bool needs_a_user(const Key& table) {
  return std::any_of(table.keys.begin(), table.keys.end(), [](const Key& key) { return key.required; });
}

// Goes through the document section by section, as the table of keys says.
class TreeChecker {
 public:
  TreeChecker(TomlNode& root, Problems& problems) : root_(root), problems_(problems) {}
  void run();

 private:
  struct VectorFound {
    SourceLocation location;
    std::string name;
    std::size_t size;
  };

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
  void check_foreign_key(const Section& section, const Key& key, const std::string& title, TomlNode& table);
  void check_key(const Key& key, const std::string& title, TomlNode& value);
  void check_alternatives(const KeySets& alternatives, const std::vector<Key>& keys, const std::string& title,
                          const TomlNode& table);
  void report_missing_section(const Section& section);
  void check_dimension();

  TomlNode& root_;
  Problems& problems_;
  std::vector<VectorFound> vectors_;
  std::vector<SourceLocation> third_components_;  ///< where "z" stands in a list of components
};

void TreeChecker::run() {
  check_top();
  for (const Section& section : case_sections()) {
    if (section.kind != SectionKind::top) check_section(section);
  }
  check_dimension();
  check_conditions(root_, problems_);
}

void TreeChecker::check_top() {
  const Section& top = case_sections().front();
  for (const TomlNode& member : root_.children) check_top_member(member);
  for (const Key& key : top.keys) {
    if (TomlNode* value = root_.find(key.name)) {
      check_value(key, *value, problems_);
    } else if (key.standard) {
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
  // A key above the first section header is easily meant for a section.
  for (const Section& section : case_sections()) {
    if (!is_key_of(section.keys, member)) continue;
    problems_.add(member.key_location, fmt::format("the key \"{}\" stands outside of any section; it belongs to {}",
                                                   member.key, section_title(section)));
    return;
  }
  problems_.add(member.key_location, unknown_key_message(member.key, section_title(top), top.keys));
}

void TreeChecker::check_section(const Section& section) {
  TomlNode* node = root_.find(section.name);
  if (node == nullptr) {
    if (section.required) return report_missing_section(section);
    if (section.kind != SectionKind::table) return;
    // An absent section has its defaults all the same.
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
      problems_.add(entry.key_location, fmt::format("\"{}\" stands in [{}], which needs a name: write [{}.NAME]",
                                                    entry.key, section.name, section.name));
      return;  // the keys that follow have the same problem

    } else if (!is_plain_name(entry.key)) {
      entry.is_refused = true;
      problems_.add(entry.key_location, fmt::format("the name of {} can only have letters, digits, _ and -", title));
    } else {
      check_entry(section, title, entry);
    }
  }
}

/// The type that an entry names or has by default; none where it names no known one, which is told.
const TypeKeys* TreeChecker::find_type_of(const Section& section, TomlNode& table) {
  const Key& key = *find_key(section.keys, section.type_key);
  TomlNode* const value = table.find(key.name);
  if (value == nullptr) return key.standard ? find_type(section, *key.standard) : nullptr;
  check_value(key, *value, problems_);
  return value->is_refused ? nullptr : find_type(section, value->text);
}

void TreeChecker::check_entry(const Section& section, const std::string& title, TomlNode& table) {
  if (section.type_key.empty()) {
    check_known(section.keys, title, table);
    check_keys(section.keys, title, table);
    return check_alternatives(section.alternatives, section.keys, title, table);
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
      check_foreign_key(section, key, title, table);
    }
  }
  check_known_of_type(section, type, title, table);
  check_keys(keys, title, table);
  if (type != nullptr) check_alternatives(type->alternatives, type->keys, title, table);
}

/// A key that the entry's type does not have. In a file whose type was replaced by --set it means nothing; otherwise it
/// is a mistake.
void TreeChecker::check_foreign_key(const Section& section, const Key& key, const std::string& title, TomlNode& table) {
  TomlNode* const value = table.find(key.name);
  const TomlNode* const type = table.find(section.type_key);
  if (value == nullptr) return;
  if (type == nullptr || type->is_refused) return check_key(key, title, *value);
  if (type->is_override() && !value->is_override()) {
    value->is_ignored = true;
    problems_.add_info(value->location,
                       fmt::format("\"{}\" is ignored: the {} is \"{}\"", key.name, section.type_key, type->text));
    return;
  }
  value->is_refused = true;
  problems_.add(value->location, fmt::format("\"{}\" is for the {} {} only; the {} is \"{}\"", key.name,
                                             section.type_key, join_names(key.only_for), section.type_key, type->text));
}

void TreeChecker::check_known(const std::vector<Key>& keys, const std::string& title, TomlNode& table) {
  for (const TomlNode& member : table.children) {
    if (!is_key_of(keys, member)) problems_.add(member.key_location, unknown_key_message(member.key, title, keys));
  }
}

/// Suggests no key that the entry's type does not take: it would be refused next.
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
                  is_foreign ? fmt::format("unknown key \"{}\" in {}; \"{}\" is for the {} {} only; the {} is \"{}\"",
                                           member.key, title, meant->name, section.type_key,
                                           join_names(meant->only_for), section.type_key, type->name)
                             : unknown_key_message(member.key, title, meant != nullptr ? allowed : section.keys));
  }
}

void TreeChecker::check_keys(const std::vector<Key>& keys, const std::string& title, TomlNode& table) {
  for (const Key& key : keys) {
    if (TomlNode* value = table.find(key.name)) {
      check_key(key, title, *value);
    } else if (is_misspelt(key, keys, table)) {
      continue;
    } else if (key.required) {
      problems_.add(table.location,
                    fmt::format("{} has no \"{}\": {}. {}", title, key.name, wanted_with_unit(key), key.doc));
    } else if (key.standard || (key.type == KeyType::table && !needs_a_user(key))) {
      TomlNode& added = table.children.emplace_back(default_node(key, table.location));
      if (key.type == KeyType::table) check_keys(key.keys, key.name, added);
    }
  }
}

void TreeChecker::check_key(const Key& key, const std::string& title, TomlNode& value) {
  check_value(key, value, problems_);
  if (value.is_refused) return;
  if (key.type == KeyType::table) {
    const std::string of_table = fmt::format("\"{}\" of {}", key.name, title);
    check_known(key.keys, of_table, value);
    check_keys(key.keys, of_table, value);
  }
  const bool is_vector = key.type == KeyType::vector || key.type == KeyType::formulas;
  if (is_vector && value.kind == Kind::list) {
    vectors_.push_back({value.location, fmt::format("\"{}\" of {}", key.name, title), value.children.size()});
  }
  if (key.type == KeyType::components) {
    for (const TomlNode& component : value.children) {
      if (component.text == key.choices.back()) third_components_.push_back(component.location);
    }
  }
}

void TreeChecker::check_alternatives(const KeySets& alternatives, const std::vector<Key>& keys,
                                     const std::string& title, const TomlNode& table) {
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
  problems_.add(table.location, fmt::format("{} needs either {}; found {}", title, join_names(texts, " or ", false),
                                            given.empty() ? "none of them" : join_names(given)));
}

void TreeChecker::report_missing_section(const Section& section) {
  for (const TomlNode& member : root_.children) {
    const bool is_unknown = find_section(member.key) == nullptr && !is_key_of(case_sections().front().keys, member);
    if (is_unknown && nearest_section(member.key) == section.name) return;  // misspelt, and reported as such
  }
  std::vector<std::string> names;
  for (const Key& key : section.keys) {
    if (key.required) names.push_back(key.name);
  }
  problems_.add({root_.location.file, 1, 1}, fmt::format("there is no section {}, which must have {}. {}",
                                                         section_title(section), join_names(names), section.doc));
}

void TreeChecker::check_dimension() {
  if (vectors_.empty()) return;
  // Values of --set come after those of the file, whatever they stand for.
  const auto before = [](const VectorFound& a, const VectorFound& b) {
    const bool a_is_override = a.location.line == 0, b_is_override = b.location.line == 0;
    return std::tie(a_is_override, a.location.line, a.location.column) <
           std::tie(b_is_override, b.location.line, b.location.column);
  };
  std::stable_sort(vectors_.begin(), vectors_.end(), before);
  const VectorFound& first = vectors_.front();
  for (const VectorFound& vector : vectors_) {
    if (vector.size == first.size) continue;
    problems_.add(vector.location, fmt::format("{} has {}, but {} at {} has {}: all vectors must have as many as the "
                                               "mesh has dimensions",
                                               vector.name, counted(vector.size, "entry", "entries"), first.name,
                                               first.location.text(), first.size));
  }
  for (const SourceLocation& location : third_components_) {
    if (first.size == 2)
      problems_.add(location, fmt::format("there is no component \"z\" in two dimensions: {} at {} has 2 entries",
                                          first.name, first.location.text()));
  }
}

}  // namespace

void check_tree(TomlNode& root, Problems& problems) {
  TreeChecker(root, problems).run();
}

}  // namespace ricochet
