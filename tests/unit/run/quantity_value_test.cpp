#include "ricochet/run/quantity_value.hpp"

#include <gtest/gtest.h>

#include "support/errors.hpp"

namespace ricochet::test_support {
namespace {

/// Rows at 0, 0.1, …, 0.5: a pulse from 0.1 to 0.4, the square of the time, and the number of the row.
HistoryTable pulse() {
  HistoryTable history;
  history.names = {"time", "force", "square", "count"};
  for (int row = 0; row < 6; ++row) {
    const double time = 0.1 * row;
    history.columns["time"].push_back(time);
    history.columns["force"].push_back(row == 2 || row == 3 ? 4.0 : 0.0);
    history.columns["square"].push_back(time * time);
    history.columns["count"].push_back(row);
  }
  return history;
}

/// Rounding of time differences, which are a tenth of the times, and of values up to 10.
constexpr double rounding = 1e-14;

double value(const std::string& text, const HistoryTable& history = pulse()) {
  return value_of(parse_quantity(text), history, "{\"steps\": 5, \"impacts\": [{\"velocity_after\": [1.0, 2.5]}]}");
}

std::string problem(const std::string& text, const HistoryTable& history = pulse()) {
  return message_of([&] { static_cast<void>(value(text, history)); });
}

TEST(QuantityValue, IsThatOfARowOrOfTheSummary) {
  EXPECT_EQ(value("history.count[2]"), 2.0);
  EXPECT_EQ(value("history.count[-1]"), 5.0);
  EXPECT_EQ(value("summary.steps"), 5.0);
  EXPECT_EQ(value("summary.impacts.0.velocity_after.1"), 2.5);
}

TEST(QuantityValue, IsLinearBetweenRows) {
  EXPECT_NEAR(value("history.force(t=0.125)"), 1.0, rounding);
  EXPECT_NEAR(value("history.force(t=0.35)"), 2.0, rounding);
  EXPECT_NEAR(value("history.square(t=0.15)"), 0.5 * (0.1 * 0.1 + 0.2 * 0.2), rounding);
  EXPECT_EQ(value("history.count(t=0)"), 0.0);
}

/// 0.1·3 is not 0.3 in binary, but the next row does not contribute.
TEST(QuantityValue, IsThatOfTheRowWhereTheTimeIsThatOfARow) {
  for (int row = 0; row < 6; ++row) {
    const std::string time = "0." + std::to_string(row);
    EXPECT_EQ(value("history.count(t=" + time + ")"), row);
    EXPECT_EQ(value("history.square(t=" + time + ")"), (0.1 * row) * (0.1 * row));
  }
  EXPECT_EQ(value("history.force(t=0.10000005)"), 0.0) << "within a millionth of the distance";
  EXPECT_GT(value("history.force(t=0.1000002)"), 0.0);
  EXPECT_EQ(value("history.count(t=0.50000005)"), 5.0);
}

TEST(QuantityValue, IsOfAllRowsOrOfAnInterval) {
  EXPECT_EQ(value("max(history.force)"), 4.0);
  EXPECT_EQ(value("min(history.count, 0.1, 0.35)"), 1.0);
  EXPECT_NEAR(value("max(history.count, 0.1, 0.35)"), 3.5, rounding) << "the end between two rows";
  EXPECT_NEAR(value("max(history.force, 0, 0.125)"), 1.0, rounding);
  EXPECT_NEAR(value("max_abs(history.force, 0.375, 0.5)"), 1.0, rounding);
  EXPECT_EQ(value("total_variation(history.force)"), 8.0);
  EXPECT_NEAR(value("total_variation(history.force, 0.15, 0.25)"), 2.0, rounding);
  EXPECT_NEAR(value("total_variation(history.force, 0.11, 0.12)"), 0.4, rounding) << "no row in it";
}

TEST(QuantityValue, IsAMeanOrAnIntegralOverTime) {
  EXPECT_NEAR(value("integral(history.force)"), 0.8, rounding);
  EXPECT_NEAR(value("mean(history.force)"), 1.6, rounding);
  EXPECT_NEAR(value("mean(history.force, 0.2, 0.3)"), 4.0, rounding);
  EXPECT_NEAR(value("integral(history.force, 0.15, 0.25)"), 0.05 * 3.0 + 0.05 * 4.0, rounding);
  EXPECT_NEAR(value("mean(history.count, 0.125, 0.475)"), 3.0, rounding) << "exact for what is linear";
}

/// The trapezoidal rule, also for rows at unequal distances.
TEST(QuantityValue, WeighsRowsByTheirTimes) {
  HistoryTable history;
  history.names = {"time", "a"};
  history.columns = {{"time", {0.0, 1.0, 4.0}}, {"a", {2.0, 0.0, 6.0}}};
  EXPECT_NEAR(value("integral(history.a)", history), 10.0, rounding);
  EXPECT_NEAR(value("mean(history.a)", history), 2.5, rounding);
  EXPECT_NEAR(value("history.a(t=2)", history), 2.0, rounding);
  EXPECT_NEAR(value("first_time(history.a > 3)", history), 2.5, rounding);
}

TEST(QuantityValue, IsTheTimeOfAnEvent) {
  EXPECT_NEAR(value("first_time(history.force > 1)"), 0.125, rounding);
  EXPECT_NEAR(value("last_time(history.force > 1)"), 0.375, rounding);
  EXPECT_NEAR(value("first_time(history.force > 0)"), 0.1, rounding) << "where it leaves 0";
  EXPECT_NEAR(value("first_time(history.count < 2)"), 0.0, rounding) << "from the first row on";
  EXPECT_NEAR(value("last_time(history.count < 2)"), 0.2, rounding);
  EXPECT_NEAR(value("last_time(history.count > 2)"), 0.5, rounding) << "until the last row";
  EXPECT_NEAR(value("first_time(history.force < 1, 0.2, 0.5)"), 0.375, rounding) << "the force ends";
  EXPECT_NEAR(value("first_time(history.force > 1, 0.25, 0.5)"), 0.25, rounding) << "it acts as the interval begins";
}

TEST(QuantityValue, SaysWhatThereIsNot) {
  EXPECT_EQ(problem("history.forc[0]"), "history.csv has no column \"forc\"; did you mean \"force\"?");
  EXPECT_EQ(
      no_such_column("crate.displacement_x", {"time", "crate.force", "crate.displacement_average_x", "other.force"}),
      "history.csv has no column \"crate.displacement_x\"; those of \"crate\" are \"crate.force\" and "
      "\"crate.displacement_average_x\"");
  EXPECT_EQ(no_such_column("rocket.fuel", {"time", "crate.force"}), "history.csv has no column \"rocket.fuel\"");
  for (const auto& [quantity, column] :
       std::initializer_list<std::pair<const char*, const char*>>{{"history.time[0]", "time"},
                                                                  {"max(history.low.gap)", "low.gap"},
                                                                  {"summary.extrema.low.gap.maximum", "low.gap"},
                                                                  {"summary.extrema.time.last", "time"},
                                                                  {"summary.extrema.time", ""},
                                                                  {"summary.steps", ""}})
    EXPECT_EQ(required_column(parse_quantity(quantity)), column) << quantity;
  EXPECT_EQ(problem("history.force[6]"), "history.force[6]: history.csv has 6 rows");
  for (const std::string quantity : {"history.force(t=0.6)", "max(history.force, 0.4, 0.6)"})
    EXPECT_EQ(problem(quantity),
              "history.force: the time 0.6 is outside the rows of history.csv, which extend from 0 to 0.5");
  EXPECT_EQ(problem("history.force(t=-0.1)"),
            "history.force: the time -0.1 is outside the rows of history.csv, which extend from 0 to 0.5");
  EXPECT_EQ(problem("first_time(history.force > 5)"),
            "history.force is never above 5: its largest value from 0 to 0.5 is 4");
  EXPECT_EQ(problem("first_time(history.count < 1, 0.1, 0.2)"),
            "history.count is never below 1: its smallest value from 0.1 to 0.2 is 1");
  EXPECT_EQ(problem("summary.stps"), "summary.stps: there is no entry \"stps\" in summary.json");
}

TEST(QuantityValue, NeedsRows) {
  HistoryTable history;
  history.names = {"time", "a"};
  history.columns = {{"time", {}}, {"a", {}}};
  EXPECT_EQ(problem("max(history.a)", history), "history.a: history.csv has no rows");
  history.columns = {{"time", {0.0}}, {"a", {2.0}}};
  EXPECT_EQ(value("mean(history.a)", history), 2.0);
  EXPECT_EQ(value("integral(history.a)", history), 0.0);
  EXPECT_EQ(value("history.a(t=0)", history), 2.0);
  EXPECT_EQ(value("first_time(history.a > 1)", history), 0.0);
  EXPECT_NE(problem("history.a(t=1)", history), "");
}

}  // namespace
}  // namespace ricochet::test_support
