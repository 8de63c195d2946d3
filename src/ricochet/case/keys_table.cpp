#include "ricochet/case/keys_table.hpp"

// The table itself: its sections in their order.
namespace ricochet {

namespace {

Section top_section() {
  return {.name = "",
          .kind = SectionKind::top,
          .doc = "Before the first section.",
          .keys = {{.name = "title", .standard = "", .doc = "A line about the case, repeated in its results."}}};
}

}  // namespace

const std::vector<Section>& case_sections() {
  static const std::vector<Section> sections{
      top_section(),     mesh_section(),    material_section(), obstacle_section(),
      contact_section(), support_section(), traction_section(), load_section(),
      initial_section(), mass_section(),    time_section(),     solver_section(),
      probe_section(),   output_section(),  check_section(),    expect_section()};
  return sections;
}

}  // namespace ricochet
