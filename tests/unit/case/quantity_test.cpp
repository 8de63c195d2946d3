#include "ricochet/case/quantity.hpp"

#include <gtest/gtest.h>

namespace ricochet::case_test {

using Kind = Quantity::Kind;

TEST(Quantity, IsTakenApart) {
  struct Expected {
    std::string text;
    Kind kind;
    std::string name;
    long row;
  };
  const std::vector<Expected> all{
      {"history.total_energy[-1]", Kind::history_value, "total_energy", -1},
      {"history.low-1.displacement_y[12]", Kind::history_value, "low-1.displacement_y", 12},
      {"max(history.time)", Kind::maximum, "time", 0},
      {"min(history.a.b)", Kind::minimum, "a.b", 0},
      {"min( history.a.b )", Kind::minimum, "a.b", 0},
      {"max_abs(history.energy_residual)", Kind::maximum_absolute, "energy_residual", 0},
      {"total_variation(history.total_energy)", Kind::total_variation, "total_energy", 0},
      {"mean(history.contact_force_y)", Kind::mean, "contact_force_y", 0},
      {"integral(history.contact_force_y)", Kind::integral, "contact_force_y", 0},
      {"summary.extrema.max_penetration", Kind::summary_value, "extrema.max_penetration", 0},
      {"summary.impacts.0.velocity_after.2", Kind::summary_value, "impacts.0.velocity_after.2", 0},
  };
  for (const Expected& expected : all) {
    const Quantity quantity = parse_quantity(expected.text);
    EXPECT_EQ(quantity.kind, expected.kind) << expected.text;
    EXPECT_EQ(quantity.name, expected.name) << expected.text;
    EXPECT_EQ(quantity.row, expected.row) << expected.text;
    EXPECT_FALSE(quantity.interval.has_value()) << expected.text;
  }
}

TEST(Quantity, IsTheValueAtATime) {
  for (const std::string text : {"history.low-1.gap(t=6.0e-5)", "history.low-1.gap( t = 6e-05 )"}) {
    const Quantity quantity = parse_quantity(text);
    EXPECT_EQ(quantity.kind, Kind::value_at_time) << text;
    EXPECT_EQ(quantity.name, "low-1.gap") << text;
    EXPECT_EQ(quantity.time, 6.0e-5) << text;
  }
}

TEST(Quantity, IsOfAnInterval) {
  for (const std::string function : {"max", "min", "max_abs", "total_variation", "mean", "integral"}) {
    const Quantity quantity = parse_quantity(function + "(history.total_energy, 1e-3,2.5)");
    EXPECT_EQ(quantity.name, "total_energy") << function;
    ASSERT_TRUE(quantity.interval.has_value()) << function;
    EXPECT_EQ(quantity.interval->begin, 1e-3) << function;
    EXPECT_EQ(quantity.interval->end, 2.5) << function;
    EXPECT_EQ(quantity.kind, parse_quantity(function + "(history.total_energy)").kind) << function;
  }
}

TEST(Quantity, IsTheTimeOfAnEvent) {
  const Quantity first = parse_quantity("first_time(history.contact_force_y > 0)");
  EXPECT_EQ(first.kind, Kind::first_time);
  EXPECT_EQ(first.name, "contact_force_y");
  EXPECT_TRUE(first.threshold.above);
  EXPECT_EQ(first.threshold.level, 0.0);
  EXPECT_FALSE(first.interval.has_value());
  const Quantity last = parse_quantity("last_time(history.a-b<-1.5e-3, 0, 0.25)");
  EXPECT_EQ(last.kind, Kind::last_time);
  EXPECT_EQ(last.name, "a-b");
  EXPECT_FALSE(last.threshold.above);
  EXPECT_EQ(last.threshold.level, -1.5e-3);
  ASSERT_TRUE(last.interval.has_value());
  EXPECT_EQ(last.interval->end, 0.25);
}

TEST(Quantity, SaysWhatIsWrong) {
  const std::string no_beginning = "it begins with neither history. nor summary. nor a function";
  const std::vector<std::pair<std::string, std::string>> all{
      {"", no_beginning},
      {"energy", no_beginning},
      {" history.time[0]", no_beginning},
      {"history.", "the row is missing"},
      {"history.time", "the row is missing: add [i], as in [-1] for the last row, or a time, as in (t=0.5)"},
      {"history.[0]", "nothing follows history."},
      {"history.time[", "it does not end with ]"},
      {"history.time[]", "the row \"\" is not an integer"},
      {"history.time[1.5]", "the row \"1.5\" is not an integer"},
      {"history.time[99999999999999999999]", "is not an integer"},
      {"history.time[0] ", "it does not end with ]"},
      {"history.a b[0]", "\"a b\" does not consist of letters, digits, _ and - joined by dots"},
      {"history.a..b[0]", "\"a..b\" does not consist of letters"},
      {"history.a.[0]", "\"a.\" does not consist of letters"},
      {"history.time(t=1", "it does not end with )"},
      {"history.time(", "it does not end with )"},
      {"history.time()", "the parentheses must contain a time, as in (t=0.5)"},
      {"history.time(1)", "the parentheses must contain a time"},
      {"history.time(s=1)", "the parentheses must contain a time"},
      {"history.time(t=)", "the time \"\" is not a number"},
      {"history.time(t=1 s)", "the time \"1 s\" is not a number"},
      {"history.time(t=inf)", "the time \"inf\" is not a number"},
      {"history.(t=1)", "nothing follows history."},
      {"summary.", "nothing follows summary."},
      {"summary.a[0]", "the number of an entry follows a dot, as in summary.a.0; write "},
      {"summary.impacts[0].velocity_after[2]", "a dot, as in summary.impacts.0.velocity_after.2; write "},
      {"summary.a[-1]", "\"a[-1]\" does not consist of letters"},
      {"contact[0].friction", "\"contact.0.friction\" is a key of the case, which a study varies with --vary"},
      {"time.step", "\"time.step\" is a key of the case"},
      {"summary.a(t=1)", "\"a(t=1)\" does not consist of letters"},
      {"max(summary.steps)", "\"summary.steps\" does not begin with history."},
      {"max(history.time", "the closing parenthesis is missing"},
      {"max(", "the closing parenthesis is missing"},
      {"max()", "\"\" does not begin with history."},
      {"max(history.time[0])", "a function applies to the whole column, without [i]"},
      {"max(history.time(t=1))", "a function applies to a column, not to a value at a time or another function"},
      {"max(mean(history.time))", "a function applies to a column, not to a value at a time or another function"},
      {"max_bas(history.time)", "unknown function \"max_bas\" (did you mean \"max_abs\"?)"},
      {"average(history.time)", "unknown function \"average\""},
      {"mean(history.time, 1)", "a time interval has two ends, T0 and T1, which follow the column"},
      {"mean(history.time, 1, 2, 3)", "a time interval has two ends"},
      {"mean(history.time, 1, )", "the time \"\" is not a number"},
      {"mean(history.time, a, 2)", "the time \"a\" is not a number"},
      {"mean(history.time, 2, 1)", "the interval from 2 to 1 does not end after it begins"},
      {"mean(history.time, 2, 2)", "the interval from 2 to 2 does not end after it begins"},
      {"mean(history.time > 1)", "only first_time and last_time accept a comparison, mean does not"},
      {"first_time(history.time)",
       "first_time requires a comparison of the column with a number: first_time(history.COLUMN > X)"},
      {"first_time(history.time >)", "the level \"\" is not a number"},
      {"first_time(history.time >= 1)", ">= is not supported: write >"},
      {"first_time(history.time > nan)", "the level \"nan\" is not a number"},
      {"first_time(1 < history.time)", "the level \"history.time\" is not a number"},
      {"last_time(> 1)", "\"\" does not begin with history."},
  };
  for (const auto& [text, reason] : all) {
    const std::string message = expect_error({reason}, [&] { static_cast<void>(parse_quantity(text)); });
    EXPECT_EQ(message.find("\"" + text + "\" is not a quantity: "), 0U) << message;
    for (const QuantityForm& form : quantity_forms()) EXPECT_TRUE(has(message, form.form));
  }
}

/// Capitals in the forms are replaced by names and numbers.
TEST(Quantity, HasTheFormsThatMessagesList) {
  for (const QuantityForm& form : quantity_forms()) {
    std::string text = form.form;
    for (const auto& [name, value] : {std::pair{"COLUMN", "time"},
                                      {"PATH", "steps"},
                                      {"FUNCTION", "mean"},
                                      {"[i]", "[3]"},
                                      {"T0", "1"},
                                      {"T1", "2"},
                                      {"=T", "=1"},
                                      {"X", "0"}}) {
      if (const std::size_t at = text.find(name); at != std::string::npos)
        text.replace(at, std::string(name).size(), value);
    }
    EXPECT_NO_THROW(static_cast<void>(parse_quantity(text))) << text;
  }
}

}  // namespace ricochet::case_test
