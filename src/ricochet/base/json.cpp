#include "ricochet/base/json.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace ricochet {

using Library = nlohmann::ordered_json;

struct JsonConversion {
  static Library to_library(const Json& json);
  static Json from_library(const Library& json);
};

Library JsonConversion::to_library(const Json& json) {
  if (json.is_array()) {
    Library result = Library::array();
    for (const Json& element : json.elements()) result.push_back(to_library(element));
    return result;
  }
  if (json.is_object()) {
    Library result = Library::object();
    for (const auto& [name, entry] : json.items()) result.push_back({name, to_library(entry)});
    return result;
  }
  if (const auto* value = std::get_if<bool>(&json.value_)) return *value;
  if (const auto* value = std::get_if<std::int64_t>(&json.value_)) return *value;
  if (const auto* value = std::get_if<double>(&json.value_)) return *value;
  if (const auto* value = std::get_if<std::string>(&json.value_)) return *value;
  return nullptr;
}

Json JsonConversion::from_library(const Library& json) {
  if (json.is_array()) {
    Json result = Json::array();
    for (const Library& element : json) result.push_back(from_library(element));
    return result;
  }
  if (json.is_object()) {
    Json::Object entries;
    for (const auto& entry : json.items()) entries.emplace_back(entry.key(), from_library(entry.value()));
    Json result;
    result.value_ = std::move(entries);
    return result;
  }
  if (json.is_boolean()) return json.get<bool>();
  const bool is_too_large =
      json.is_number_unsigned() && json.get<std::uint64_t>() > std::numeric_limits<std::int64_t>::max();
  if (json.is_number_integer() && !is_too_large) return json.get<std::int64_t>();
  if (json.is_number()) return json.get<double>();
  if (json.is_string()) return json.get<std::string>();
  return nullptr;
}

Json::Json(std::initializer_list<Json> elements) {
  const bool are_entries = std::ranges::all_of(elements, [](const Json& element) {
    return element.is_array() && element.size() == 2 && element.at(std::size_t{0}).is_string();
  });
  if (!are_entries) {
    value_ = Array(elements);
    return;
  }
  value_ = Object();
  for (const Json& entry : elements) (*this)[std::get<std::string>(entry.at(0UL).value_)] = entry.at(1UL);
}

Json Json::array(std::initializer_list<Json> elements) {
  Json result;
  result.value_ = Array(elements);
  return result;
}

Json Json::object() {
  Json result;
  result.value_ = Object();
  return result;
}

Json Json::number(double value) {
  if (std::isfinite(value)) return value;
  return std::isnan(value) ? "nan" : value > 0 ? "inf" : "-inf";
}

double Json::to_number() const {
  if (is_number()) return get<double>();
  const std::string text = is_string() ? get<std::string>() : "nan";
  return text == "inf" ? INFINITY : text == "-inf" ? -INFINITY : NAN;
}

Json Json::parse(const std::string& text) {
  try {
    return JsonConversion::from_library(Library::parse(text));
  } catch (const Library::exception& problem) {
    throw Exception(problem.what());
  }
}

std::string Json::dump(int indent) const {
  return JsonConversion::to_library(*this).dump(indent, ' ', false, Library::error_handler_t::replace);
}

std::size_t Json::size() const {
  if (const auto* array = std::get_if<Array>(&value_)) return array->size();
  if (const auto* object = std::get_if<Object>(&value_)) return object->size();
  return 0;
}

const Json* Json::find(std::string_view name) const {
  const auto* const object = std::get_if<Object>(&value_);
  if (object == nullptr) return nullptr;
  const auto found = std::ranges::find_if(*object, [&](const auto& entry) { return entry.first == name; });
  return found != object->end() ? &found->second : nullptr;
}

const Json& Json::at(std::string_view name) const {
  const Json* const found = find(name);
  if (found == nullptr) throw Exception("there is no entry \"" + std::string(name) + '"');
  return *found;
}

const Json& Json::at(std::size_t index) const {
  if (index >= elements().size()) throw Exception("an array has only " + std::to_string(size()) + " elements");
  return elements()[index];
}

Json& Json::operator[](std::string_view name) {
  if (std::holds_alternative<std::nullptr_t>(value_)) value_ = Object();
  auto* const object = std::get_if<Object>(&value_);
  if (object == nullptr) throw Exception("an object is needed to set \"" + std::string(name) + "\"");
  for (auto& [key, entry] : *object) {
    if (key == name) return entry;
  }
  return object->emplace_back(std::string(name), Json()).second;
}

Json& Json::operator[](std::size_t index) {
  static_cast<void>(at(index));
  return std::get<Array>(value_)[index];
}

void Json::push_back(Json element) {
  if (std::holds_alternative<std::nullptr_t>(value_)) value_ = Array();
  auto* const array = std::get_if<Array>(&value_);
  if (array == nullptr) throw Exception("an array is needed to add an element");
  array->push_back(std::move(element));
}

void Json::update(const Json& other) {
  for (const auto& [name, entry] : other.items()) (*this)[name] = entry;
}

const Json::Array& Json::elements() const {
  if (const auto* array = std::get_if<Array>(&value_)) return *array;
  throw Exception("expected an array instead of " + dump());
}

const Json::Object& Json::items() const {
  if (const auto* object = std::get_if<Object>(&value_)) return *object;
  throw Exception("expected an object instead of " + dump());
}

void Json::get(bool& result) const {
  if (const auto* value = std::get_if<bool>(&value_)) {
    result = *value;
    return;
  }
  throw Exception("expected true or false instead of " + dump());
}

void Json::get(long& result) const {
  if (const auto* value = std::get_if<std::int64_t>(&value_)) {
    result = *value;
  } else if (const auto* number = std::get_if<double>(&value_);
             number != nullptr && std::abs(*number) < 0x1p62 && *number == std::trunc(*number)) {
    result = long(*number);
  } else {
    throw Exception("expected an integer instead of " + dump());
  }
}

void Json::get(int& result) const {
  const long value = get<long>();
  result = int(value);
  if (result != value) throw Exception("expected a smaller number instead of " + dump());
}

void Json::get(double& result) const {
  if (const auto* value = std::get_if<double>(&value_)) {
    result = *value;
  } else if (const auto* integer = std::get_if<std::int64_t>(&value_)) {
    result = double(*integer);
  } else {
    throw Exception("expected a number instead of " + dump());
  }
}

void Json::get(std::string& result) const {
  if (const auto* value = std::get_if<std::string>(&value_)) {
    result = *value;
    return;
  }
  throw Exception("expected a text instead of " + dump());
}

void Json::get(std::map<std::string, std::string>& result) const {
  result.clear();
  for (const auto& [name, entry] : items()) result[name] = entry.get<std::string>();
}

}  // namespace ricochet
