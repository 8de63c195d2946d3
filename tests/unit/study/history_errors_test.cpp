#include "ricochet/study/history_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "ricochet/base/error.hpp"

namespace ricochet {
namespace {

RunHistory history(int steps, const std::function<double(double)>& x, const std::function<double(double)>& y) {
  RunHistory run;
  run.summary.step = 1.0 / steps;
  run.table.names = {"time", "v_x", "v_y", "kinetic_energy"};
  for (int i = 0; i <= steps; ++i) {
    const double t = double(i) / steps;
    run.table.columns["time"].push_back(t);
    run.table.columns["v_x"].push_back(x(t));
    run.table.columns["v_y"].push_back(y(t));
    run.table.columns["kinetic_energy"].push_back(x(t));
  }
  return run;
}

const ComparedQuantity vector_v{"v", {"v_x", "v_y"}};

TEST(HistoryErrors, AreRelativeInTheNormOverTimeOfAllComponents) {
  const auto zero = [](double) { return 0.0; };
  const RunHistory reference = history(
      10, [](double) { return 3.0; }, [](double) { return 4.0; });
  // |(0.3, 0.4)| / |(3, 4)| at all times.
  const RunHistory near = history(
      7, [](double) { return 3.3; }, [](double) { return 4.4; });
  EXPECT_NEAR(*relative_error(vector_v, near, reference), 0.1, 1e-14);
  // ∫ t² = 1/3 of an error t in one component, ∫ 25 of the reference; the trapezoidal rule adds 1/(6 n²).
  const RunHistory growing = history(
      100, [](double t) { return 3.0 + t; }, [](double) { return 4.0; });
  EXPECT_NEAR(*relative_error(vector_v, growing, reference), std::sqrt((1.0 / 3.0 + 1.0 / 6e4) / 25.0), 1e-12);
  EXPECT_EQ(*relative_error(vector_v, reference, reference), 0.0);
  EXPECT_FALSE(relative_error(vector_v, near, history(10, zero, zero)).has_value()) << "relative to nothing";
  EXPECT_FALSE(relative_error({"w", {"w_x"}}, near, reference).has_value());
}

TEST(HistoryErrors, TakeTheReferenceLinearBetweenItsRowsAndNoFurtherThanItGoes) {
  const auto line = [](double t) { return 1.0 + t; };
  const RunHistory reference = history(3, line, line);
  EXPECT_NEAR(*relative_error(vector_v, history(7, line, line), reference), 0.0, 1e-15);
  RunHistory longer = history(4, line, line);
  longer.table.columns["time"].push_back(9.0);
  for (const char* column : {"v_x", "v_y", "kinetic_energy"}) longer.table.columns[column].push_back(1e9);
  EXPECT_NEAR(*relative_error(vector_v, longer, reference), 0.0, 1e-15) << "its last row is left out";
}

TEST(HistoryErrors, KnowTheInstantsOfTheScheme) {
  const auto line = [](double t) { return 1.0 + t; };
  const RunHistory reference = history(50, line, line);
  RunHistory late = history(
      10, [](double t) { return 1.05 + t; }, line);
  late.summary.energy_instant = 0.5;  // half of a step of 0.1
  EXPECT_NEAR(*relative_error({"kinetic_energy", {"kinetic_energy"}}, late, reference), 0.0, 1e-14);
  EXPECT_GT(*relative_error({"v", {"v_x"}}, late, reference), 0.02);
}

TEST(HistoryErrors, FindColumnsAndVectors) {
  const RunHistory run = history(
      2, [](double t) { return t; }, [](double t) { return t; });
  EXPECT_EQ(find_compared("v", run.table).columns, (std::vector<std::string>{"v_x", "v_y"}));
  EXPECT_EQ(find_compared("v_y", run.table).columns, (std::vector<std::string>{"v_y"}));
  EXPECT_THROW(static_cast<void>(find_compared("kinetic_enery", run.table)), Error);
  RunHistory probed = run;
  for (const char* name : {"tip.displacement_x", "tip.displacement_y", "contact_force_x"}) {
    probed.table.names.emplace_back(name);
    probed.table.columns[name] = {0.0, 1.0, 2.0};
  }
  std::vector<std::string> names;
  for (const ComparedQuantity& quantity : usual_compared(probed.table)) names.push_back(quantity.name);
  EXPECT_EQ(names, (std::vector<std::string>{"kinetic_energy", "contact_force", "tip.displacement"}));
}

TEST(ObservedOrder, IsThatOfAPower) {
  for (const double order : {0.5, 1.0, 2.0, 4.0}) {
    const auto error = [order](double step) { return 7.0 * std::pow(step, order); };
    EXPECT_NEAR(*observed_order(error(0.1), error(0.03), 0.1, 0.03), order, 1e-13);
  }
  EXPECT_FALSE(observed_order(0.0, 1.0, 2.0, 1.0).has_value());
  EXPECT_FALSE(observed_order(1.0, 0.0, 2.0, 1.0).has_value());
  EXPECT_FALSE(observed_order(1.0, 2.0, 1.0, 1.0).has_value());
  EXPECT_FALSE(observed_order(std::nan(""), 2.0, 1.0, 2.0).has_value());
}

}  // namespace
}  // namespace ricochet
