#include "ricochet/study/benchmark/methods.hpp"

#include <gtest/gtest.h>

#include "ricochet/case/read_case.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "support/errors.hpp"
#include "support/paths.hpp"

namespace ricochet::test_support {
namespace {

std::string problem_of(const std::string& methods) {
  return message_of([&] { static_cast<void>(parse_methods(methods)); }, ErrorKind::usage);
}

TEST(BenchmarkMethods, AreReadFromAList) {
  EXPECT_EQ(parse_methods("newmark,newmark/consistent,newmark"),
            (std::vector<RequestedMethod>{{"newmark", ""}, {"newmark", "consistent"}}));
  EXPECT_EQ(parse_methods("all").size(), scheme_names().size());
  EXPECT_EQ(RequestedMethod({"newmark", "lumped"}).text(), "newmark/lumped");
  EXPECT_TRUE(has(problem_of("newmrk"), "no scheme \"newmrk\" (did you mean \"newmark\"?); available: midpoint"));
  EXPECT_TRUE(has(problem_of("newmark/consitent"), "no mass \"consitent\" (did you mean \"consistent\"?)"));
  EXPECT_TRUE(has(problem_of("newmark/"), "no mass \"\""));
  EXPECT_TRUE(has(problem_of(""), "no scheme \"\""));
}

TEST(BenchmarkMethods, TakeTheFirstMassAndAStableStep) {
  const std::string path = source_path("cases/rod/rod.toml");
  MethodChooser chooser(path);
  EXPECT_EQ(chooser.scheme_of_case(), "reduced-kane");
  for (const auto& [scheme, mass] : std::map<std::string, std::string>{{"reduced-kane", "equivalent"},
                                                                       {"newmark", "equivalent"},
                                                                       {"kane", "consistent"},
                                                                       {"taylor-flanagan", "lumped"},
                                                                       {"semi-explicit", "equivalent-lumped"}}) {
    const MethodChoice choice = chooser.choose({scheme});
    EXPECT_EQ(choice.mass, mass) << scheme;
    const Case input = read_case(path, choice.settings);
    EXPECT_EQ(input.time.scheme, scheme);
    EXPECT_EQ(input.mass.type, mass);
    const std::unique_ptr<Model> model = build_model(input);
    const std::unique_ptr<Scheme> method = make_scheme(input.time);
    const double limit = method->stability_limit(model->problem).value_or(1.0);
    EXPECT_NEAR(input.time.step, std::min(read_case(path).time.step, 0.9 * limit), 1e-5 * input.time.step) << scheme;
  }
  EXPECT_EQ(chooser.choose({"newmark"}).settings[2], "time.preset=\"trapezoidal\"");
}

TEST(BenchmarkMethods, SayWhyTheyAreRefused) {
  MethodChooser chooser(source_path("cases/incline/incline.toml"));
  const MethodChoice choice = chooser.choose({"mean-reaction"});
  EXPECT_TRUE(choice.is_refused());
  EXPECT_TRUE(has(choice.refusals.at("equivalent"), "does not support friction"));
  EXPECT_EQ(chooser.choose({"kane", "equivalent"}).refusals.size(), 1u);
}

TEST(BenchmarkMethods, ReasonsAreShort) {
  EXPECT_EQ(short_reason("/a/case.toml:3:14: no such group\nmore"), "no such group");
  EXPECT_EQ(short_reason("--set time.scheme=a: no friction: why"), "no friction: why");
  EXPECT_EQ(short_reason("scheme \"a\" does not support friction: why"), "scheme \"a\" does not support friction: why");
}

}  // namespace
}  // namespace ricochet::test_support
