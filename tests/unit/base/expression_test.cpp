#include "ricochet/base/expression.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/errors.hpp"

namespace ricochet::test_support {
namespace {

void expect_refusal(const std::string& text, const std::vector<std::string>& parts) {
  const std::string message = message_of([&] { (void)Expression(text, {{"speed", 2.0}}); });
  ASSERT_FALSE(message.empty()) << text << " is accepted";
  EXPECT_TRUE(has(message, '"' + text + '"'));
  for (const std::string& part : parts) EXPECT_TRUE(has(message, part));
}

TEST(Expression, EvaluatesAtAPointAndAnInstant) {
  const Expression formula("2*x - y^2 + sqrt(z)*t", {});
  EXPECT_DOUBLE_EQ(formula(3.0, 2.0, 16.0, 0.5), 6.0 - 4.0 + 2.0);
  EXPECT_EQ(Expression()(1.0, 2.0, 3.0, 4.0), 0.0);
  EXPECT_EQ(Expression(-1.5)(1.0, 2.0, 3.0, 4.0), -1.5);
  EXPECT_DOUBLE_EQ(Expression("pi")(0.0, 0.0, 0.0, 0.0), M_PI);
  EXPECT_DOUBLE_EQ(Expression("-p*min(t/0.1, 1)", {{"p", 100.0}})(0.0, 0.0, 0.0, 0.05), -50.0);
  EXPECT_DOUBLE_EQ(Expression("t < 1 ? 2 : 3")(0.0, 0.0, 0.0, 1.5), 3.0);
}

TEST(Expression, ComparisonsAreNoAssignments) {
  EXPECT_EQ(Expression("t == 3")(0.0, 0.0, 0.0, 3.0), 1.0);
  EXPECT_EQ(Expression("t <= 3")(0.0, 0.0, 0.0, 3.0), 1.0);
  EXPECT_EQ(Expression("t >= 3.5")(0.0, 0.0, 0.0, 3.0), 0.0);
  EXPECT_EQ(Expression("t != 3")(0.0, 0.0, 0.0, 3.0), 0.0);
}

TEST(Expression, KnowsWhatItDependsOn) {
  EXPECT_TRUE(Expression("3 + pi").is_constant());
  EXPECT_TRUE(Expression("a", {{"a", 1.0}}).is_constant());
  EXPECT_TRUE(Expression("2*t").depends_on_time());
  EXPECT_FALSE(Expression("2*t").depends_on_position());
  for (const char* name : {"x", "y", "z"}) {
    EXPECT_TRUE(Expression(name).depends_on_position());
    EXPECT_FALSE(Expression(name).depends_on_time());
    EXPECT_FALSE(Expression(name).is_constant());
  }
}

TEST(Expression, CopiesAreIndependent) {
  Expression first("x + 10*t");
  const Expression second = first;
  EXPECT_EQ(second(1.0, 0.0, 0.0, 2.0), 21.0);
  first = Expression("y");
  EXPECT_EQ(second(1.0, 5.0, 0.0, 2.0), 21.0);
  EXPECT_EQ(first(1.0, 5.0, 0.0, 2.0), 5.0);
  const Expression moved = std::move(first);
  EXPECT_EQ(moved(1.0, 7.0, 0.0, 2.0), 7.0);
  const Expression with_parameter("a*t", {{"a", 3.0}});
  const Expression copy = with_parameter;
  EXPECT_EQ(copy(0.0, 0.0, 0.0, 2.0), 6.0);
  EXPECT_EQ(copy.text(), "a*t");
  const Expression constant("2*3");
  const Expression copy_of_constant = constant;
  EXPECT_EQ(copy_of_constant(0.0, 0.0, 0.0, 0.0), 6.0);
  EXPECT_EQ(copy_of_constant.text(), "2*3");
}

TEST(Expression, OfANumberKeepsAllItsDigits) {
  for (const double value : {0.1, 1.0 / 3.0, -1e-300, 6.02214076e23}) {
    EXPECT_EQ(Expression(Expression(value).text())(0.0, 0.0, 0.0, 0.0), value);
  }
}

TEST(Expression, RefusesListsAndAssignments) {
  expect_refusal("1,2", {"2 values"});
  expect_refusal("x, y, z", {"3 values"});
  expect_refusal("t=3", {"\"==\""});
  expect_refusal("t**2", {"\"^\""});
  expect_refusal("= 3", {"\"==\""});
  expect_refusal("x = y == 2", {"\"==\""});
}

TEST(Expression, RefusesUnknownNamesWithAHint) {
  expect_refusal("2*sped", {"unknown name \"sped\"", "did you mean \"speed\"?", "\"t\"", "\"pi\""});
  expect_refusal("temperature", {"unknown name \"temperature\"", "known names are"});
  EXPECT_FALSE(has(message_of([] { (void)Expression("temperature"); }), "did you mean"));
}

TEST(Expression, RefusesReservedParameterNames) {
  for (const char* name : {"x", "y", "z", "t", "pi"}) {
    const std::string message = message_of([&] { (void)Expression("1", {{name, 1.0}}); });
    EXPECT_TRUE(has(message, "reserved"));
  }
}

TEST(Expression, RefusesBadParameterNames) {
  EXPECT_NE(message_of([] { (void)Expression("1", {{"two words", 1.0}}); }), "");
}

TEST(Expression, RefusesWrongSyntax) {
  for (const char* text : {"", " ", "1 +", "(x", "x)", "sin()", "2 x", "*3", "\"text\"", "max(", "x y"}) {
    EXPECT_NE(message_of([&] { (void)Expression(text); }), "") << text << " is accepted";
  }
}

TEST(Expression, RefusesValuesThatAreNotFinite) {
  expect_refusal("1/0", {"no finite value"});
  expect_refusal("sqrt(-1)", {"no finite value"});
  expect_refusal("log(0)", {"no finite value"});
  EXPECT_NE(message_of([] { (void)Expression("a", {{"a", std::nan("")}}); }), "");
  const Expression pole("1/(x-t)");
  EXPECT_EQ(pole(3.0, 0.0, 0.0, 1.0), 0.5);
  const std::string message = message_of([&] { (void)pole(1.5, 0.25, 0.0, 1.5); });
  for (const char* part : {"\"1/(x-t)\"", "x = 1.5", "y = 0.25", "t = 1.5"}) {
    EXPECT_TRUE(has(message, part));
  }
  EXPECT_EQ(pole(3.0, 0.0, 0.0, 1.0), 0.5) << "usable after an error";
}

}  // namespace
}  // namespace ricochet::test_support
