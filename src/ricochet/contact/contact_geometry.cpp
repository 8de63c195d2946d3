#include "ricochet/contact/contact_geometry.hpp"

#include <algorithm>

namespace ricochet {

namespace {

class CombinedGeometry final : public ContactGeometry {
 public:
  explicit CombinedGeometry(std::vector<std::unique_ptr<ContactGeometry>> parts) : parts_(std::move(parts)) {}

  void gaps(const Vector& displacement, double time, Vector& gap) const override {
    for (const auto& part : parts_) part->gaps(displacement, time, gap);
  }
  void node_gaps(const Vector& displacement, double time, Vector& gap) const override {
    for (const auto& part : parts_) part->node_gaps(displacement, time, gap);
  }
  [[nodiscard]] bool has_node(Index entry) const override {
    return std::ranges::any_of(parts_, [entry](const auto& part) { return part->has_node(entry); });
  }
  [[nodiscard]] SpaceVector node_normal(Index entry, const Vector& displacement, double time) const override {
    for (const auto& part : parts_) {
      if (part->has_node(entry)) return part->node_normal(entry, displacement, time);
    }
    return parts_.front()->node_normal(entry, displacement, time);
  }
  void update(const Vector& displacement, double time, const StepStart* start, ContactRows& rows) const override {
    for (const auto& part : parts_) part->update(displacement, time, start, rows);
  }
  void prepare_update(const Vector& displacement, double time, const StepStart* start,
                      ContactRows& rows) const override {
    for (const auto& part : parts_) part->prepare_update(displacement, time, start, rows);
  }
  void begin_step() const override {
    for (const auto& part : parts_) part->begin_step();
  }
  bool freeze() const override {
    bool any = false;
    for (const auto& part : parts_) any = part->freeze() || any;
    return any;
  }
  void end_step() const override {
    for (const auto& part : parts_) part->end_step();
  }
  [[nodiscard]] bool is_frozen() const override {
    return std::ranges::any_of(parts_, [](const auto& part) { return part->is_frozen(); });
  }
  [[nodiscard]] bool has_frozen() const override {
    return std::ranges::any_of(parts_, [](const auto& part) { return part->has_frozen(); });
  }
  void allow_overlap(Vector& gap) const override {
    for (const auto& part : parts_) part->allow_overlap(gap);
  }
  void deactivate_points(std::vector<char>& eligible) const override {
    for (const auto& part : parts_) part->deactivate_points(eligible);
  }
  void add_couples(const Vector& displacement, const ContactRows& rows, const Vector& normal, const Vector& tangential,
                   Vector& force) const override {
    for (const auto& part : parts_) part->add_couples(displacement, rows, normal, tangential, force);
  }
  [[nodiscard]] long projection_count() const override {
    long count = 0;
    for (const auto& part : parts_) count += part->projection_count();
    return count;
  }
  [[nodiscard]] Index row_value_count() const override {
    Index count = 0;
    for (const auto& part : parts_) count += part->row_value_count();
    return count;
  }
  [[nodiscard]] Vector row_values(const ContactRows& rows) const override {
    Vector result(row_value_count());
    Index first = 0;
    for (const auto& part : parts_) {
      result.segment(first, part->row_value_count()) = part->row_values(rows);
      first += part->row_value_count();
    }
    return result;
  }
  void restore(const Points& normals, const Vector& gap, const Vector& row_values, ContactRows& rows) const override {
    Index first = 0;
    for (const auto& part : parts_) {
      part->restore(normals, gap, row_values.segment(first, part->row_value_count()), rows);
      first += part->row_value_count();
    }
  }

 private:
  std::vector<std::unique_ptr<ContactGeometry>> parts_;
};

}  // namespace

std::unique_ptr<ContactGeometry> combine(std::vector<std::unique_ptr<ContactGeometry>> parts) {
  return parts.size() == 1 ? std::move(parts.front()) : std::make_unique<CombinedGeometry>(std::move(parts));
}

}  // namespace ricochet
