#include "ricochet/base/registry.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/scheme/scheme.hpp"

/// @file A user-defined type: one class and one registration make it valid in case files, with its keys.
namespace ricochet {
namespace {

/// Bodies continue with a damped velocity: V₁ = V₀ / (1 + h d).
class Drag final : public Scheme {
 public:
  Drag(double step, double drag) : Scheme(step), drag_(drag) {}
  [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override { return {}; }
  void advance(const SemidiscreteProblem&, State& state, StageSolve&, Vector& increment) override {
    state.velocity /= 1.0 + step() * drag_;
    increment = step() * state.velocity;
    state.displacement += increment;
  }

 private:
  double drag_;
};

SchemeRegistration drag_scheme() {
  return {"drag",
          [](double step, const Parameters& values) { return std::make_unique<Drag>(step, values.number("drag")); },
          {{.name = "drag",
            .type = KeyType::number,
            .unit = "1/time",
            .default_value = "2",
            .range = nonnegative,
            .doc = "Rate of decay."}},
          {},
          [](const ParameterCheck& check, const Parameters& values) {
            if (check.is_usable("drag") && values.number("drag") > 1e3) check.add_warning("drag", "nothing will move");
          }};
}

constexpr const char* case_text = R"([mesh]
file = "a.msh"
[[material]]
group = "body"
density = 1
lambda = 1
mu = 1
[time]
scheme = "drag"
drag = 0.5
step = 0.1
end = 1
)";

std::string problem_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  try {
    (void)read_case_text(text, "a.toml", overrides);
    return "";
  } catch (const Error& problem) {
    return problem.what();
  }
}

class OutsideScheme : public ::testing::Test {
 protected:
  void SetUp() override {
    log::set_level(log::Level::error);
    scheme_registry().add(drag_scheme());
  }
  void TearDown() override { scheme_registry().remove("drag"); }
};

TEST_F(OutsideScheme, IsReadFromACaseAndMadeWithItsParameter) {
  const Case input = read_case_text(case_text, "a.toml", {});
  EXPECT_EQ(input.values.at("time.drag"), "0.5");
  const auto scheme = make_scheme(input.time.scheme, input.time.step, input.time.parameters);
  struct NoStages final : StageSolve {
    Stage& stage(std::size_t) override { throw std::logic_error("it has no stage"); }
    const StageSolution& solve(std::size_t) override { throw std::logic_error("it has no stage"); }
    double newton_tolerance() const override { return 1e-9; }
    double renewal_price() const override { return 10.0; }
    void rotate_operators(const Vector&) override {}
    void renew_operators(const Vector&, const Vector&) override {}
  } stages;
  State state;
  state.displacement = Vector::Zero(2);
  state.velocity = Vector::Constant(2, 1.05);
  Vector increment;
  scheme->advance(SemidiscreteProblem(), state, stages, increment);
  EXPECT_NEAR(state.velocity[0], 1.0, 1e-15);
  EXPECT_NEAR(state.displacement[1], 0.1, 1e-15);
}

TEST(Scheme, HasActingForcesAtTheInstantOfThoseShownUnlessItSaysOtherwise) {
  struct Still final : Scheme {
    using Scheme::Scheme;
    [[nodiscard]] std::vector<OperatorCoefficients> operators(const SemidiscreteProblem&) const override { return {}; }
    void advance(const SemidiscreteProblem&, State&, StageSolve&, Vector&) override {}
  };
  EXPECT_EQ(Still(0.1).acting_instant(), 0.0);
  EXPECT_EQ(Still(0.1, {.force_instant = -0.5}).acting_instant(), -0.5);
  EXPECT_EQ(Still(0.1, {.force_instant = -0.25, .acting_instant = 0.0}).acting_instant(), 0.0);
}

TEST_F(OutsideScheme, HasItsDefaultAndItsRange) {
  EXPECT_EQ(problem_of(case_text, {"time.drag=-1"}),
            "--set time.drag=-1: \"drag\" must be a number of at least 0 (unit: 1/time); found the integer -1");
  std::string without = case_text;
  without.replace(without.find("drag = 0.5\n"), 11, "");
  EXPECT_EQ(read_case_text(without, "a.toml", {}).time.parameters.number("drag"), 2.0);
}

TEST_F(OutsideScheme, KeepsItsKeyToItself) {
  std::string midpoint = case_text;
  midpoint.replace(midpoint.find("\"drag\""), 6, "\"midpoint\"");
  EXPECT_EQ(problem_of(midpoint), "a.toml:10:8: \"drag\" is for the scheme \"drag\" only; the scheme is \"midpoint\"");
  EXPECT_EQ(read_case_text(case_text, "a.toml", {"time.scheme=midpoint"}).values.count("time.drag"), 0U);
}

TEST_F(OutsideScheme, IsInTheSchemaAndInTheDocumentation) {
  EXPECT_NE(case_schema().find("\"drag\""), std::string::npos);
  EXPECT_NE(case_reference().find("Rate of decay; for the scheme \"drag\" only."), std::string::npos);
}

TEST_F(OutsideScheme, HasANameOfItsOwn) { EXPECT_THROW(scheme_registry().add(drag_scheme()), Error); }

TEST(Registry, MakesByNameWithParametersInCode) {
  EXPECT_NE(make_scheme("newmark", 0.1, {{"beta", 0.25}, {"gamma", 0.5}}), nullptr);
  const auto message = [](const std::string& name, const Parameters& parameters) -> std::string {
    try {
      (void)make_scheme(name, 0.1, parameters);
      return "";
    } catch (const Error& problem) {
      return problem.what();
    }
  };
  EXPECT_EQ(message("euler", {}), "unknown scheme \"euler\"; known: " + join_names(scheme_names()));
  EXPECT_EQ(message("midpoint", {{"beta", 0.25}}), "scheme \"midpoint\" has no parameter \"beta\"; it has none");
  EXPECT_EQ(message("newmark", {{"beta", 0.25}}), "the parameter \"gamma\" is missing");
  EXPECT_EQ(message("newmark", {{"beta", "a"}, {"gamma", 0.5}}),
            "scheme \"newmark\": the parameter \"beta\" is a; it must be a positive number");
  EXPECT_EQ(message("newmark", {{"beta", 0.0}, {"gamma", 0.5}}),
            "scheme \"newmark\": the parameter \"beta\" is 0; it must be a positive number");
  EXPECT_EQ(
      message("newmark", {{"preset", "trapezoid"}}),
      "scheme \"newmark\": the parameter \"preset\" is trapezoid; it must be \"trapezoidal\" or \"textbook-half\"");
}

/// A key that its type cannot have is refused at registration, not at first use.
TEST(Registry, RefusesKeysThatATypeCannotHave) {
  const auto with = [](Key key) {
    SchemeRegistration registration = drag_scheme();
    registration.name = "keys";
    registration.keys.push_back(std::move(key));
    return registration;
  };
  EXPECT_THROW(scheme_registry().add(with({.name = "f", .type = KeyType::formula, .doc = "?"})), Error);
  EXPECT_THROW(scheme_registry().add(with({.name = "v", .type = KeyType::vector, .default_value = "0, 0", .doc = "?"})),
               Error);
  EXPECT_THROW(scheme_registry().add(with({.name = "drag", .type = KeyType::number, .doc = "?"})), Error);
  EXPECT_THROW(scheme_registry().remove("keys"), Error) << "nothing was added";
  // A key of the section itself, or of another type of another kind.
  for (const char* const name : {"step", "beta"}) {
    scheme_registry().add(with({.name = name, .type = KeyType::text, .doc = "?"}));
    EXPECT_THROW((void)case_schema(), Error) << name;
    scheme_registry().remove("keys");
  }
  EXPECT_FALSE(case_schema().empty());
}

}  // namespace
}  // namespace ricochet
