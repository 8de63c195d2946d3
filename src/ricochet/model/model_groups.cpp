#include <fmt/format.h>

#include <algorithm>

#include "ricochet/base/error.hpp"
#include "ricochet/case/problems.hpp"
#include "ricochet/mesh/derived_groups.hpp"
#include "ricochet/model/model_parts.hpp"

/// @file Completion of the mesh by the groups that a case names.
namespace ricochet {

namespace {

/// Returns true if a name matches a pattern, in which each * stands for any characters.
bool fits_pattern(std::string_view name, std::string_view pattern) {
  if (pattern.find('*') == std::string_view::npos) return name == pattern;
  std::size_t at = 0, in = 0, star = std::string_view::npos, resume = 0;
  while (at < name.size()) {
    if (in < pattern.size() && pattern[in] == '*') {
      star = in++;
      resume = at;
    } else if (in < pattern.size() && pattern[in] == name[at]) {
      ++in;
      ++at;
    } else if (star != std::string_view::npos) {
      in = star + 1;
      at = ++resume;
    } else {
      return false;
    }
  }
  while (in < pattern.size() && pattern[in] == '*') ++in;
  return in == pattern.size();
}

class GroupCompleter {
 public:
  GroupCompleter(const Case& input, Mesh& mesh) : input_(input), mesh_(mesh) {}

  void require(const std::string& key_path, const std::string& group, int dimension) {
    const std::vector<std::string> names = names_in(group);
    bool all_there = true;
    for (const std::string& name : names) {
      add_built_in_group(mesh_, name, dimension);
      try {
        (void)mesh_.group(name, dimension);
      } catch (const Error& problem) {
        problems_.add(input_.where(key_path), problem.what());
        all_there = false;
      }
    }
    if (all_there && names.size() > 1) add_union(key_path, group, names, dimension);
  }

  /// Requires a group of cells or, failing that, of facets.
  void require_any(const std::string& key_path, const std::string& group) {
    const std::vector<std::string> names = names_in(group);
    const auto are_groups = [&](int dimension) {
      return std::ranges::all_of(names, [&](const std::string& name) {
        return is_built_in_group(mesh_, name, dimension) || mesh_.find_group(name, dimension) != nullptr;
      });
    };
    const bool of_facets = !are_groups(mesh_.dimension) && are_groups(mesh_.dimension - 1);
    require(key_path, group, of_facets ? mesh_.dimension - 1 : mesh_.dimension);
  }

  /// Requires surfaces of bodies: groups of facets, or the surfaces that "all" and patterns stand for, added under that
  /// name.
  void require_surfaces(const std::string& key_path, const std::string& group) {
    for (const std::string& name : names_in(group)) add_surfaces(name);
    require(key_path, group, mesh_.dimension - 1);
  }

  void raise() { problems_.raise(); }

 private:
  [[nodiscard]] std::vector<std::string> names_in(const std::string& group) const {
    const auto list = input_.group_lists.find(group);
    return list != input_.group_lists.end() ? list->second : std::vector<std::string>{group};
  }

  /// Adds the boundary of all cells or, for a pattern, the union of the facet groups that match, else the boundary of
  /// the parts and cell groups that match. Does nothing if none match or a group of facets has that name.
  void add_surfaces(const std::string& name) {
    const int facets = mesh_.dimension - 1;
    if (mesh_.find_group(name, facets) != nullptr || is_built_in_group(mesh_, name, facets)) return;
    std::vector<char> cells(static_cast<std::size_t>(mesh_.cell_count()), name == all_cells_name ? 1 : 0);
    std::vector<std::string> fitting;
    const auto add_cells = [&](const std::vector<Index>& members) {
      for (const Index cell : members) cells[std::size_t(cell)] = 1;
    };
    for (const Group& group : mesh_.groups) {
      if (!fits_pattern(group.name, name)) continue;
      if (group.dimension == facets) fitting.push_back(group.name);
      if (group.dimension == mesh_.dimension) add_cells(group.members);
    }
    for (const MeshPart& part : mesh_.parts) {
      if (fits_pattern(part.name, name)) add_cells(part.cells);
    }
    if (!fitting.empty()) {
      add_union_of_groups(mesh_, name, fitting, facets);
    } else if (std::ranges::find(cells, 1) != cells.end()) {
      add_boundary_of_cells(mesh_, name, cells);
    }
  }

  void add_union(const std::string& key_path, const std::string& group, const std::vector<std::string>& names,
                 int dimension) {
    const bool made_before = std::ranges::find(unions_, std::pair{group, dimension}) != unions_.end();
    if (!made_before && mesh_.find_group(group, dimension) != nullptr) {
      problems_.add(
          input_.where(key_path),
          fmt::format("{}: the mesh has a group whose name is the whole list, \"{}\"; write the list in another order",
                      mesh_.source, group));
      return;
    }
    add_union_of_groups(mesh_, group, names, dimension);
    unions_.emplace_back(group, dimension);
  }

  const Case& input_;
  Mesh& mesh_;
  Problems problems_;
  std::vector<std::pair<std::string, int>> unions_;
};

}  // namespace

void complete_groups(const Case& input, Mesh& mesh) {
  GroupCompleter groups(input, mesh);
  const auto require_boundaries = [&](const char* section, const auto& entries) {
    for (std::size_t i = 0; i < entries.size(); ++i)
      groups.require(fmt::format("{}.{}.group", section, i), entries[i].group, mesh.dimension - 1);
  };
  for (std::size_t i = 0; i < input.materials.size(); ++i)
    groups.require(fmt::format("material.{}.group", i), input.materials[i].group, mesh.dimension);
  for (std::size_t i = 0; i < input.contacts.size(); ++i) {
    const ContactSection& contact = input.contacts[i];
    const std::string key = fmt::format("contact.{}.", i);
    if (contact.is_of_all_pairs()) {
      groups.require_surfaces(key + "group", contact.group);
    } else {
      groups.require(key + "group", contact.group, mesh.dimension - 1);
    }
    if (!contact.against.empty()) groups.require(key + "against", contact.against, mesh.dimension - 1);
  }
  require_boundaries("support", input.supports);
  require_boundaries("traction", input.tractions);
  require_boundaries("pressure", input.pressures);
  for (const MotionSection& motion : input.motions) {
    if (!motion.group.empty()) groups.require(motion.section + ".group", motion.group, mesh.dimension);
  }
  for (std::size_t i = 0; i < input.probes.size(); ++i) {
    const ProbeSection& probe = input.probes[i];
    const Registration<ProbeKind>& kind = probe_registry().find(probe.kind);
    for (const Key& key : kind.keys) {
      if (key.type != KeyType::groups || !probe.values.has(key.name)) continue;
      const std::string path = fmt::format("probe.{}.{}", i, key.name);
      if (kind.type.of_boundary) {
        groups.require(path, probe.values.text(key.name), mesh.dimension - 1);
      } else {
        groups.require_any(path, probe.values.text(key.name));
      }
    }
  }
  groups.raise();
}

}  // namespace ricochet
