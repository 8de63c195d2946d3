#include "ricochet/study/benchmark/manifest.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ricochet/base/temporary_folder.hpp"
#include "support/errors.hpp"
#include "support/paths.hpp"

namespace ricochet::test_support {
namespace {

class BenchmarkManifest : public ::testing::Test {
 protected:
  /// Returns the error message for a manifest with this text next to a file a.toml.
  std::string problem_of(const std::string& text) {
    std::ofstream(folder_.file("a.toml")) << "";
    std::ofstream(folder_.file("benchmarks.toml")) << text;
    return message_of([&] { benchmarks_ = read_benchmarks(folder_.file("benchmarks.toml")); });
  }

  TemporaryFolder folder_{std::filesystem::temp_directory_path(), "ricochet-test"};
  std::vector<Benchmark> benchmarks_;
};

TEST_F(BenchmarkManifest, NamesCasesRelativeToItself) {
  EXPECT_EQ(problem_of("[[benchmark]]\nname = \"a\"\ncase = \"sub/../a.toml\"\ngroup = \"bars\"\n"
                       "description = \"A bar\"\n"),
            "");
  ASSERT_EQ(benchmarks_.size(), 1u);
  EXPECT_EQ(benchmarks_[0].name, "a");
  EXPECT_EQ(benchmarks_[0].case_path, folder_.file("a.toml"));
  EXPECT_EQ(benchmarks_[0].group, "bars");
  EXPECT_EQ(benchmarks_[0].description, "A bar");
}

TEST_F(BenchmarkManifest, TellsAllThatIsWrong) {
  const std::string problem = problem_of(
      "[[benchmark]]\nname = \"a\"\ncase = \"b.toml\"\n[[benchmark]]\nname = \"a\"\nfile = \"a.toml\"\n"
      "[[benchmark]]\nname = \"a/b\"\ncase = 3\ndescripton = \"c\"\n[benchmarks]\n");
  for (const char* part :
       {"benchmarks.toml:3:", "there is no file", "two benchmarks have the name \"a\"", "unknown key \"file\"",
        "needs a \"case\"", "letters, digits", "must be a text; found the integer 3", "did you mean \"description\"?",
        "unknown key \"benchmarks\""})
    EXPECT_TRUE(has(problem, part)) << part << " in\n" << problem;
  EXPECT_TRUE(has(problem_of(""), "lists no benchmark"));
}

TEST_F(BenchmarkManifest, ChoosesByNameInItsOwnOrder) {
  const std::vector<Benchmark> all{{"rod", "", "", ""}, {"bar", "", "", ""}, {"layer", "", "", ""}};
  EXPECT_EQ(choose_benchmarks(all, {}).size(), 3u);
  const std::vector<Benchmark> chosen = choose_benchmarks(all, {"layer", "rod", "layer"});
  ASSERT_EQ(chosen.size(), 2u);
  EXPECT_EQ(chosen[0].name, "rod");
  EXPECT_EQ(chosen[1].name, "layer");
  EXPECT_EQ(message_of(
                [&] {
                  static_cast<void>(choose_benchmarks(all, {"rod", "layr"}));
                },
                ErrorKind::usage),
            "benchmark: there is no \"layr\" (did you mean \"layer\"?); available: rod, bar and layer");
}

TEST_F(BenchmarkManifest, OfTheProjectIsRight) {
  const std::vector<Benchmark> all = read_benchmarks(source_path("benchmarks/benchmarks.toml"));
  EXPECT_GT(all.size(), 20u);
  for (const Benchmark& benchmark : all) EXPECT_FALSE(benchmark.description.empty()) << benchmark.name;
}

}  // namespace
}  // namespace ricochet::test_support
