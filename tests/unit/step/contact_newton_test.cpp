#include "ricochet/step/contact_newton.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

namespace ricochet {
namespace {

constexpr NewtonScale scale{1e-14, 1e9};

/// One equation f(x) = 0 whose corrections are those of a function of x, and a record of what the driver asks for.
class Equation : public NewtonEquations {
 public:
  std::function<double(double)> correction;
  double x = 0.0, last = 0.0, size = 1.0;
  double inverted_beyond = std::numeric_limits<double>::infinity();
  int freezes_left = 0, refusals = 0, refinements = 0;
  double weight = 0.0;
  std::string record;

  Iteration iterate() override {
    last = x;
    x += correction(x);
    return {std::abs(x - last), size};
  }
  void accelerate() override { record += 'a'; }
  void forget_iterates() override { record += 'f'; }
  void evaluate() override {
    if (x > inverted_beyond) throw Error(ErrorKind::not_converged, "a cell is inverted");
  }
  void halve() override {
    record += 'h';
    x = 0.5 * (x + last);
  }
  void renew() override { record += 'r'; }
  [[nodiscard]] bool refine(bool is_solution) override { return is_solution && refinements-- > 0; }
  [[nodiscard]] bool has_conditions_on_solution() const override { return true; }
  [[nodiscard]] bool accept(const Iteration&, bool may_refuse) override { return !may_refuse || refusals-- <= 0; }
  [[nodiscard]] bool freeze() override {
    record += 'z';
    return freezes_left-- > 0;
  }
  void set_proximal_weight(double value) override { weight = value; }
  void take_back() override {
    record += 'b';
    x = last;
  }
};

TEST(ContactNewton, SolvesAnEquation) {
  Equation equation;
  equation.correction = [](double x) { return -(x * x - 2.0) / 3.0; };
  equation.x = 1.0;
  ContactNewton newton;
  newton.solve(equation, scale, Persistence::full);
  EXPECT_NEAR(equation.x, std::sqrt(2.0), 1e-12);
  EXPECT_LT(newton.progress().iterations(), 20);
}

/// The solution must be reached by an iteration that was not halved.
TEST(ContactNewton, HalvesCorrectionsThatInvertCells) {
  Equation equation;
  equation.correction = [](double x) { return x < 0.5 ? 1.6 - x : 1.0 - x; };
  equation.inverted_beyond = 1.5;
  equation.size = 0.5;
  ContactNewton newton;
  newton.solve(equation, scale, Persistence::full);
  EXPECT_EQ(equation.record, "fh");
  EXPECT_DOUBLE_EQ(equation.x, 1.0);
  EXPECT_EQ(newton.progress().iterations(), 3);
}

TEST(ContactNewton, RefinesTheEquationsAtTheirSolution) {
  Equation equation;
  equation.correction = [&](double x) { return (equation.refinements > 0 ? 1.0 : 2.0) - x; };
  equation.refinements = 1;
  ContactNewton().solve(equation, scale, Persistence::full);
  EXPECT_DOUBLE_EQ(equation.x, 2.0);
}

TEST(ContactNewton, IteratesOnWhereASolutionIsRefused) {
  Equation equation;
  equation.correction = [](double x) { return 0.9 * (1.0 - x); };
  equation.refusals = 1;
  ContactNewton newton;
  newton.solve(equation, {1e-14, 1e9, 1e-4}, Persistence::full);
  EXPECT_TRUE(newton.progress().is_tight());
  EXPECT_NEAR(equation.x, 1.0, 1e-12);
}

/// Iterations that alternate until pairs are frozen.
TEST(ContactNewton, FreezesPairsOnlyInFullIterations) {
  Equation equation;
  equation.freezes_left = 1;
  equation.correction = [&](double x) { return equation.freezes_left > 0 ? (x > 0.0 ? -1.0 : 1.0) : 0.5 - x; };
  EXPECT_THROW(ContactNewton().solve(equation, scale, Persistence::brief), Error);
  EXPECT_EQ(equation.record.find('z'), std::string::npos);
  equation.record.clear();
  ContactNewton().solve(equation, scale, Persistence::full);
  EXPECT_DOUBLE_EQ(equation.x, 0.5);
  const std::size_t frozen = equation.record.find('z');
  ASSERT_NE(frozen, std::string::npos);
  EXPECT_EQ(equation.record.at(frozen + 1), 'f');  // what is frozen has other iterates
  EXPECT_NE(equation.record.find("rf"), std::string::npos);
}

TEST(ContactNewton, GivesUpBriefIterationsEarly) {
  Equation equation;
  equation.correction = [](double x) { return 1e-3 * (1.0 - x); };
  ContactNewton newton;
  EXPECT_THROW(newton.solve(equation, scale, Persistence::brief), Error);
  EXPECT_EQ(newton.progress().iterations(), NewtonThresholds().early_iterations);
}

/// Newton's method for arctan(x − 3) diverges from x = 0, where a descent arrives.
TEST(ContactNewton, DescendsWhereNewtonDiverges) {
  Equation equation;
  const auto slope = [](double x) { return 1.0 / (1.0 + (x - 3.0) * (x - 3.0)); };
  equation.correction = [&](double x) { return -std::atan(x - 3.0) / (slope(x) + equation.weight); };
  EXPECT_THROW(ContactNewton().solve(equation, scale, Persistence::brief), Error);
  equation.x = 0.0;
  ContactNewton::descend(equation, {});
  EXPECT_DOUBLE_EQ(equation.weight, 0.0);
  EXPECT_NEAR(equation.x, 3.0, 0.5);
  ContactNewton().solve(equation, scale, Persistence::brief);
  EXPECT_NEAR(equation.x, 3.0, 1e-12);
}

TEST(ContactNewton, TakesBackAnIterationWithoutSolution) {
  Equation equation;
  equation.correction = [&](double x) {
    if (x == 0.0 && equation.weight < 2.0) throw Error(ErrorKind::not_converged, "no solution");
    return (1.0 - x) / (1.0 + equation.weight);
  };
  ContactNewton::descend(equation, {});
  EXPECT_EQ(equation.record, "b");
  EXPECT_NEAR(equation.x, 1.0, 1e-2);
}

TEST(ContactNewton, RefusesADescentThatDoesNotEnd) {
  Equation equation;
  equation.correction = [](double) { return 1.0; };
  EXPECT_THROW(ContactNewton::descend(equation, {}), Error);
}

}  // namespace
}  // namespace ricochet
