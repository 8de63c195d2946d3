#include "ricochet/base/large_vector.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace ricochet {
namespace {

TEST(LargeVector, BeginsWithAHugePageWhereItHasSome) {
  constexpr std::uintptr_t huge_page = std::uintptr_t{2} << 20;
  LargeVector<float> small(7, 1.5F), large(std::size_t{3} << 20, 2.5F);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(large.data()) % huge_page, 0U);
  const LargeVector<float> copy = large;
  EXPECT_EQ(copy, large);
  EXPECT_NE(copy.data(), large.data());
  small.resize(std::size_t{2} << 20, 3.5F);
  EXPECT_EQ(small[6], 1.5F);
  EXPECT_EQ(small.back(), 3.5F);
  EXPECT_TRUE(LargeVector<int>().empty());
}

}  // namespace
}  // namespace ricochet
