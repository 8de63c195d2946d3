#include "ricochet/study/plan.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/error.hpp"
#include "support/errors.hpp"

namespace ricochet::test_support {
namespace {

using Texts = std::vector<std::string>;

TEST(StudyPlan, TakesValuesApartButNotInsideOfBracketsAndQuotes) {
  const StudyAxis steps = parse_axis("time.step=1e-3, 5e-4,0.00025");
  EXPECT_EQ(steps.keys, Texts{"time.step"});
  EXPECT_EQ(steps.values, (std::vector<Texts>{{"1e-3"}, {"5e-4"}, {"0.00025"}}));
  EXPECT_EQ(parse_axis("initial.velocity=[0,-1],[0,\"-2*x, y\"]").values,
            (std::vector<Texts>{{"[0,-1]"}, {"[0,\"-2*x, y\"]"}}));
  EXPECT_EQ(parse_axis("support.0.value=max(t,1)/2,0").values, (std::vector<Texts>{{"max(t,1)/2"}, {"0"}}));
  EXPECT_EQ(parse_axis("mesh.file='a,b.msh'").values, (std::vector<Texts>{{"'a,b.msh'"}}));
}

TEST(StudyPlan, KeysGoTogether) {
  const StudyAxis axis = parse_axis("time.scheme,mesh.file=newmark/\"a/b.msh\",midpoint/c.msh");
  EXPECT_EQ(axis.keys, (Texts{"time.scheme", "mesh.file"}));
  EXPECT_EQ(axis.values, (std::vector<Texts>{{"newmark", "\"a/b.msh\""}, {"midpoint", "c.msh"}}));
}

TEST(StudyPlan, SaysWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> all{
      {"time.step", "\"=\" is missing"},
      {"time.step=", "a value is empty"},
      {"time.step=1,,2", "a value is empty"},
      {"time.step=1,2,1", "\"1\" appears twice"},
      {"time.step=0.20,0.2", "\"0.20\" and \"0.2\" are the same value: remove one"},
      {"time.step=2e-1, 1, 0.2", "\"2e-1\" and \"0.2\" are the same value"},
      {"time.scheme=newmark,\"newmark\"", "are the same value"},
      {"initial.velocity=[0,-1],[0, -1.0]", "are the same value"},
      {"time.step,time.end=1/2,3/4,1.0/2.0", "\"1/2\" and \"1.0/2.0\" are the same value"},
      {"contact.00.friction=1",
       "\"00\" is not a valid number of an entry of [[contact]]: write 0, as in contact.0.friction"},
      {"time.stp=1", "did you mean \"step\"?"},
      {"time.step,=1/2", "a key is empty"},
      {"time.step,time.end=1/2,3", "\"3\" has 1 value for 2 keys"},
      {"time.step,time.end=1/2/3", "\"1/2/3\" has 3 values for 2 keys"},
      {"initial.velocity=[0,1", "a bracket or a quote is not closed"},
  };
  for (const auto& [text, reason] : all) {
    SCOPED_TRACE(text);
    expect_error(ErrorKind::usage, {reason}, [&] { static_cast<void>(parse_axis(text)); });
  }
}

TEST(StudyPlan, RefusesAKeyThatIsSaidTwice) {
  const auto plan = [](Texts set, const Texts& vary) {
    StudyPlan result{"/case.toml", std::move(set), {}};
    for (const std::string& text : vary) result.axes.push_back(parse_axis(text));
    return result;
  };
  EXPECT_NO_THROW(check_plan(plan({"time.end=1"}, {"time.step=1,2"})));
  EXPECT_THROW(check_plan(plan({}, {})), Error);
  EXPECT_THROW(check_plan(plan({}, {"time.step=1,2", "time.step,time.end=3/4"})), Error);
  EXPECT_THROW(check_plan(plan({"time.step = 3"}, {"time.step=1,2"})), Error);
}

TEST(StudyPlan, CombinesAllWithTheLastFastest) {
  const StudyPlan plan{"/case.toml",
                       {"time.end=1"},
                       {parse_axis("time.scheme,mass.type=newmark/equivalent,midpoint/consistent"),
                        parse_axis("contact.0.friction=0,0.5,1")}};
  const std::vector<PlannedRun> runs = runs_of(plan);
  ASSERT_EQ(runs.size(), 6u);
  EXPECT_EQ(varied_keys(plan), (Texts{"time.scheme", "mass.type", "contact.0.friction"}));
  EXPECT_EQ(runs[0].values, (Texts{"newmark", "equivalent", "0"}));
  EXPECT_EQ(runs[1].values, (Texts{"newmark", "equivalent", "0.5"}));
  EXPECT_EQ(runs[3].values, (Texts{"midpoint", "consistent", "0"}));
  EXPECT_EQ(runs[5].at, (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(runs[4].settings,
            (Texts{"time.end=1", "time.scheme=midpoint", "mass.type=consistent", "contact.0.friction=0.5"}));
  EXPECT_EQ(runs[4].name, "scheme=midpoint_type=consistent_friction=0.5");
}

TEST(StudyPlan, LeavesAKeyAsTheCaseHasIt) {
  const StudyPlan plan{"/case.toml", {}, {parse_axis("time.scheme,time.preset=newmark/trapezoidal,midpoint/-")}};
  EXPECT_EQ(runs_of(plan)[0].settings, (Texts{"time.scheme=newmark", "time.preset=trapezoidal"}));
  EXPECT_EQ(runs_of(plan)[1].settings, (Texts{"time.scheme=midpoint"}));
  EXPECT_EQ(runs_of(plan)[1].values, (Texts{"midpoint", "-"}));
}

TEST(StudyPlan, NamesAreThoseOfDirectories) {
  const StudyPlan vectors{"/case.toml", {}, {parse_axis("initial.velocity=[0, -1],../../x y/$z")}};
  EXPECT_EQ(runs_of(vectors)[0].name, "velocity=_0__-1_");
  EXPECT_EQ(runs_of(vectors)[1].name, "velocity=.._.._x_y__z");
  const StudyPlan same_end{"/case.toml", {}, {parse_axis("contact.0.friction=0"), parse_axis("contact.1.friction=1")}};
  EXPECT_EQ(runs_of(same_end)[0].name, "contact.0.friction=0_contact.1.friction=1");
}

TEST(StudyPlan, KnowsWhatIsNumeric) {
  const StudyPlan plan{"/case.toml", {}, {parse_axis("time.scheme,time.step=newmark/1e-3,midpoint/2e-3")}};
  EXPECT_FALSE(is_numeric(plan, find_varied(plan, "time.scheme", "--order")));
  EXPECT_TRUE(is_numeric(plan, find_varied(plan, "time.step", "--order")));
  EXPECT_THROW(static_cast<void>(find_varied(plan, "time.end", "--order")), Error);
  const StudyPlan one{"/case.toml", {}, {parse_axis("time.step=1e-3")}};
  EXPECT_FALSE(is_numeric(one, {0, 0})) << "one value gives no order";
}

}  // namespace
}  // namespace ricochet::test_support
