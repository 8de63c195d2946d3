#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "ricochet/base/text.hpp"
#include "ricochet/case/keys_check.hpp"

namespace ricochet {

void DimensionCheck::note(const Key& key, const std::string& title, const TomlNode& value) {
  const std::string name = fmt::format("\"{}\" of {}", key.name, title);
  const bool is_list = value.kind == TomlNode::Kind::list;
  if (key.type == KeyType::axial || key.type == KeyType::axial_formulas) {
    vectors_.push_back({value.location, name, is_list ? 3U : 2U,
                        is_list ? "is a vector, as in three dimensions" : "is a number, as in two dimensions"});
  } else if (is_list && (key.type == KeyType::vector || key.type == KeyType::formulas)) {
    const std::size_t size = value.children.size();
    vectors_.push_back({value.location, name, size, fmt::format("has {}", counted(size, "entry", "entries"))});
  }
  if (key.type == KeyType::components) {
    for (const TomlNode& component : value.children) {
      if (component.text == key.choices.back()) third_components_.push_back(component.location);
    }
  }
}

void DimensionCheck::run(Problems& problems) {
  if (vectors_.empty()) return;
  // Values of --set come after those of the file, whatever they refer to.
  const auto before = [](const Found& a, const Found& b) {
    const bool a_is_override = a.location.line == 0, b_is_override = b.location.line == 0;
    return std::tie(a_is_override, a.location.line, a.location.column) <
           std::tie(b_is_override, b.location.line, b.location.column);
  };
  std::ranges::stable_sort(vectors_, before);
  const Found& first = vectors_.front();
  for (const Found& vector : vectors_) {
    if (vector.dimension == first.dimension) continue;
    const std::string of_first = first.what.starts_with("has ") ? fmt::format("has {}", first.dimension) : first.what;
    problems.add(vector.location,
                 fmt::format("{} {}, but {} at {} {}: all vectors must have as many entries as the mesh has dimensions",
                             vector.name, vector.what, first.name, first.location.text(), of_first));
  }
  for (const SourceLocation& location : third_components_) {
    if (first.dimension == 2)
      problems.add(location, fmt::format("there is no component \"z\" in two dimensions: {} at {} {}", first.name,
                                         first.location.text(), first.what));
  }
}

}  // namespace ricochet
