#include "ricochet/step/stage_members.hpp"

#include <gtest/gtest.h>

#include "support/member_count.hpp"

/// @file The lists of members are complete: a member that is missing in its list would be lost on the way between
/// ranks.
namespace ricochet {
namespace {

using test_support::listed_count;
using test_support::member_count;

TEST(StageMembers, AreAllListed) {
  constexpr std::size_t bases = 1, affine = member_count<AffineMotion>();
  EXPECT_EQ(listed_count(ContactConditions()), member_count<ContactConditions>() + 2 * (affine - 1));
  EXPECT_EQ(listed_count(MeanStart()), member_count<MeanStart>());
  EXPECT_EQ(listed_count(Stage()),
            member_count<Stage>() + (listed_count(ContactConditions()) - 1) + (listed_count(MeanStart()) - 1));
  EXPECT_EQ(listed_count(StageSolution()), member_count<StageSolution>() - bases + member_count<Reactions>());
}

TEST(ContactMembers, AreAllListed) {
  constexpr std::size_t bases = 1, geometry_and_surface = 2;
  EXPECT_EQ(listed_count(ContactRows()), member_count<ContactRows>() - bases + member_count<ContactFrames>());
  EXPECT_EQ(listed_count(ContactBoundary()), member_count<ContactBoundary>() - geometry_and_surface);
}

}  // namespace
}  // namespace ricochet
