#include "ricochet/io/history_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ricochet/base/temporary_folder.hpp"
#include "support/errors.hpp"

namespace ricochet::test_support {
namespace {

std::string problem_of(const std::string& text) {
  const TemporaryFolder folder(std::filesystem::temp_directory_path(), "history");
  const std::string file = folder.file("history.csv");
  std::ofstream(file) << text;
  return message_of([&] { (void)read_history(file, false); });
}

/// A file without its first row has numbers in the row of column names.
TEST(HistoryFile, TakesNoNumbersForNames) {
  EXPECT_EQ(problem_of("step,time,gap\n0,0,nan\n1,0.5,-1e-3\n"), "");
  for (const std::string row : {"0,0,0.1", "1,0.5,nan", "step,time,-0.1"})
    EXPECT_TRUE(
        has(problem_of(row + "\n1,0.5,0.1\n"), "/history.csv:1: the first row must hold the names of the columns"));
  EXPECT_TRUE(has(problem_of("step,time\n0,0.5m\n"), "/history.csv:2: column 2 (\"time\") is not a number"));
}

}  // namespace
}  // namespace ricochet::test_support
