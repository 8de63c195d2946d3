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

TEST(Text, Between) {
  EXPECT_EQ(between("step-12.hdf5", "step-", ".hdf5"), "12");
  EXPECT_EQ(between("step-.hdf5", "step-", ".hdf5"), "");
  EXPECT_FALSE(between("step-12.hdf", "step-", ".hdf5"));
  EXPECT_FALSE(between("aba", "ab", "ba")) << "the two may not share a letter";
}

TEST(Text, Digits) {
  EXPECT_TRUE(is_digits("000120", 6));
  EXPECT_FALSE(is_digits("00012", 6));
  EXPECT_FALSE(is_digits("0001200", 1, 6));
  EXPECT_FALSE(is_digits("12a", 1));
  EXPECT_FALSE(is_digits("", 1));
}

}  // namespace
}  // namespace ricochet
