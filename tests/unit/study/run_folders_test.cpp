#include "ricochet/study/run_folders.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ricochet/base/error.hpp"
#include "ricochet/base/temporary_folder.hpp"

namespace ricochet {
namespace {

namespace fs = std::filesystem;

TEST(RunFolders, HaveNamesThatLeadNowhereElse) {
  for (const char* name : {"001-step=1e-3_scheme=newmark+x", "rod", "bar-newmark-consistent", "a..b"})
    EXPECT_TRUE(is_run_folder_name(name)) << name;
  for (const std::string name : {"", ".", "..", "../a", "/a", "a/b", "a/../../b", ".git", "a\\b", "a\nb", "a b", "é"})
    EXPECT_FALSE(is_run_folder_name(name)) << name;
  EXPECT_FALSE(is_run_folder_name(std::string_view("a\0b", 3)));
  EXPECT_THROW(require_run_folder_names({"a", "b", "a"}, "study.json"), Error);
}

TEST(RunFolders, AreRemovedAllOrNone) {
  const TemporaryFolder folder(fs::temp_directory_path(), "ricochet-test");
  const std::string directory = folder.path().string();
  EXPECT_NO_THROW(remove_run_folders(directory, {"a"})) << "nothing is there";
  const fs::path runs = folder.path() / "runs";
  for (const char* name : {"a", "empty", "mine", "other"}) fs::create_directories(runs / name);
  std::ofstream(runs / "a" / "summary.json") << "{}";
  std::ofstream(runs / "mine" / "thesis.tex") << "words";
  EXPECT_THROW(remove_run_folders(directory, {"a", "empty", "mine"}), Error);
  EXPECT_TRUE(fs::exists(runs / "a"));
  EXPECT_THROW(remove_run_folders(directory, {"a", "../runs/other"}), Error);
  EXPECT_TRUE(fs::exists(runs / "a"));
  remove_run_folders(directory, {"a", "empty", "gone"});
  EXPECT_FALSE(fs::exists(runs / "a"));
  EXPECT_FALSE(fs::exists(runs / "empty"));
  EXPECT_TRUE(fs::exists(runs / "mine"));
  EXPECT_TRUE(fs::exists(runs / "other"));
}

}  // namespace
}  // namespace ricochet
