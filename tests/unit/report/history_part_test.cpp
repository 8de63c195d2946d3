#include "ricochet/report/history_part.hpp"

#include <gtest/gtest.h>

#include <random>

namespace ricochet {
namespace {

HistoryTable table(int rows) {
  HistoryTable history;
  history.names = {"step", "time", "noise"};
  std::mt19937 random(3);
  std::normal_distribution<double> noise;
  for (int i = 0; i < rows; ++i) {
    history.columns["step"].push_back(i);
    history.columns["time"].push_back(1e-4 * i);
    history.columns["noise"].push_back(noise(random));
  }
  return history;
}

TEST(HistoryPart, KeepsAllRowsThatFit) {
  PackedArrays arrays;
  const HistoryPart part = pack_history(table(1000), 100'000, arrays);
  EXPECT_EQ(part.rows_per_pair, 0);
  EXPECT_EQ(part.table.rows, 3);
  EXPECT_EQ(part.table.columns, 1000);
}

TEST(HistoryPart, IsThinnedToTheBytesThatThereAre) {
  PackedArrays arrays;
  const HistoryPart part = pack_history(table(200'000), 100'000, arrays);
  EXPECT_GT(part.rows_per_pair, 2);
  EXPECT_EQ(part.table.columns, 2 * ((200'000 + part.rows_per_pair - 1) / part.rows_per_pair));
  EXPECT_LE(arrays.page_bytes(), 105'000U);
  EXPECT_GT(arrays.page_bytes(), 30'000U) << "but not more than that";
}

}  // namespace
}  // namespace ricochet
