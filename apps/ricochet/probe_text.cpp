#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "ricochet/base/text.hpp"
#include "texts.hpp"

namespace ricochet::program {

namespace {

/// Nodes of one [[probe]]: the entries from `first` up to, but excluding, `last`.
struct ProbeNodes {
  std::string name;
  std::size_t first, last;
  bool is_segment;
};

/// Returns the probes. The name of a probe has no dot; the nodes of a segment are called NAME.0, NAME.1 and so on.
std::vector<ProbeNodes> probes_of(const RunSummary& summary) {
  std::vector<ProbeNodes> result;
  for (std::size_t i = 0; i < summary.probes.size(); ++i) {
    const std::string& full = summary.probes[i].probe.name;
    const std::string name = full.substr(0, full.find('.'));
    const bool is_segment = name.size() < full.size();
    if (is_segment && !result.empty() && result.back().is_segment && result.back().name == name) {
      result.back().last = i + 1;
    } else {
      result.push_back({name, i, i + 1, is_segment});
    }
  }
  return result;
}

std::string probe_position_text(const RunSummary& summary, std::size_t probe) {
  const std::vector<double>& at = summary.probes[probe].position;
  return vector_text(Eigen::Map<const Vector>(at.data(), static_cast<Index>(at.size())));
}

/// Returns true if the force of a probe has a digest; probes with rows of their own have none.
bool has_force(const RunSummary& summary, const Probe& probe) {
  return probe.contact_node >= 0 && std::find(summary.columns.begin(), summary.columns.end(),
                                              probe.name + ".reaction_normal") != summary.columns.end();
}

}  // namespace

void print_probes(const RunSummary& summary) {
  for (const ProbeNodes& probe : probes_of(summary)) {
    if (probe.is_segment) {
      fmt::print("  probe \"{}\": {} from {} to {}", probe.name, counted(probe.last - probe.first, "node"),
                 probe_position_text(summary, probe.first), probe_position_text(summary, probe.last - 1));
    } else {
      fmt::print("  probe \"{}\": its node is {:.3g} from the requested position", probe.name,
                 summary.probes[probe.first].probe.distance);
    }
    ColumnDigest hardest;
    bool any = false;
    for (std::size_t i = probe.first; i < probe.last; ++i) {
      if (!has_force(summary, summary.probes[i].probe)) continue;
      const ColumnDigest force = summary.digest(summary.probes[i].probe.name + ".reaction_normal");
      if (!any || force.maximum > hardest.maximum) hardest = force;
      any = true;
    }
    if (any) {
      fmt::print(", largest contact force {}{:.6g}", probe.is_segment ? "on a node " : "", hardest.maximum);
      if (!probe.is_segment) {
        const bool skips = summary.history_every > 1;
        fmt::print(", total variation {}{:.4g}", skips ? "≥ " : "", hardest.total_variation);
        if (skips) fmt::print(" (from one row every {} steps)", summary.history_every);
      }
    }
    fmt::print("\n");
  }
  for (const auto& [name, sums] : summary.probe_sums) fmt::print("  probe \"{}\": {}\n", name, sums);
}

}  // namespace ricochet::program
