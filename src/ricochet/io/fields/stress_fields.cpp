#include "ricochet/fem/nodal_recovery.hpp"
#include "ricochet/fem/stress.hpp"
#include "ricochet/io/fields/field_source.hpp"

namespace ricochet {

namespace {

/// Cell means, and nodal values recovered from them.
class StressFields final : public FieldSource {
 public:
  explicit StressFields(const FieldContext& context)
      : stress_of_(context.body),
        nodal_is_requested_(context.any_is_requested({"nodal_stress", "nodal_von_mises", "nodal_principal_stress"})) {
    const Index cells = context.body.mesh->cell_count(), nodes = context.body.space->node_count();
    const auto add = [&](const char* name, FieldLocation location, int components, std::vector<double>& values) {
      const Index rows = location == FieldLocation::cells ? cells : nodes;
      const bool is_requested = context.is_requested(name);
      values.assign(std::size_t(components * rows), 0.0);
      if (is_requested) fields_.push_back({name, location, components, false, rows, values.data()});
      return is_requested;
    };
    add("stress", FieldLocation::cells, tensor_components, stress_);
    von_mises_is_requested_ = add("von_mises", FieldLocation::cells, 1, von_mises_);
    principal_is_requested_ = add("principal_stress", FieldLocation::cells, 3, principal_);
    add("strain_energy_density", FieldLocation::cells, 1, energy_density_);
    if (!nodal_is_requested_) return;
    nodal_ = std::make_unique<NodalStress>(context.body);
    add("nodal_stress", FieldLocation::nodes, tensor_components, nodal_stress_);
    nodal_von_mises_is_requested_ = add("nodal_von_mises", FieldLocation::nodes, 1, nodal_von_mises_);
    nodal_principal_is_requested_ = add("nodal_principal_stress", FieldLocation::nodes, 3, nodal_principal_);
  }

  [[nodiscard]] std::vector<Field> fields() const override { return fields_; }

  void evaluate(const State& state) override {
    stress_of_.evaluate(state.displacement, stress_, energy_density_, state.internal_strain);
    if (von_mises_is_requested_) find_von_mises(stress_, von_mises_);
    if (principal_is_requested_) find_principal(stress_, principal_);
    if (!nodal_is_requested_) return;
    nodal_->evaluate(stress_, nodal_stress_);
    if (nodal_von_mises_is_requested_) find_von_mises(nodal_stress_, nodal_von_mises_);
    if (nodal_principal_is_requested_) find_principal(nodal_stress_, nodal_principal_);
  }

 private:
  static void find_von_mises(const std::vector<double>& stress, std::vector<double>& result) {
    for (std::size_t i = 0; i < result.size(); ++i) result[i] = von_mises_stress(stress.data() + tensor_components * i);
  }
  static void find_principal(const std::vector<double>& stress, std::vector<double>& result) {
    for (std::size_t i = 0; 3 * i < result.size(); ++i) {
      const std::array<double, 3> values = principal_stresses(stress.data() + tensor_components * i);
      std::ranges::copy(values, result.begin() + std::ptrdiff_t(3 * i));
    }
  }
  CellStress stress_of_;
  bool nodal_is_requested_, von_mises_is_requested_ = false, principal_is_requested_ = false;
  bool nodal_von_mises_is_requested_ = false, nodal_principal_is_requested_ = false;
  std::unique_ptr<NodalStress> nodal_;
  std::vector<Field> fields_;
  std::vector<double> stress_, von_mises_, principal_, energy_density_;
  std::vector<double> nodal_stress_, nodal_von_mises_, nodal_principal_;
};

}  // namespace

std::unique_ptr<FieldSource> make_stress_fields(const FieldContext& context) {
  return std::make_unique<StressFields>(context);
}

}  // namespace ricochet
