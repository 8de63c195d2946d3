#pragma once

#include <cstddef>
#include <utility>

/// @file Number of the members of an aggregate, for lists of members that must be complete.
namespace ricochet::test_support {

struct AnyMember {
  template <class Member>
  operator Member() const;
};

template <class Aggregate, std::size_t... index>
[[nodiscard]] constexpr bool has_members(std::index_sequence<index...>) {
  return requires { Aggregate{(void(index), AnyMember{})...}; };
}

/// Number of members, plus one for each base.
template <class Aggregate, std::size_t count = 0>
[[nodiscard]] constexpr std::size_t member_count() {
  if constexpr (has_members<Aggregate>(std::make_index_sequence<count + 1>{})) {
    return member_count<Aggregate, count + 1>();
  } else {
    return count;
  }
}

/// Counts the members that a list passes to its visitor.
struct MemberCounter {
  std::size_t count = 0;
  template <class Rule, class... Members>
  void operator()(Rule, const Members&...) {
    count += sizeof...(Members);
  }
};
template <class Aggregate>
[[nodiscard]] std::size_t listed_count(const Aggregate& aggregate) {
  MemberCounter counter;
  persist(counter, aggregate);
  return counter.count;
}

}  // namespace ricochet::test_support
