#include "ricochet/io/summary_visitor.hpp"

namespace ricochet {

namespace {

Json schema_of(const char* type) {
  Json schema = Json::object();
  schema["type"] = type;
  return schema;
}

void allow(Json& schema, const char* type) {
  Json& types = schema["type"];
  if (!types.is_array()) types = Json::array({types});
  types.push_back(type);
}

}  // namespace

Json& SummaryVisitor::entry(const char* name, bool required) {
  if (reads()) static_cast<void>(std::as_const(json_).at(name));
  if (task_ != Task::outline) return json_[name];
  json_["type"] = "object";
  static_cast<void>(json_["properties"][name]);
  if (!json_.contains("required")) json_["required"] = Json::array();
  if (required) json_["required"].push_back(name);
  return json_["properties"][name];
}

void SummaryVisitor::type(const char* name) {
  if (task_ == Task::outline) json_["title"] = name;
}

void SummaryVisitor::explain(const char* name, const char* text) {
  if (task_ == Task::outline) json_["properties"][name]["description"] = text;
}

void SummaryVisitor::allow_null(Json& schema) { allow(schema, "null"); }

void SummaryVisitor::require_array(const Json& json) {
  if (!json.is_array()) throw Json::Exception("an array is expected, not " + json.dump());
}

void SummaryVisitor::convert(Json& json, double& value) {
  if (reads()) {
    value = json.is_string() ? json.to_number() : json.get<double>();
  } else {
    json = task_ == Task::write ? Json::number(value) : schema_of("number");
  }
}

void SummaryVisitor::convert(Json& json, std::map<std::string, std::string>& value) {
  convert_scalar(json, value, "object");
  if (task_ == Task::outline) json["additionalProperties"] = schema_of("string");
}

void SummaryVisitor::convert_real(Json& json, double& value) {
  convert(json, value);
  if (task_ == Task::outline) allow(json, "string");
}

void SummaryVisitor::convert_components(Json& json, Eigen::Vector3d& value, int count) {
  if (task_ == Task::outline) {
    json = schema_of("array");
    return convert_real(json["items"], value[0]);
  }
  if (reads()) {
    require_array(json);
    value.setZero();
    count = int(std::min<std::size_t>(json.size(), 3));
  } else {
    json = Json(std::vector<Json>(std::size_t(count)));
  }
  for (int k = 0; k < count; ++k) convert(json[std::size_t(k)], value[k]);
}

void SummaryVisitor::convert(Json& json, Spin& spin) {
  const bool is_vector = reads() ? json.is_array() : run_.dimension == 3;
  if (is_vector) {
    convert_components(json, spin.value, 3);
  } else {
    if (reads()) spin.value.setZero();
    convert_real(json, spin.value[2]);
  }
  if (task_ != Task::outline) return;
  allow(json, "array");
  convert_real(json["items"], spin.value[2]);
}

void SummaryVisitor::convert(Json& json, Inertia& inertia) {
  if (reads() ? !json.is_array() : run_.dimension == 2) {
    convert_real(json, inertia.value(2, 2));
    if (task_ != Task::outline) return;
    allow(json, "array");
    Eigen::Vector3d row;
    return convert_components(json["items"], row, 3);
  }
  if (!reads()) json = Json(std::vector<Json>(3));
  for (Index k = 0; k < 3; ++k) {
    Eigen::Vector3d row = inertia.value.row(k);
    convert_components(json[std::size_t(k)], row, 3);
    inertia.value.row(k) = row;
  }
}

}  // namespace ricochet
