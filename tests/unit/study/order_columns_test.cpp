#include "ricochet/study/order_columns.hpp"

#include <gtest/gtest.h>

namespace ricochet {
namespace {

using Bools = std::vector<bool>;

TEST(IdleOrders, AreThoseOfErrorsThatNoLongerFall) {
  EXPECT_EQ(find_stagnant_orders("time.step", {2.0, 1.9, 0.4, 0.05, -2.7}), (Bools{false, false, false, true, true}));
  // A smaller step is finer, whatever the orders are.
  EXPECT_EQ(find_stagnant_orders("time.step", {-2.7, -4.2}), (Bools{true, true}));
}

TEST(IdleOrders, FollowNumbersOfCellsTheOtherWay) {
  EXPECT_EQ(find_stagnant_orders("mesh.cells", {-2.0, -1.9, 0.3}), (Bools{false, false, true}));
  EXPECT_EQ(find_stagnant_orders("mesh.size", {2.0, 1.9, -0.3}), (Bools{false, false, true}));
  EXPECT_TRUE(find_stagnant_orders("mesh.size", {}).empty());
}

}  // namespace
}  // namespace ricochet
