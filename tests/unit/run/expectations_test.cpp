#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ricochet/base/temporary_folder.hpp"
#include "ricochet/run/run_case.hpp"

namespace ricochet {
namespace {

class ExpectationsTest : public testing::Test {
 protected:
  ExpectationsTest() {
    std::ofstream(folder_.file("history.csv")) << "step,time,force,weight\n0,0,0,2\n1,0.5,6,4\n2,1,3,0\n";
  }
  /// Result of one [[expect]] entry.
  [[nodiscard]] ExpectationResult outcome(const ExpectSection& expect,
                                          ExpectationScope scope = ExpectationScope::settings_of_the_case) {
    case_.expectations = {expect};
    return check_expectations(case_, std::filesystem::path(folder_.file("history.csv")).parent_path().string(), "{}",
                              scope)
        .at(0);
  }

  TemporaryFolder folder_{std::filesystem::temp_directory_path(), "ricochet-test"};
  Case case_;
};

TEST_F(ExpectationsTest, TellWhatWasWantedInNumbers) {
  const ExpectationResult result = outcome({.name = "force, largest",
                                            .quantity = "max(history.force)",
                                            .value = 5.0,
                                            .relative = 0.1,
                                            .absolute = 0.25,
                                            .published = "somebody: 5.0"});
  EXPECT_EQ(result.label(), "force, largest");
  EXPECT_EQ(result.quantity, "max(history.force)");
  EXPECT_EQ(result.published, "somebody: 5.0");
  EXPECT_EQ(result.value, 6.0);
  EXPECT_EQ(result.expected_value, 5.0);
  EXPECT_EQ(result.tolerance, 0.5) << "the larger one counts";
  EXPECT_FALSE(result.minimum.has_value());
  EXPECT_FALSE(result.holds);
  EXPECT_TRUE(outcome({.quantity = "history.force(t=0.25)", .value = 3.5, .absolute = 0.5}).holds);
}

TEST_F(ExpectationsTest, TellTheirBounds) {
  const ExpectationResult result = outcome({.quantity = "integral(history.force)", .minimum = 3.75});
  EXPECT_EQ(result.label(), "integral(history.force)");
  EXPECT_EQ(result.minimum, 3.75);
  EXPECT_FALSE(result.maximum.has_value());
  EXPECT_FALSE(result.expected_value.has_value());
  EXPECT_FALSE(result.tolerance.has_value());
  EXPECT_TRUE(result.holds);
}

TEST_F(ExpectationsTest, AreOfMultiplesAndQuotients) {
  const ExpectationResult quotient = outcome(
      {.quantity = "history.force[1]", .over = "history.weight[0]", .times = -4.0, .value = -12.0, .absolute = 0.0});
  EXPECT_EQ(quotient.value, -12.0);
  EXPECT_TRUE(quotient.holds);
  EXPECT_EQ(quotient.quantity, "-4 * history.force[1] / history.weight[0]");
  const ExpectationResult none =
      outcome({.quantity = "history.force[1]", .over = "history.weight[-1]", .minimum = 0.0});
  EXPECT_FALSE(none.holds);
  EXPECT_TRUE(none.checked);
  EXPECT_EQ(none.note, "history.weight[-1] is 0: cannot divide by it");
}

TEST_F(ExpectationsTest, AreOfTheCaseAsItIsUnlessAllAreAskedFor) {
  case_.overridden = {"time.scheme"};
  case_.values = {{"time.scheme", "midpoint"}};
  const auto checked = [this](const std::map<std::string, std::string>& when, ExpectationScope scope) {
    return outcome({.quantity = "history.force[0]", .maximum = 0.0, .when = when}, scope).checked;
  };
  EXPECT_FALSE(checked({}, ExpectationScope::settings_of_the_case));
  EXPECT_TRUE(checked({}, ExpectationScope::any_settings));
  EXPECT_TRUE(checked({{"time.scheme", "midpoint"}}, ExpectationScope::settings_of_the_case));
  EXPECT_TRUE(checked({{"time.scheme", "midpoint"}}, ExpectationScope::any_settings));
  EXPECT_FALSE(checked({{"time.scheme", "newmark"}}, ExpectationScope::any_settings)) << "made for another method";
}

}  // namespace
}  // namespace ricochet
