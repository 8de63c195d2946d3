#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ricochet/base/file_version.hpp"
#include "ricochet/base/json.hpp"
#include "ricochet/base/temporary_folder.hpp"
#include "ricochet/io/summary.hpp"
#include "ricochet/version.hpp"

namespace ricochet {
namespace {

/// Text of a summary of this version.
std::string written_summary() {
  RunSummary summary;
  summary.version = version;
  return to_json(summary);
}

/// Last numbers of versions do not matter; files of earlier and later versions are refused with both versions and
/// advice.
TEST(SummaryFile, RefusesFilesOfOtherVersions) {
  const std::string text = written_summary(), own = fmt::format("\"ricochet_version\": \"{}\"", version);
  ASSERT_NE(text.find(own), std::string::npos) << text;
  const TemporaryFolder folder(std::filesystem::temp_directory_path(), "ricochet-test");
  const auto with = [&](const std::string& other) {
    std::string changed = text;
    return changed.replace(text.find(own), own.size(), fmt::format("\"ricochet_version\": \"{}\"", other));
  };
  const std::string patched = std::string(version) + "7";
  EXPECT_EQ(summary_from_json(with(patched), "a").version, patched);
  for (const std::string other : {"0.2.9", "0.1.0", "1000.0.0"}) {
    try {
      static_cast<void>(summary_from_json(with(other), "a/summary.json"));
      ADD_FAILURE() << other;
    } catch (const VersionError& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_input);
      for (const std::string& part : {std::string("a/summary.json: "), "Ricochet " + other, std::string(version)})
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
    std::ofstream(folder.file("summary.json")) << with(other);
    EXPECT_THROW(static_cast<void>(find_intact_summary(folder.path().string())), VersionError);
  }
  std::ofstream(folder.file("summary.json")) << text.substr(0, text.size() / 2);
  EXPECT_FALSE(find_intact_summary(folder.path().string()).has_value());
}

/// Every entry of the file is required: nothing stands for one that is missing.
TEST(SummaryFile, RefusesAFileWithoutAnEntry) {
  const Json whole = Json::parse(written_summary());
  EXPECT_GT(whole.size(), 50U);
  for (const auto& [left_out, ignored] : whole.items()) {
    Json part = Json::object();
    for (const auto& [name, value] : whole.items())
      if (name != left_out) part[name] = value;
    try {
      static_cast<void>(summary_from_json(part.dump(), "a"));
      const bool is_derived = left_out == "critical_fraction" || left_out == "energy_scale";
      EXPECT_TRUE(is_derived) << left_out;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find('"' + left_out + '"'), std::string::npos) << error.what();
    }
  }
}

TEST(SummaryFile, KnowsThePathsOfNumbers) {
  for (const char* path :
       {"steps", "impacts.3.restitution", "impacts.0.velocity_after.2", "extrema.total_energy.maximum",
        "extrema.lowest.gap.maximum", "timings_seconds.steps", "bodies.0.moment_of_inertia"})
    EXPECT_EQ(summary_path_problem(path), "") << path;
  const std::string no_entry = "summary.json has no entry ";
  EXPECT_EQ(summary_path_problem("impacts.0.restituton"),
            no_entry + "\"impacts.0.restituton\"; did you mean \"impacts.0.restitution\"?");
  EXPECT_EQ(summary_path_problem("impact.0.restitution"),
            no_entry + "\"impact.0.restitution\"; did you mean \"impacts.0.restitution\"?");
  EXPECT_EQ(summary_path_problem("extrema.lowest.gap.maximm"),
            no_entry + "\"extrema.lowest.gap.maximm\"; did you mean \"extrema.lowest.gap.maximum\"?");
  EXPECT_EQ(summary_path_problem("extrema.time.rocket"),
            no_entry +
                "\"extrema.time.rocket\"; extrema.time has \"first\", \"last\", \"minimum\", \"maximum\" and "
                "\"total_variation\"");
  EXPECT_EQ(summary_path_problem("steps.0"), no_entry + "\"steps.0\"; steps has no entries");
  EXPECT_EQ(summary_path_problem("impacts.restitution"),
            "summary.impacts is a list: specify the entry, counted from 0, as in summary.impacts.0.restitution");
  // The example is a path that exists, whether the number is missing or something stands in its place.
  const std::string bodies = "summary.bodies is a list: specify the entry, counted from 0";
  EXPECT_EQ(summary_path_problem("bodies.cube.mass"), bodies + ", as in summary.bodies.0.mass");
  EXPECT_EQ(summary_path_problem("bodies.cube"), bodies);
  EXPECT_EQ(summary_path_problem("bodies."), bodies);
  EXPECT_EQ(summary_path_problem("impacts.0.velocity_after.x"),
            "summary.impacts.0.velocity_after is a list: specify the entry, counted from 0, as in "
            "summary.impacts.0.velocity_after.0");
  EXPECT_EQ(summary_path_problem("impacts.-1.restitution"),
            "summary.impacts is a list: specify the entry, counted from 0, not from the end, as in "
            "summary.impacts.0.restitution");
  for (const char* path : {"impacts", "impacts.0", "title", "extrema"})
    EXPECT_EQ(summary_path_problem(path), "summary." + std::string(path) + " is not a number");
}

/// The schema lists the entries in the order of the file, each with a text.
TEST(SummaryFile, HasASchema) {
  const Json schema = Json::parse(summary_schema()), whole = Json::parse(written_summary());
  std::vector<std::string> described, there;
  for (const auto& [name, entry] : schema.at("properties").items()) {
    described.push_back(name);
    EXPECT_GT(entry.at("description").get<std::string>().size(), 4U) << name;
  }
  for (const auto& [name, value] : whole.items()) there.push_back(name);
  EXPECT_EQ(described, there);
  const Json& impact = schema.at("properties").at("impacts").at("items");
  EXPECT_EQ(impact.at("title").get<std::string>(), "Impact");
  EXPECT_TRUE(impact.at("properties").contains("against"));
  EXPECT_EQ(impact.at("properties").at("end").at("type").dump(), R"(["number","null"])");
  EXPECT_EQ(impact.at("required").dump().find("\"against\""), std::string::npos);
}

}  // namespace
}  // namespace ricochet
