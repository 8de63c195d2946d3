#include "ricochet/base/text.hpp"

#include <gtest/gtest.h>

namespace ricochet {
namespace {

TEST(Text, CountedNouns) {
  EXPECT_EQ(counted(0, "node"), "0 nodes");
  EXPECT_EQ(counted(1, "node"), "1 node");
  EXPECT_EQ(counted(std::size_t{2}, "node"), "2 nodes");
  EXPECT_EQ(counted(1L, "entry", "entries"), "1 entry");
  EXPECT_EQ(counted(0L, "entry", "entries"), "0 entries");
  EXPECT_EQ(counted(12L, "entry", "entries"), "12 entries");
}

}  // namespace
}  // namespace ricochet
