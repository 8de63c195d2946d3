#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

#include "ricochet/base/text.hpp"
#include "ricochet/mesh/build_mesh.hpp"
#include "ricochet/mesh/gmsh_elements.hpp"
#include "ricochet/mesh/offenders.hpp"

namespace ricochet::gmsh {

namespace {

/// Returns what to do about elements that cannot be used.
std::string advice(int number, int degree) {
  if (number == 16 || number == 17)
    return "set Mesh.SecondOrderIncomplete = 0 in Gmsh to get the full second-order element";
  if (degree > 2) return "mesh with order 1 or 2";
  return fmt::format("cells must be {} of order 1 or 2", names_of_cells());
}

void refuse_unsupported(const RawMesh& raw, int dimension, const std::string& source) {
  std::map<int, std::size_t> counts;
  for (const RawElements& elements : raw.elements) {
    const ElementType& type = *find_element_type(elements.type);
    const bool used = type.dimension == dimension || (type.dimension == dimension - 1 && !elements.groups.empty());
    if (used && !type.shape && !elements.tags.empty()) counts[elements.type] += elements.tags.size();
  }
  std::string message;
  for (const auto& [number, count] : counts) {
    message += fmt::format("{}{} of {}", message.empty() ? "" : ", ", counted(count, "element"), describe_type(number));
  }
  if (message.empty()) return;
  const int number = counts.begin()->first;
  fail_mesh(source, fmt::format("not supported: {}; {}", message, advice(number, find_element_type(number)->degree)));
}

void check_element_tags(const RawMesh& raw, const std::string& source) {
  std::vector<std::int64_t> tags;
  for (const RawElements& elements : raw.elements) tags.insert(tags.end(), elements.tags.begin(), elements.tags.end());
  Offenders not_positive;
  for (const std::int64_t tag : tags) {
    if (tag <= 0) not_positive.add(tag);
  }
  if (not_positive.any())
    fail_mesh(source, fmt::format("element numbers must be positive; found {}", not_positive.text("element")));
  if (!std::ranges::is_sorted(tags)) std::ranges::sort(tags);
  Offenders repeated;
  for (std::size_t i = 1; i < tags.size(); ++i) {
    if (tags[i] == tags[i - 1] && (i == 1 || tags[i - 2] != tags[i])) repeated.add(tags[i]);
  }
  if (repeated.any())
    fail_mesh(source,
              fmt::format("element numbers must be unique; found more than once: {}", repeated.text("element")));
}

void check_degree(const Selection& selection, const std::string& source) {
  std::map<int, std::size_t> counts;
  for (const auto* list : {&selection.cells, &selection.facets}) {
    for (const RawElements* elements : *list) counts[elements->type] += elements->tags.size();
  }
  std::set<int> degrees;
  std::vector<std::string> names;
  for (const auto& [number, count] : counts) {
    degrees.insert(find_element_type(number)->degree);
    names.push_back(fmt::format("{} of {}", count, describe_type(number)));
  }
  if (degrees.size() > 1) {
    fail_mesh(source, fmt::format("the mesh has elements of first and second order ({}); all must have the same order",
                                  join_names(names, " and ", false)));
  }
}

}  // namespace

Selection select_elements(const RawMesh& raw, const std::string& source) {
  Selection selection;
  std::size_t count = 0;
  for (const RawElements& elements : raw.elements) {
    if (elements.tags.empty()) continue;
    count += elements.tags.size();
    selection.dimension = std::max(selection.dimension, find_element_type(elements.type)->dimension);
  }
  if (raw.node_tags.empty()) fail_mesh(source, "the mesh has no nodes");
  if (selection.dimension < 2) {
    fail_mesh(source, count == 0
                          ? std::string("the mesh has no elements")
                          : fmt::format("the mesh has {}, but none of dimension 2 or 3; if the geometry has surfaces "
                                        "or volumes, check that they are meshed and in a physical group",
                                        counted(count, "element")));
  }
  check_element_tags(raw, source);
  refuse_unsupported(raw, selection.dimension, source);
  for (const RawElements& elements : raw.elements) {
    const ElementType& type = *find_element_type(elements.type);
    if (elements.tags.empty()) continue;
    if (type.dimension == selection.dimension) selection.cells.push_back(&elements);
    if (type.dimension == selection.dimension - 1 && !elements.groups.empty()) selection.facets.push_back(&elements);
  }
  check_degree(selection, source);
  selection.degree = find_element_type(selection.cells.front()->type)->degree;
  return selection;
}

void add_groups(const RawMesh& raw, const std::string& source, Mesh& mesh) {
  std::map<std::pair<int, int>, std::string> names = raw.physical_names;
  for (const RawElements& elements : raw.elements) {
    for (const int tag : elements.groups) names.try_emplace({find_element_type(elements.type)->dimension, tag}, "");
  }
  std::map<std::pair<int, std::string>, int> tags;
  for (const auto& [key, name] : names) {
    const auto& [dimension, tag] = key;
    Group group{name.empty() ? std::to_string(tag) : name, tag, dimension, {}};
    const auto [other, is_new] = tags.try_emplace({dimension, group.name}, tag);
    if (!is_new) {
      fail_mesh(source, fmt::format("physical groups {} and {} of dimension {} are both called \"{}\"", other->second,
                                    tag, dimension, group.name));
    }
    mesh.groups.push_back(std::move(group));
  }
}

}  // namespace ricochet::gmsh
