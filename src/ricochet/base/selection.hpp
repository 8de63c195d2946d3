#pragma once

#include <algorithm>
#include <vector>

#include "ricochet/base/types.hpp"

/// @file Subsets: lists of numbers and the values that belong to them.
namespace ricochet {

template <class Value>
[[nodiscard]] std::vector<Value> chosen(const std::vector<Value>& values, const std::vector<Index>& indices) {
  std::vector<Value> result;
  if (values.empty()) return result;
  result.reserve(indices.size());
  for (const Index i : indices) result.push_back(values[std::size_t(i)]);
  return result;
}
[[nodiscard]] inline Vector chosen(const Vector& values, const std::vector<Index>& indices) { return values(indices); }
[[nodiscard]] inline Points chosen_columns(const Points& values, const std::vector<Index>& indices) {
  return values(Eigen::all, indices);
}

/// Position of a number in an ascending list, or −1.
[[nodiscard]] inline Index index_in(const std::vector<Index>& numbers, Index number) {
  const auto found = std::ranges::lower_bound(numbers, number);
  return found != numbers.end() && *found == number ? found - numbers.begin() : Index{-1};
}
/// Positions of those members that are in the list, in the order of `members`.
[[nodiscard]] inline std::vector<Index> indices_in(const std::vector<Index>& members,
                                                   const std::vector<Index>& numbers) {
  std::vector<Index> result;
  for (const Index member : members) {
    if (const Index place = index_in(numbers, member); place >= 0) result.push_back(place);
  }
  return result;
}
/// For each number below `count`, its position in a list, or −1.
[[nodiscard]] inline std::vector<Index> inverse_indices(const std::vector<Index>& numbers, Index count) {
  std::vector<Index> result(static_cast<std::size_t>(count), -1);
  for (std::size_t i = 0; i < numbers.size(); ++i) result[std::size_t(numbers[i])] = Index(i);
  return result;
}

}  // namespace ricochet
