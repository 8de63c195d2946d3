#pragma once

#include <gtest/gtest.h>

#include <cstring>

#include <string>

#include "ricochet/base/snapshot.hpp"
#include "ricochet/simulation/simulation.hpp"

/// @file Checkpoints that are equal to the bit.
namespace ricochet::test_support {

[[nodiscard]] inline Snapshot snapshot_of(Simulation& simulation) {
  Snapshot snapshot;
  simulation.save(snapshot);
  return snapshot;
}

/// `trace`: what is compared, for the failures.
inline void expect_same(const Snapshot& expected, const Snapshot& found, const std::string& trace = {}) {
  SCOPED_TRACE(trace);
  ASSERT_EQ(expected.values().size(), found.values().size());
  for (const auto& [name, value] : expected.values()) {
    ASSERT_TRUE(found.has(name)) << name;
    const Snapshot::Value& other = found.values().at(name);
    ASSERT_EQ(value.index(), other.index()) << name;
    const auto* const reals = std::get_if<Vector>(&value);
    if (reals == nullptr) {
      EXPECT_TRUE(value == other) << name;
      continue;
    }
    const auto& others = std::get<Vector>(other);
    ASSERT_EQ(reals->size(), others.size()) << name;
    const auto bytes = sizeof(double) * std::size_t(reals->size());
    EXPECT_TRUE(bytes == 0 || std::memcmp(reals->data(), others.data(), bytes) == 0) << name;
  }
}

}  // namespace ricochet::test_support
