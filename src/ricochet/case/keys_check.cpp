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
  void check_keys(const std::vector<Key>& keys, const std::string& title, TomlNode& table);
  bool is_of_unknown_type(const std::vector<Key>& keys, TomlNode& table);
  void check_key(const Key& key, const std::string& title, TomlNode& value);
  void check_alternatives(const Section& section, const std::string& title, const TomlNode& table);
  void report_missing_section(const Section& section);
  void check_dimension();
  void check_conditions();
  void check_condition(TomlNode& condition);

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
  check_conditions();
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
    return check_keys(section.keys, section_title(section), *node);
  }
  if (section.kind == SectionKind::list) return check_list(section, *node);
  if (section.kind == SectionKind::named) return check_named(section, *node);
  if (node->is_table()) return check_keys(section.keys, section_title(section), *node);
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
  for (TomlNode& entry : list.children) {
    check_keys(section.keys, section_title(section), entry);
    check_alternatives(section, section_title(section), entry);
  }
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
    } else if (is_of_unknown_type(section.keys, entry)) {
      entry.is_refused = true;
    } else {
      check_keys(section.keys, title, entry);
    }
  }
}

bool TreeChecker::is_of_unknown_type(const std::vector<Key>& keys, TomlNode& table) {
  for (const Key& key : keys) {
    TomlNode* value = key.decides ? table.find(key.name) : nullptr;
    if (value == nullptr) continue;
    check_value(key, *value, problems_);
    if (value->is_refused) return true;
  }
  return false;
}

void TreeChecker::check_keys(const std::vector<Key>& keys, const std::string& title, TomlNode& table) {
  for (const TomlNode& member : table.children) {
    if (!is_key_of(keys, member)) {
      problems_.add(member.key_location, unknown_key_message(member.key, title, keys));
    }
  }
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
  if (key.type == KeyType::table) check_keys(key.keys, fmt::format("\"{}\" of {}", key.name, title), value);
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

void TreeChecker::check_alternatives(const Section& section, const std::string& title, const TomlNode& table) {
  if (section.alternatives.empty()) return;
  std::vector<std::string> given, texts;
  std::size_t touched = 0, complete = 0;
  for (const std::vector<std::string>& names : section.alternatives) {
    texts.push_back(join_names(names));
    std::size_t present = 0;
    for (const std::string& name : names) {
      if (table.find(name) == nullptr && !is_misspelt(*find_key(section.keys, name), section.keys, table)) continue;
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

void TreeChecker::check_conditions() {
  TomlNode* list = root_.find("expect");
  if (list == nullptr || list->is_refused) return;
  for (TomlNode& entry : list->children) {
    TomlNode* when = entry.find("when");
    if (when == nullptr || when->is_refused) continue;
    std::vector<TomlNode> conditions;
    flatten(*when, "", conditions);
    when->children = conditions;
    for (TomlNode& condition : when->children) check_condition(condition);
  }
}

void TreeChecker::check_condition(TomlNode& condition) {
  try {
    const KeyPath path = parse_key_path(condition.key);
    std::string missing;
    if (path.key->type == KeyType::conditions || (path.key->type == KeyType::table && path.member.empty())) {
      missing = "it holds several values: say which";
    } else {
      static_cast<void>(find_entry(root_, path, missing));
    }
    if (!missing.empty()) {
      problems_.add(condition.key_location, fmt::format("\"when\" names \"{}\": {}", condition.key, missing));
    } else if (path.member.empty()) {
      Key key = *path.key;
      key.name = condition.key;
      check_value(key, condition, problems_);
    } else {
      check_value({.name = condition.key, .type = KeyType::number, .doc = ""}, condition, problems_);
    }
  } catch (const Error& problem) {
    problems_.add(condition.key_location, fmt::format("\"when\" names \"{}\": {}", condition.key, problem.what()));
  }
}

}  // namespace

void check_tree(TomlNode& root, Problems& problems) {
  TreeChecker(root, problems).run();
}

const TomlNode* find_entry(const TomlNode& root, const KeyPath& path, std::string& problem) {
  const TomlNode* node = path.section->kind == SectionKind::top ? &root : root.find(path.section->name);
  if (path.section->kind == SectionKind::list) {
    const std::size_t count = node != nullptr && node->is_list_of_tables() ? node->children.size() : 0;
    const auto number = static_cast<std::size_t>(std::stol(path.entry));
    if (number >= count) {
      problem = fmt::format("there is no entry {} of {}: {}", number, section_title(*path.section),
                            count == 0   ? "the case has none"
                            : count == 1 ? "there is only entry 0"
                                         : fmt::format("they go from 0 to {}", count - 1));
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
