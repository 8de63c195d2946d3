#pragma once

#include <concepts>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

/// @file A JSON document. nlohmann's library reads and writes it in json.cpp, and only there: its templates cost every
/// file that includes them ten seconds. Not part of the public interface.
namespace ricochet {

template <class Type>
inline constexpr bool is_json_array = false;
template <class Element>
inline constexpr bool is_json_array<std::vector<Element>> = true;
/// A type to which a document converts.
template <class Type>
concept JsonValue =
    std::same_as<Type, bool> || std::same_as<Type, int> || std::same_as<Type, long> || std::same_as<Type, double> ||
    std::same_as<Type, std::string> || std::same_as<Type, std::map<std::string, std::string>> || is_json_array<Type>;

/// A JSON value. Objects keep the order of insertion. A braced list makes an object if all of its elements are pairs
/// that begin with a text, and an array otherwise, also for a single document: Json{other} is an array.
///   Json{{"name", "disc"}, {"sizes", {1, 2}}}
class Json {
 public:
  using Array = std::vector<Json>;
  using Object = std::vector<std::pair<std::string, Json>>;
  /// Thrown for every error: a text that is not JSON, an entry that is missing or of another type.
  struct Exception : std::runtime_error {
    using std::runtime_error::runtime_error;
  };

  Json() = default;
  Json(std::nullptr_t) {}
  template <std::same_as<bool> Bool>
  Json(Bool value) : value_(value) {}
  Json(double value) : value_(value) {}
  template <std::integral Integer>
  requires(!std::same_as<Integer, bool>) Json(Integer value) : value_(std::int64_t(value)) {}
  Json(const char* text) : value_(std::string(text)) {}
  Json(std::string_view text) : value_(std::string(text)) {}
  Json(std::string text) : value_(std::move(text)) {}
  template <class Element>
  Json(const std::vector<Element>& values) : value_(Array(values.begin(), values.end())) {}
  Json(const std::map<std::string, std::string>& values) : value_(Object(values.begin(), values.end())) {}
  Json(std::initializer_list<Json> elements);
  [[nodiscard]] static Json array(std::initializer_list<Json> elements = {});
  [[nodiscard]] static Json object();
  /// Represents infinities and NaN, which JSON lacks, by words; to_number() converts them back and returns NaN for
  /// anything that is neither a number nor a text.
  [[nodiscard]] static Json number(double value);
  [[nodiscard]] double to_number() const;

  /// Throws Exception with line and column.
  [[nodiscard]] static Json parse(const std::string& text);
  /// Writes on one line if `indent` is negative. Invalid UTF-8 in a text is replaced.
  [[nodiscard]] std::string dump(int indent = -1) const;

  [[nodiscard]] bool is_null() const { return std::holds_alternative<std::nullptr_t>(value_); }
  [[nodiscard]] bool is_object() const { return std::holds_alternative<Object>(value_); }
  [[nodiscard]] bool is_array() const { return std::holds_alternative<Array>(value_); }
  [[nodiscard]] bool is_string() const { return std::holds_alternative<std::string>(value_); }
  [[nodiscard]] bool is_number() const {
    return std::holds_alternative<double>(value_) || std::holds_alternative<std::int64_t>(value_);
  }

  /// Number of elements of an object or array, else 0.
  [[nodiscard]] std::size_t size() const;
  [[nodiscard]] bool empty() const { return size() == 0; }
  [[nodiscard]] bool contains(std::string_view name) const { return find(name) != nullptr; }
  [[nodiscard]] const Json& at(std::string_view name) const;
  [[nodiscard]] const Json& at(std::size_t index) const;
  /// Returns the entry and adds it if missing.
  Json& operator[](std::string_view name);
  /// Avoids an ambiguity: compilers may otherwise take the text for the array, and a number this converts to for the
  /// index.
  Json& operator[](const char* name) { return (*this)[std::string_view(name)]; }
  /// Returns an element of an array; throws Exception if there are fewer elements.
  Json& operator[](std::size_t index);
  void push_back(Json element);
  /// Adds or replaces the entries of another object.
  void update(const Json& other);
  /// Elements of an array, or values of the entries of an object.
  [[nodiscard]] Array::const_iterator begin() const { return elements().begin(); }
  [[nodiscard]] Array::const_iterator end() const { return elements().end(); }
  [[nodiscard]] const Object& items() const;

  // Values by type; numeric types are converted to one another.
  void get(bool& result) const;
  void get(int& result) const;
  void get(long& result) const;
  void get(double& result) const;
  void get(std::string& result) const;
  template <class Element>
  void get(std::vector<Element>& result) const {
    result.clear();
    for (const Json& element : elements()) result.push_back(element.get<Element>());
  }
  void get(std::map<std::string, std::string>& result) const;
  template <class Type>
  [[nodiscard]] Type get() const {
    Type result{};
    get(result);
    return result;
  }
  template <JsonValue Type>
  operator Type() const {
    return get<Type>();
  }
  /// Returns the entry, or the default if there is none.
  template <class Type>
  [[nodiscard]] Type value(std::string_view name, const Type& default_value) const {
    const Json* const found = find(name);
    return found != nullptr ? found->get<Type>() : default_value;
  }
  [[nodiscard]] std::string value(std::string_view name, const char* default_value) const {
    return value(name, std::string(default_value));
  }
  [[nodiscard]] Json value(std::string_view name, const Json& default_value) const {
    const Json* const found = find(name);
    return found != nullptr ? *found : default_value;
  }

 private:
  friend struct JsonConversion;
  [[nodiscard]] const Json* find(std::string_view name) const;
  [[nodiscard]] const Array& elements() const;

  std::variant<std::nullptr_t, bool, std::int64_t, double, std::string, Array, Object> value_ = nullptr;
};

}  // namespace ricochet
