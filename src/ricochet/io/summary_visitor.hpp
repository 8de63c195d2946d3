#pragma once

#include <concepts>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "ricochet/base/json.hpp"
#include "ricochet/io/summary.hpp"

/// @file Visitor of the entries of summary.json. Not part of the public interface.
namespace ricochet {

/// Number that may be infinite or NaN, in a run that overflows; JSON then has "inf", "-inf" or "nan".
template <class Number>
struct Real {
  Number value;
};
template <class Number>
Real(Number&&) -> Real<Number>;

/// Vector of a body: two components in the plane.
template <class Value>
struct Components {
  Value value;
};
template <class Value>
Components(Value&&) -> Components<Value>;

/// Angular velocity in rad per unit of time: in the plane its component about z.
struct Spin {
  Eigen::Vector3d& value;
};

/// Inertia: in the plane its zz entry.
struct Inertia {
  Eigen::Matrix3d& value;
};

/// Value that is null unless it is known; reading null leaves it as it is.
template <class Value>
struct IfKnown {
  bool known;
  Value value;
};
template <class Value>
IfKnown(bool, Value&&) -> IfKnown<Value>;

/// Object with an entry for each of these keys; reading appends what the file has.
template <class Value>
struct Keyed {
  std::vector<std::pair<std::string, Value>>& values;
};
template <class Value>
Keyed(std::vector<std::pair<std::string, Value>>&) -> Keyed<Value>;

/// Writes a summary, reads it, or outlines it as a JSON Schema, by one description: a function
/// describe(SummaryVisitor&, Part&) passes each entry to the visitor, in the order of the file, with the text of the
/// reference page. Entries are values, vectors, optional ones (null if there is none), the above, and parts that have a
/// description.
class SummaryVisitor {
 public:
  enum class Task { write, read, outline };

  /// `run` is the whole summary, for parts that depend on other ones.
  SummaryVisitor(Task task, RunSummary& run, Json& json) : run_(run), json_(json), task_(task) {}

  [[nodiscard]] bool reads() const { return task_ == Task::read; }
  [[nodiscard]] RunSummary& run() const { return run_; }
  [[nodiscard]] bool has(const char* name) const { return json_.contains(name); }
  /// Names the type of this part, in schemas and in the types made of them.
  void type(const char* name);

  /// Visits an entry that every file has. Throws Json::Exception if it is missing or of another type.
  template <class Value>
  void operator()(const char* name, Value&& value, const char* text) {
    convert(entry(name, true), value);
    explain(name, text);
  }
  /// Visits an entry that follows from others: it is written, but not read.
  template <class Value>
  void derived(const char* name, Value value, const char* text) {
    if (!reads()) (*this)(name, value, text);
  }
  /// Visits an entry that is absent unless `present`; reading goes by the file instead.
  template <class Value>
  void optional(const char* name, bool present, Value&& value, const char* text) {
    if (reads() ? !has(name) : task_ == Task::write && !present) return;
    convert(entry(name, false), value);
    explain(name, text);
  }
  /// Visits an entry that is absent if there is none.
  template <class Value>
  void optional(const char* name, std::optional<Value>& value, const char* text) {
    Value own = value.value_or(Value{});
    const bool is_present = reads() ? has(name) : value.has_value();
    optional(name, is_present, own, text);
    if (reads() && is_present) value = std::move(own);
  }

 private:
  [[nodiscard]] Json& entry(const char* name, bool required);
  void explain(const char* name, const char* text);
  static void allow_null(Json& schema);
  static void require_array(const Json& json);

  void convert(Json& json, double& value);
  void convert(Json& json, std::map<std::string, std::string>& value);
  void convert(Json& json, Spin& spin);
  void convert(Json& json, Inertia& inertia);
  void convert_real(Json& json, double& value);
  void convert_components(Json& json, Eigen::Vector3d& value, int count);

  template <class Value>
  void convert_scalar(Json& json, Value& value, const char* type) {
    if (reads()) {
      json.get(value);
    } else if (task_ == Task::write) {
      json = Json(value);
    } else {
      json["type"] = type;
    }
  }
  void convert(Json& json, bool& value) { convert_scalar(json, value, "boolean"); }
  void convert(Json& json, std::string& value) { convert_scalar(json, value, "string"); }
  template <std::integral Integer>
  void convert(Json& json, Integer& value) {
    long number = long(value);
    convert_scalar(json, number, "integer");
    value = static_cast<Integer>(number);
  }
  template <class Number>
  void convert(Json& json, Real<Number>& number) {
    convert_real(json, number.value);
  }
  template <class Value>
  void convert(Json& json, Components<Value>& vector) {
    convert_components(json, vector.value, run_.dimension);
  }
  template <class Value>
  void convert(Json& json, IfKnown<Value>& value) {
    if (reads() ? json.is_null() : task_ == Task::write && !value.known) return;
    convert(json, value.value);
    if (task_ == Task::outline) allow_null(json);
  }
  template <class Value>
  void convert(Json& json, std::optional<Value>& value) {
    if (reads() ? json.is_null() : task_ == Task::write && !value) return;
    Value own = value.value_or(Value{});
    convert(json, own);
    if (reads()) value = std::move(own);
    if (task_ == Task::outline) allow_null(json);
  }
  template <class Value>
  void convert(Json& json, std::vector<Value>& values) {
    if (task_ == Task::outline) {
      Value sample{};
      json["type"] = "array";
      return convert(json["items"], sample);
    }
    if (reads()) {
      require_array(json);
      values.resize(json.size());
    } else {
      json = Json(std::vector<Json>(values.size()));
    }
    for (std::size_t i = 0; i < values.size(); ++i) convert(json[i], values[i]);
  }
  template <class Value>
  void convert(Json& json, Keyed<Value>& by_key) {
    if (task_ == Task::outline) {
      Value sample{};
      json["type"] = "object";
      return convert(json["additionalProperties"], sample);
    }
    if (reads()) {
      for (const auto& [name, ignored] : json.items()) by_key.values.emplace_back(name, Value{});
    } else {
      json = Json::object();
    }
    for (auto& [name, value] : by_key.values) convert(json[name], value);
  }
  template <class Part>
  void convert(Json& json, Part& part) {
    if (!reads()) json = Json::object();
    SummaryVisitor inner(task_, run_, json);
    describe(inner, part);
  }

  RunSummary& run_;
  Json& json_;
  Task task_;
};

/// Physical results: bodies, impacts, penetration, sliding, rotation, and the largest stress.
void describe_results(SummaryVisitor& visit, RunSummary& run);
void describe(SummaryVisitor& visit, RunSummary& run);

}  // namespace ricochet
