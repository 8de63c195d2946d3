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

TEST(Text, TheNearestNameIsOneThatMayHaveBeenMeant) {
  const std::vector<std::string> names{"step", "scheme", "end", "top.displacement_x", "top.gap", "t"};
  EXPECT_EQ(nearest_name("stp", names), "step");
  EXPECT_EQ(nearest_name("shceme", names), "scheme");
  EXPECT_EQ(nearest_name("something", names), "");
  EXPECT_EQ(nearest_name("x", names), "") << "one letter is near to every other";
  EXPECT_EQ(nearest_name("", names), "");
  EXPECT_EQ(nearest_name("tpo.displacment_x", names), "top.displacement_x");
  EXPECT_EQ(nearest_name("topgap", names), "top.gap") << "the dot itself may be missing";
  // A long component does not bring a short one near.
  EXPECT_EQ(nearest_name("f.displacement_x", names), "");
  EXPECT_EQ(nearest_name("foot.displacement_x", names), "");
  EXPECT_EQ(nearest_name("side.displacement_x", names), "");
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

TEST(FormOf, IsTheSameForTheSameOfDifferentPlaces) {
  EXPECT_EQ(message_pattern("at t = 1.25e-05 a node at (-0.5, 2, 1e+3) is 3% inside of \"floor 2\", body 7 of x1."),
            "at t = 0 a node at (0, 0, 0) is 0% inside of \"floor 2\", body 0 of x1.");
  EXPECT_EQ(message_pattern("no number - none, and not the first-hand one; 12."),
            "no number - none, and not the first-hand one; 0.");
  EXPECT_NE(message_pattern("in \"a1\""), message_pattern("in \"a2\""));
}

}  // namespace
}  // namespace ricochet
