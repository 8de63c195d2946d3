#include "ricochet/case/quantity.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/error.hpp"

namespace ricochet::case_test {

TEST(Quantity, IsTakenApart) {
  struct Expected {
    std::string text;
    Quantity::Kind kind;
    std::string name;
    long row;
  };
  const std::vector<Expected> all{
      {"history.total_energy[-1]", Quantity::Kind::history_value, "total_energy", -1},
      {"history.low-1.displacement_y[12]", Quantity::Kind::history_value, "low-1.displacement_y", 12},
      {"max(history.time)", Quantity::Kind::maximum, "time", 0},
      {"min(history.a.b)", Quantity::Kind::minimum, "a.b", 0},
      {"max_abs(history.energy_residual)", Quantity::Kind::maximum_absolute, "energy_residual", 0},
      {"total_variation(history.total_energy)", Quantity::Kind::total_variation, "total_energy", 0},
      {"summary.extrema.max_penetration", Quantity::Kind::summary_value, "extrema.max_penetration", 0},
  };
  for (const Expected& expected : all) {
    const Quantity quantity = parse_quantity(expected.text);
    EXPECT_EQ(quantity.kind, expected.kind) << expected.text;
    EXPECT_EQ(quantity.name, expected.name) << expected.text;
    EXPECT_EQ(quantity.row, expected.row) << expected.text;
  }
}

TEST(Quantity, SaysWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> all{
      {"", "it begins neither with history. nor with summary. nor with a function"},
      {"energy", "it begins neither with history. nor with summary. nor with a function"},
      {"history.", "which row is not said"},
      {"history.time", "which row is not said: add [i], as in [-1] for the last one"},
      {"history.[0]", "nothing stands after history."},
      {"history.time[", "it does not end with ]"},
      {"history.time[]", "the row \"\" is not an integer"},
      {"history.time[1.5]", "the row \"1.5\" is not an integer"},
      {"history.time[99999999999999999999]", "is not an integer"},
      {"history.time[0] ", "it does not end with ]"},
      {"history.a b[0]", "\"a b\" is not made of letters, digits, _ and - joined by dots"},
      {"history.a..b[0]", "\"a..b\" is not made of letters"},
      {"history.a.[0]", "\"a.\" is not made of letters"},
      {"summary.", "nothing stands after summary."},
      {"summary.a[0]", "\"a[0]\" is not made of letters"},
      {"max(summary.steps)", "\"summary.steps\" does not begin with history."},
      {"max(history.time", "the closing parenthesis is missing"},
      {"max(", "the closing parenthesis is missing"},
      {"max()", "\"\" does not begin with history."},
      {"max(history.time[0])", "a function takes the whole column, without [i]"},
      {"max_bas(history.time)", "unknown function \"max_bas\" (did you mean \"max_abs\"?)"},
      {"average(history.time)", "unknown function \"average\""},
  };
  for (const auto& [text, reason] : all) {
    try {
      static_cast<void>(parse_quantity(text));
      ADD_FAILURE() << text;
    } catch (const Error& problem) {
      const std::string message = problem.what();
      EXPECT_EQ(problem.kind(), ErrorKind::invalid_input);
      EXPECT_EQ(message.find("\"" + text + "\" is not a quantity: "), 0U) << message;
      EXPECT_NE(message.find(reason), std::string::npos) << message;
      EXPECT_NE(message.find("; write history.COLUMN[i], max(history.COLUMN)"), std::string::npos) << message;
    }
  }
}

}  // namespace ricochet::case_test
