#include "ricochet/simulation/history/probe_kind.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "ricochet/simulation/history/history_columns.hpp"

namespace ricochet {

// Kinds of probes, each by the registration function of its own file, in the order of the documentation.
// clang-format off
#define RICOCHET_PROBES(probe) \
  probe(point_probe)           \
  probe(segment_probe)         \
  probe(boundary_probe)        \
  probe(group_probe)           \
  probe(contact_probe)
// clang-format on

RICOCHET_DEFINE_REGISTRY(probe_registry, ProbeKind, "probe", RICOCHET_PROBES)

const Registration<ProbeKind>* find_probe_kind(const std::function<bool(const std::string&)>& has_key) {
  const auto is_it = [&](const Registration<ProbeKind>& kind) {
    const std::vector<std::string>& keys = kind.alternatives.front();
    return std::ranges::any_of(keys, has_key);
  };
  const auto& all = probe_registry().all();
  const auto found = std::ranges::find_if(all, is_it);
  return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> reserved_probe_names() {
  std::vector<std::string> names = history_column_names();
  for (const char* const name : {"momentum", "pair_force"}) names.emplace_back(name);  // of bodies and pairs
  return names;
}

namespace {

std::string column_rows(const std::vector<RowQuantity>& quantities, const std::string& prefix,
                        const std::string& condition = {}) {
  std::string text;
  for (const RowQuantity& quantity : quantities) {
    const auto by_components = [&](const char* one, const char* axial, const char* vector) {
      return quantity.components == ColumnComponents::one     ? one
             : quantity.components == ColumnComponents::axial ? axial
                                                              : vector;
    };
    text += fmt::format("| `{}{}{}`{} | {} | {}{}{} | {} |\n", prefix, quantity.name, by_components("", "_z", "_x"),
                        by_components("", " (in 3D three)", " …"), quantity.unit, condition,
                        condition.empty() || quantity.condition_text.empty() ? "" : ", ", quantity.condition_text,
                        quantity.text);
  }
  return text;
}

}  // namespace

std::string column_reference() {
  std::string text = "| column | unit | only with | meaning |\n|---|---|---|---|\n";
  text += column_rows(documentation_of(history_quantities()), "");
  text += column_rows(free_body_quantities(), "NAME.",
                      "[rigid bodies that move freely](obstacles.md#bodies-that-move-freely)");
  text += column_rows(pair_force_quantities(), "pair_force.N");
  for (const Registration<ProbeKind>& kind : probe_registry().all())
    text += column_rows(kind.type.quantities, "NAME.", fmt::format("probes with `{}`", kind.name));
  return text;
}

}  // namespace ricochet
