#include "ricochet/io/results_format.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "ricochet/case/read_case.hpp"

/// @file Formats of fields by their files.
namespace ricochet {
namespace {

namespace fs = std::filesystem;

class ResultsFormats : public ::testing::Test {
 protected:
  void SetUp() override {
    directory_ = fs::temp_directory_path() / ("ricochet_formats_" + std::to_string(::getpid()));
    fs::create_directories(directory_);
  }
  void TearDown() override { fs::remove_all(directory_); }
  void make(const std::string& file) const { std::ofstream(directory_ / file) << "?"; }
  [[nodiscard]] std::string found() const {
    const ResultsFormat* const format = find_results_format(directory_.string());
    return format != nullptr ? format->file_names() : "";
  }

  fs::path directory_;
};

TEST_F(ResultsFormats, AreRecognizedByAllTheirFiles) {
  for (const Registration<ResultsFormat>& entry : results_format_registry().all()) {
    SCOPED_TRACE(entry.name);
    EXPECT_EQ(found(), "");
    for (const std::string& file : entry.type.files) {
      EXPECT_EQ(found(), "");
      make(file);
    }
    EXPECT_EQ(found(), entry.type.file_names());
    for (const std::string& file : entry.type.files) fs::remove(directory_ / file);
  }
}

TEST_F(ResultsFormats, HaveFilesOfTheirOwnAndLockNoneThatHdf5Locks) {
  const std::vector<std::string> files = files_of_all_formats();
  EXPECT_EQ(std::set<std::string>(files.begin(), files.end()).size(), files.size());
  for (const Registration<ResultsFormat>& entry : results_format_registry().all())
    EXPECT_NE(entry.type.lock, entry.type.files.front()) << entry.name;
}

TEST_F(ResultsFormats, OfAUsersProgramAreChoicesOfTheCaseFile) {
  ResultsFormat mine = results_format_registry().find("xdmf").type;
  mine.description = "fields.mine";
  mine.files = {"fields.mine"};
  mine.obstacles = "obstacles.mine";
  results_format_registry().add({"mine", mine});
  const std::string text =
      "[mesh]\nfile = \"a.msh\"\n[[material]]\ngroup = \"a\"\ndensity = 1.0\nlambda = 1.0\nmu = 1.0\n"
      "[time]\nscheme = \"midpoint\"\nstep = 0.1\nend = 1.0\n[output]\nformat = \"mine\"\n";
  EXPECT_EQ(read_case_text(text, "a.toml").output.format, "mine");
  EXPECT_NE(case_reference().find("which ParaView and meshio read, results.vtkhdf, one file with all frames for "
                                  "ParaView 5.12 and later, or fields.mine."),
            std::string::npos);
  make("results.vtkhdf");
  make("fields.mine");
  EXPECT_EQ(found(), "fields.mine") << "the later one";
  results_format_registry().remove("mine");
  EXPECT_EQ(found(), "results.vtkhdf");
}

}  // namespace
}  // namespace ricochet
