#include "ricochet/io/fields/field_source.hpp"

namespace ricochet {

namespace {

class MotionFields final : public FieldSource {
 public:
  explicit MotionFields(const FieldContext& context) : space_(*context.body.space) {
    add(context, "displacement", &State::displacement);
    add(context, "velocity", &State::velocity);
    add(context, "acceleration", &State::acceleration);
  }

  [[nodiscard]] std::vector<Field> fields() const override {
    std::vector<Field> result;
    for (const Motion& each : motions_)
      result.push_back({each.name, FieldLocation::nodes, 3, false, space_.node_count(), each.values.data()});
    return result;
  }
  void evaluate(const State& state) override {
    for (Motion& each : motions_) copy_vector(space_, state.*each.member, each.values);
  }

 private:
  struct Motion {
    const char* name;
    Vector State::*member;
    std::vector<double> values;
  };
  void add(const FieldContext& context, const char* name, Vector State::*member) {
    if (!context.is_requested(name)) return;
    motions_.push_back({name, member, std::vector<double>(std::size_t(3 * space_.node_count()), 0.0)});
  }

  const DisplacementSpace& space_;
  std::vector<Motion> motions_;
};

}  // namespace

std::unique_ptr<FieldSource> make_motion_fields(const FieldContext& context) {
  return std::make_unique<MotionFields>(context);
}

}  // namespace ricochet
