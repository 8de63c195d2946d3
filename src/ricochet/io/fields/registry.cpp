#include <algorithm>

#include "ricochet/io/fields/field_source.hpp"

namespace ricochet {

std::unique_ptr<FieldSource> make_motion_fields(const FieldContext& context);
std::unique_ptr<FieldSource> make_contact_fields(const FieldContext& context);
std::unique_ptr<FieldSource> make_stress_fields(const FieldContext& context);
std::unique_ptr<FieldSource> make_stretch_fields(const FieldContext& context);

namespace {

struct FieldRegistration {
  std::vector<std::string> names;
  std::unique_ptr<FieldSource> (*make)(const FieldContext& context);
};

const std::vector<FieldRegistration>& registrations() {
  static const std::vector<FieldRegistration> all{
      {{"displacement", "velocity", "acceleration"}, make_motion_fields},
      {{"contact_pressure", "friction_traction", "gap", "contact_status", "nominal_contact_pressure",
        "nominal_friction_traction"},
       make_contact_fields},
      {{"stress", "von_mises", "principal_stress", "strain_energy_density", "nodal_stress", "nodal_von_mises",
        "nodal_principal_stress"},
       make_stress_fields},
      {{"principal_stretch_1", "principal_stretch_2", "principal_stretch_3"}, make_stretch_fields},
  };
  return all;
}

}  // namespace

bool FieldContext::is_requested(const std::string& name) const {
  return std::ranges::find(requested, name) != requested.end();
}

bool FieldContext::any_is_requested(const std::vector<std::string>& names) const {
  return std::ranges::any_of(names, [this](const std::string& name) { return is_requested(name); });
}

std::vector<std::unique_ptr<FieldSource>> make_field_sources(const FieldContext& context) {
  std::vector<std::unique_ptr<FieldSource>> result;
  for (const FieldRegistration& entry : registrations()) {
    if (context.any_is_requested(entry.names)) result.push_back(entry.make(context));
  }
  return result;
}

std::vector<std::string> field_names() {
  std::vector<std::string> result;
  for (const FieldRegistration& entry : registrations())
    result.insert(result.end(), entry.names.begin(), entry.names.end());
  return result;
}

std::vector<std::string> expand_field_names(const std::vector<std::string>& names) {
  if (std::ranges::find(names, "all") != names.end()) return field_names();
  if (!names.empty()) return names;
  return {"displacement", "velocity", "contact_pressure", "friction_traction", "gap", "contact_status", "von_mises"};
}

void copy_vector(const DisplacementSpace& space, const Vector& values, std::vector<double>& field) {
  const Index d = space.dimension;
  for (Index node = 0; node < space.node_count(); ++node) {
    double* const to = field.data() + 3 * space.number[std::size_t(node)];
    for (Index k = 0; k < d; ++k) to[k] = values[node * d + k];
  }
}

}  // namespace ricochet
