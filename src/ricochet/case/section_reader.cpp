#include "ricochet/case/section_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

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

bool SectionReader::is_usable(const std::string& name) const {
  return usable(name) != nullptr;
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
  return optional_number(name).value_or(0.0);
}

std::optional<double> SectionReader::optional_number(const std::string& name) const {
  const TomlNode* node = usable(name);
  return node != nullptr ? std::optional<double>(node->real) : std::nullopt;
}

long SectionReader::integer(const std::string& name) const {
  return optional_integer(name).value_or(0);
}

std::optional<long> SectionReader::optional_integer(const std::string& name) const {
  const TomlNode* node = usable(name);
  return node != nullptr ? std::optional<long>(node->integer) : std::nullopt;
}

bool SectionReader::flag(const std::string& name) const {
  const TomlNode* node = usable(name);
  return node != nullptr && node->boolean;
}

std::vector<double> SectionReader::vector(const std::string& name) const {
  std::vector<double> values;
  if (const TomlNode* node = usable(name)) {
    for (const TomlNode& component : node->children) values.push_back(component.real);
  }
  return values;
}

std::vector<double> SectionReader::axial(const std::string& name) const {
  const TomlNode* const node = usable(name);
  return node != nullptr && node->is_number() ? std::vector<double>{node->real} : vector(name);
}

std::vector<int> SectionReader::choice_numbers(const std::string& name) const {
  const std::vector<std::string>& choices = find_key(keys_, name)->choices;
  std::vector<int> numbers;
  if (const TomlNode* node = usable(name)) {
    for (const TomlNode& entry : node->children) {
      numbers.push_back(static_cast<int>(std::find(choices.begin(), choices.end(), entry.text) - choices.begin()));
    }
  }
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

std::vector<std::string> SectionReader::chosen(const std::string& name) const {
  std::vector<std::string> names;
  if (const TomlNode* node = usable(name)) {
    for (const TomlNode& entry : node->children) names.push_back(entry.text);
  }
  return names;
}

std::string SectionReader::groups(const std::string& name,
                                  std::map<std::string, std::vector<std::string>>& lists) const {
  const TomlNode* node = usable(name);
  if (node == nullptr || node->children.empty()) return text(name);
  const std::vector<std::string> names = chosen(name);
  if (names.size() == 1) return names.front();
  std::string list = value_text(*node);
  // ["a, b", "c"] and ["a", "b, c"] have the same text.
  for (auto other = lists.find(list); other != lists.end() && other->second != names; other = lists.find(list))
    list += "'";
  lists[list] = names;
  return list;
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

Expression SectionReader::formula(const std::string& name) const {
  const TomlNode* node = usable(name);
  return node != nullptr ? expression(*find_key(keys_, name), *node) : Expression();
}

std::vector<Expression> SectionReader::formulas(const std::string& name) const {
  std::vector<Expression> values;
  if (const TomlNode* node = usable(name)) {
    for (const TomlNode& component : node->children) values.push_back(expression(*find_key(keys_, name), component));
  }
  return values;
}

std::vector<Expression> SectionReader::axial_formulas(const std::string& name) const {
  const TomlNode* const node = usable(name);
  if (node == nullptr || node->kind == TomlNode::Kind::list) return formulas(name);
  return {expression(*find_key(keys_, name), *node)};
}

std::map<std::string, std::string> SectionReader::conditions(const std::string& name) const {
  std::map<std::string, std::string> values;
  if (const TomlNode* node = usable(name)) {
    for (const TomlNode& condition : node->children) values[condition.key] = value_text(condition);
  }
  return values;
}

SectionReader SectionReader::table(const std::string& name) const {
  static const TomlNode absent;
  const TomlNode* node = usable(name);
  return {find_key(keys_, name)->keys, node != nullptr ? *node : absent, problems_};
}

std::vector<SectionReader> SectionReader::tables(const std::string& name) const {
  const TomlNode* const node = usable(name);
  if (node == nullptr) return {};
  if (node->is_table()) return {table(name)};
  std::vector<SectionReader> result;
  for (const TomlNode& entry : node->children) result.emplace_back(find_key(keys_, name)->keys, entry, problems_);
  return result;
}

SourceLocation SectionReader::where(const std::string& name) const {
  const TomlNode* node = table_.find(name);
  return node != nullptr ? node->location : table_.location;
}

void SectionReader::add_problem(const std::string& name, const std::string& message) const {
  problems_.add(where(name), message);
}

void SectionReader::add_warning(const std::string& name, const std::string& message) const {
  problems_.add_warning(where(name), message);
}

void SectionReader::add_info(const std::string& name, const std::string& message) const {
  problems_.add_info(where(name), message);
}

Parameters SectionReader::type_parameters(const Section& section) const {
  const TypeKeys* const type = find_type(section, text(section.type_key));
  std::map<std::string, std::vector<std::string>> none;  // types have no groups
  Parameters values = parameters(type == nullptr ? std::vector<Key>() : type->keys, none);
  if (type != nullptr && type->check) type->check(*this, values);
  return values;
}

Parameters SectionReader::parameters(const std::vector<Key>& keys,
                                     std::map<std::string, std::vector<std::string>>& lists) const {
  Parameters values;
  values.set_constants(constants());
  for (const Key& key : keys) {
    if (!is_usable(key.name)) continue;
    if (key.type == KeyType::number) values.set(key.name, number(key.name));
    if (key.type == KeyType::integer) values.set(key.name, static_cast<double>(integer(key.name)));
    if (key.type == KeyType::vector) values.set(key.name, vector(key.name));
    if (key.type == KeyType::text || key.type == KeyType::choice) values.set(key.name, text(key.name));
    if (key.type == KeyType::groups) values.set(key.name, groups(key.name, lists));
  }
  return values;
}

}  // namespace ricochet
