#include "ricochet/case/section_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "ricochet/base/error.hpp"

namespace ricochet {

bool SectionReader::is_given(const std::string& name) const {
  const TomlNode* node = table_.find(name);
  return node != nullptr && !node->is_default;
}

bool SectionReader::is_override(const std::string& name) const {
  const TomlNode* node = table_.find(name);
  return node != nullptr && node->is_override();
}

void SectionReader::fill(const std::type_info& owner, void* object) const {
  for (const Key& key : keys_) {
    for (const KeyMember& member : key.members) {
      if (*member.owner == owner && is_usable(key.name)) member.store(*this, key, object);
    }
  }
}

const TomlNode* SectionReader::usable(const std::string& name) const {
  const TomlNode* node = table_.find(name);
  return node != nullptr && !node->is_refused && !node->is_ignored ? node : nullptr;
}

std::string SectionReader::text(const std::string& name) const {
  const TomlNode* node = usable(name);
  return node != nullptr ? node->text : "";
}

std::string SectionReader::value(const std::string& name) const {
  const TomlNode* node = usable(name);
  return node != nullptr ? value_text(*node) : "";
}

double SectionReader::number(const std::string& name) const {
  const TomlNode* node = usable(name);
  return node != nullptr ? node->real : 0.0;
}

std::string SectionReader::path(const std::string& file) const {
  return (std::filesystem::path(result_.path).parent_path() / file).lexically_normal().string();
}

void SectionReader::read(const Key& key, std::string& value) const {
  const TomlNode& node = *usable(key.name);
  std::vector<std::string> names;
  read(key, names);
  value = names.empty() ? node.text : names.size() == 1 ? names.front() : value_text(node);
  if (names.size() < 2) return;
  // ["a, b", "c"] and ["a", "b, c"] have the same text.
  std::map<std::string, std::vector<std::string>>& lists = result_.group_lists;
  for (auto other = lists.find(value); other != lists.end() && other->second != names; other = lists.find(value))
    value += "'";
  lists[value] = names;
}

void SectionReader::read(const Key& key, std::vector<double>& value) const {
  const TomlNode& node = *usable(key.name);
  value.clear();
  if (node.is_number()) value.push_back(node.real);
  for (const TomlNode& component : node.children) value.push_back(component.real);
}

void SectionReader::read(const Key& key, std::vector<int>& value) const {
  value.clear();
  for (const TomlNode& entry : usable(key.name)->children) {
    const auto choice = std::ranges::find(key.choices, entry.text);
    value.push_back(int(choice - key.choices.begin()));
  }
  std::ranges::sort(value);
}

void SectionReader::read(const Key& key, std::vector<std::string>& value) const {
  value.clear();
  for (const TomlNode& entry : usable(key.name)->children) value.push_back(entry.text);
}

void SectionReader::read(const Key& key, Expression& value) const { value = expression(key, *usable(key.name)); }

void SectionReader::read(const Key& key, std::vector<Expression>& value) const {
  const TomlNode& node = *usable(key.name);
  value.clear();
  if (node.kind != TomlNode::Kind::list && key.type == KeyType::axial_formulas) value.push_back(expression(key, node));
  for (const TomlNode& component : node.children) value.push_back(expression(key, component));
}

void SectionReader::read(const Key& key, std::map<std::string, std::string>& value) const {
  for (const TomlNode& condition : usable(key.name)->children) value[condition.key] = value_text(condition);
}

std::map<std::string, double> SectionReader::constants() const {
  std::map<std::string, double> values;
  const TomlNode* const parameters = table_.find("parameters");
  if (parameters == nullptr || parameters->is_refused) return values;
  for (const TomlNode& parameter : parameters->children) values[parameter.key] = parameter.real;
  return values;
}

Expression SectionReader::expression(const Key& key, const TomlNode& node) const {
  if (node.is_number()) return Expression(node.real);
  // Refused parameters make every expression that uses them fail: one message is enough.
  if (const TomlNode* parameters = table_.find("parameters"); parameters != nullptr && parameters->is_refused)
    return {};
  try {
    Expression result(node.text, constants());
    const bool allows_time = key.variables.ends_with('t'), allows_position = key.variables.starts_with('x');
    if ((result.depends_on_time() && !allows_time) || (result.depends_on_position() && !allows_position)) {
      problems_.add(
          node.location,
          fmt::format("\"{}\": the expression \"{}\" depends on {}; only {} can be used here", key.name, node.text,
                      result.depends_on_time() && !allows_time ? "the time t" : "the position", key.variables));
      return {};
    }
    return result;
  } catch (const Error& problem) {
    problems_.add(node.location, fmt::format("\"{}\": {}", key.name, problem.what()));
    return {};
  }
}

std::vector<SectionReader> SectionReader::tables(const std::string& name) const {
  const TomlNode* const node = usable(name);
  if (node == nullptr) return {};
  const std::vector<Key>& keys = find_key(keys_, name)->keys;
  if (node->is_table()) return {{keys, *node, result_, problems_}};
  std::vector<SectionReader> result;
  for (const TomlNode& entry : node->children) result.emplace_back(keys, entry, result_, problems_);
  return result;
}

SourceLocation SectionReader::where(const std::string& name) const {
  const TomlNode* node = table_.find(name);
  return node != nullptr ? node->location : table_.location;
}

Parameters SectionReader::type_parameters(const Section& section) const {
  const TypeKeys* const type = find_type(section, text(section.type_key));
  Parameters values = parameters(type == nullptr ? std::vector<Key>() : type->keys);
  if (type != nullptr && type->check) type->check(*this, values);
  return values;
}

Parameters SectionReader::parameters(const std::vector<Key>& keys) const {
  Parameters values;
  values.set_constants(constants());
  for (const Key& key : keys) {
    if (!is_usable(key.name)) continue;
    if (key.type == KeyType::number) values.set(key.name, number(key.name));
    if (key.type == KeyType::integer) values.set(key.name, double(usable(key.name)->integer));
    if (key.type == KeyType::vector) {
      std::vector<double> components;
      read(key, components);
      values.set(key.name, components);
    }
    if (key.type == KeyType::text || key.type == KeyType::choice || key.type == KeyType::groups) {
      std::string text;
      read(key, text);
      values.set(key.name, text);
    }
  }
  return values;
}

SectionReader Sections::one(const std::string& name) const {
  static const TomlNode absent;
  const TomlNode* const node = root_.find(name);
  return {find_section(name)->keys, node != nullptr && node->is_table() ? *node : absent, result_, problems_};
}

std::vector<SectionReader> Sections::all(const std::string& name) const {
  std::vector<SectionReader> readers;
  const TomlNode* const node = root_.find(name);
  if (node == nullptr || node->is_refused) return readers;
  for (const TomlNode& entry : node->children) {
    if (!entry.is_refused) readers.emplace_back(find_section(name)->keys, entry, result_, problems_);
  }
  return readers;
}

}  // namespace ricochet
