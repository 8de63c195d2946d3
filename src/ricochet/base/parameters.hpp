#pragma once

#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "ricochet/base/keys.hpp"

/// @file Values of the keys of a type, and how a type checks them while a case file is read.
namespace ricochet {

/// Arguments from which a registered type is made: values by the names of its keys. Numbers are doubles, also those of
/// integers: {{"beta", 0.25}, {"stages", 2.0}}.
class Parameters {
 public:
  using Value = std::variant<double, std::string, std::vector<double>>;

  Parameters() = default;
  Parameters(std::initializer_list<std::pair<const std::string, Value>> values) : values_(values) {}

  void set(const std::string& name, Value value) { values_[name] = std::move(value); }
  void erase(const std::string& name) { values_.erase(name); }
  [[nodiscard]] bool has(const std::string& name) const { return values_.contains(name); }
  /// These throw Error(invalid_input) if the value is absent or of another type.
  [[nodiscard]] double number(const std::string& name) const;
  [[nodiscard]] const std::string& text(const std::string& name) const;
  [[nodiscard]] const std::vector<double>& vector(const std::string& name) const;
  [[nodiscard]] const std::map<std::string, Value>& values() const { return values_; }
  /// Numbers by name, for expressions among the texts.
  [[nodiscard]] const std::map<std::string, double>& constants() const { return constants_; }
  void set_constants(std::map<std::string, double> constants) { constants_ = std::move(constants); }

  /// Adds the defaults of keys that have no value. Throws Error(invalid_input) that names `owner` if a required value
  /// is missing, if a value belongs to none of the keys, or if it is not admissible. (Checks that involve several keys
  /// are made when a case file is read, see Registration::check.)
  void complete(const std::vector<Key>& keys, const std::string& owner);

 private:
  std::map<std::string, Value> values_;
  std::map<std::string, double> constants_;
};

/// Returns a value as written in a case file: texts without quotes, numbers in their shortest exact form, lists as "[1,
/// 2]".
[[nodiscard]] std::string as_text(const Parameters::Value& value);

/// Access to the values of a section of a case file, for checks that involve several keys. Problems are collected and
/// reported together, each with file, line and column.
class ParameterCheck {
 public:
  virtual ~ParameterCheck() = default;
  /// Returns whether the user has written the value, in the file or by --set; it may have been refused.
  [[nodiscard]] virtual bool is_given(const std::string& name) const = 0;
  /// Returns whether the user has written the value on the command line.
  [[nodiscard]] virtual bool is_override(const std::string& name) const = 0;
  /// Returns whether there is a value, default or not, and nothing is wrong with it.
  [[nodiscard]] virtual bool is_usable(const std::string& name) const = 0;
  /// Returns "file:line:column" of the value, or of the section if the key is absent.
  [[nodiscard]] virtual std::string location(const std::string& name) const = 0;
  /// Adds a problem, for which the case is refused.
  virtual void add_problem(const std::string& name, const std::string& message) const = 0;
  /// Adds a warning; the case runs.
  virtual void add_warning(const std::string& name, const std::string& message) const = 0;
  virtual void add_info(const std::string& name, const std::string& message) const = 0;
};

}  // namespace ricochet
