#include <gtest/gtest.h>

#include "case_text.hpp"
#include "ricochet/base/log.hpp"

// Newmark's parameters from the file, from presets and from --set, and their combinations.
namespace ricochet::case_test {

namespace {

std::string with_scheme(const std::string& keys) { return edited_case(9, keys); }

const std::string newmark = "scheme = \"newmark\"\n";
const std::string preset_file = with_scheme(newmark + "preset = \"textbook-half\"");
const std::string parameter_file = with_scheme(newmark + "beta = 0.3\ngamma = 0.6");

}  // namespace

TEST(ReadTime, PresetsStandForBetaAndGamma) {
  const Case half = read_text(preset_file);
  EXPECT_EQ(half.time.parameters.text("preset"), "textbook-half");
  EXPECT_EQ(half.time.parameters.number("beta"), 0.5);
  EXPECT_EQ(half.time.parameters.number("gamma"), 0.5);
  EXPECT_EQ(half.values.at("time.beta"), "0.5");  // the value in effect, so that `when` can test it
  EXPECT_EQ(half.values.at("time.preset"), "textbook-half");
  const Case trapezoidal = read_text(preset_file, {"time.preset=trapezoidal"});
  EXPECT_EQ(trapezoidal.time.parameters.number("beta"), 0.25);
  EXPECT_EQ(trapezoidal.time.parameters.number("gamma"), 0.5);
}

TEST(ReadTime, NewmarkKeysOfTheFileAreIgnoredWhenTheSchemeIsReplaced) {
  const Case read = read_text(parameter_file, {"time.scheme=midpoint"});
  EXPECT_EQ(read.time.scheme, "midpoint");
  EXPECT_EQ(read.values.count("time.beta"), 0U);
  EXPECT_EQ(read.values.count("time.gamma"), 0U);
  EXPECT_FALSE(read_text(preset_file, {"time.scheme=klr-conserving"}).time.parameters.has("preset"));
  EXPECT_EQ(problems_of(parameter_file, {"time.scheme=midpoint", "time.beta=0.25"}),
            "--set time.beta=0.25: \"beta\" is for the scheme \"newmark\" only; the scheme is \"midpoint\"");
}

TEST(ReadTime, OfPresetAndParametersWhatSetGivesCounts) {
  const Case preset = read_text(parameter_file, {"time.preset=trapezoidal"});
  EXPECT_EQ(preset.time.parameters.text("preset"), "trapezoidal");
  EXPECT_EQ(preset.time.parameters.number("beta"), 0.25);
  EXPECT_EQ(preset.time.parameters.number("gamma"), 0.5);
  const Case beta = read_text(preset_file, {"time.beta=0.3"});
  EXPECT_FALSE(beta.time.parameters.has("preset"));
  EXPECT_EQ(beta.time.parameters.number("beta"), 0.3);
  EXPECT_EQ(beta.time.parameters.number("gamma"), 0.5);
  EXPECT_EQ(beta.values.count("time.preset"), 0U);
  EXPECT_NE(problems_of(parameter_file, {"time.preset=trapezoidal", "time.beta=0.3"}), "");
}

TEST(ReadTime, AFileForAnotherSchemeNeedsParametersForNewmark) {
  const std::string midpoint = with_scheme("scheme = \"midpoint\"");
  EXPECT_EQ(problems_of(midpoint, {"time.scheme=newmark"}),
            "--set time.scheme=newmark: the scheme \"newmark\" needs \"beta\" and \"gamma\", or a \"preset\": "
            "\"trapezoidal\" "
            "(beta = 0.25, gamma = 0.5) or \"textbook-half\" (beta = 0.5, gamma = 0.5); \"beta\" is missing");
  EXPECT_EQ(read_text(midpoint, {"time.scheme=newmark", "time.preset=trapezoidal"}).time.parameters.number("beta"),
            0.25);
}

TEST(ReadTime, WarnsOfInstability) {
  const auto warnings_of = [](const std::string& keys) {
    std::vector<std::string> warnings;
    const log::CollectWarnings collect(warnings);
    static_cast<void>(read_text(with_scheme(newmark + keys)));
    return warnings;
  };
  EXPECT_TRUE(warnings_of("preset = \"trapezoidal\"").empty());
  EXPECT_TRUE(warnings_of("beta = 0.3025\ngamma = 0.6").empty());
  ASSERT_EQ(warnings_of("beta = 0.25\ngamma = 0.4").size(), 1U);
  EXPECT_TRUE(has(warnings_of("beta = 0.25\ngamma = 0.4")[0], "unstable with gamma = 0.4"));
  ASSERT_EQ(warnings_of("beta = 0.1\ngamma = 0.5").size(), 1U);
  EXPECT_TRUE(has(warnings_of("beta = 0.1\ngamma = 0.5")[0], "only conditionally stable"));
}

TEST(ReadTime, OneStepIsEnough) { EXPECT_EQ(read_text(edited_case(10, "step = 1.0")).time.step, 1.0); }

TEST(ReadTime, RefusesStepsThatNumbersDoNotReach) {
  const std::string square =
      ": its square is outside the range of floating-point numbers; choose a unit of time in which steps are closer to "
      "1";
  const std::string file = with_scheme("scheme = \"midpoint\"");
  for (const std::string step : {"1e-300", "1e-160", "5e-324", "1e+300"}) {
    EXPECT_EQ(problems_of(file, {"time.step=" + step, "time.end=" + step}),
              "--set time.step=" + step + ": \"step\" is " + step + square);
    EXPECT_EQ(problems_of(file, {"time.step=adaptive", "time.largest=" + step, "time.end=" + step}),
              "--set time.largest=" + step + ": \"largest\" is " + step + square);
  }
  EXPECT_EQ(problems_of(file, {"time.step=1e-100", "time.end=1e-98"}), "") << "an odd unit of time, and no more";
}

TEST(ReadTime, RefusesShortestStepsInWhichTimesCannotBeCounted) {
  const std::string file = with_scheme("scheme = \"midpoint\"");
  const auto problem = [&](const std::string& smallest, const std::string& end) {
    return problems_of(file,
                       {"time.step=adaptive", "time.largest=0.01", "time.end=" + end, "time.smallest=" + smallest});
  };
  for (const std::string smallest : {"1e-300", "5e-324", "1e-17"}) {
    EXPECT_EQ(problem(smallest, "0.1"),
              "--set time.smallest=" + smallest + ": \"smallest\" is " + smallest +
                  ", too short compared with \"largest\", 0.01, and \"end\", 0.1: times are whole multiples of it and "
                  "would lose digits; set at least 9.1e-15, or remove it");
  }
  EXPECT_EQ(problem("9.1e-15", "0.1"), "") << "what the message says is enough";
  // Far from zero the end decides: 2e-9 of it are 1e15.
  EXPECT_EQ(problem("1e-8", "1e6"), "");
  EXPECT_NE(problem("1e-11", "1e6"), "");
  EXPECT_TRUE(has(problem("1e-12", "1e6"), "set at least 1.5e-10"));
  EXPECT_EQ(problem("1.5e-10", "1e6"), "");
}

}  // namespace ricochet::case_test
