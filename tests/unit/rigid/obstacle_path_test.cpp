#include "ricochet/rigid/obstacle_path.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "ricochet/base/temporary_folder.hpp"
#include "support/errors.hpp"

namespace ricochet::test_support {
namespace {

TEST(ObstaclePath, FollowsATable) {
  const TemporaryFolder folder(std::filesystem::temp_directory_path(), "path");
  const std::string file = folder.file("motion.csv");
  std::ofstream(file) << "t,x,y,angle\n0,0,0,0\n1, 2, 0, 0.5\n# half as fast\n3,4,-1,0.5\n";
  const auto path = read_path(file, 2);
  EXPECT_TRUE(path->rotates());
  EXPECT_NEAR(path->displacement(0.5)[0], 1.0, 1e-15);
  EXPECT_NEAR(path->displacement(2.0)[1], -0.5, 1e-15);
  EXPECT_NEAR(path->rotation(0.2)[0], 0.1, 1e-15);
  EXPECT_EQ(path->displacement(-1.0)[0], 0.0);
  EXPECT_EQ(path->displacement(9.0)[0], 4.0);
  const auto problem = [&](const std::string& text, Index dimension) {
    std::ofstream(file) << text;
    return message_of([&] { (void)read_path(file, dimension); });
  };
  EXPECT_TRUE(has(problem("0 0 0\n1 0\n", 2), "motion.csv:2: 2 numbers"));
  EXPECT_TRUE(has(problem("0 0 0\n0 1 1\n", 2), "motion.csv:2: the time 0 is not after 0"));
  EXPECT_TRUE(has(problem("0 0 0\n1 nan 1\n", 2), "motion.csv:2:3: "));
  // The first line, too: a header is letters.
  EXPECT_TRUE(has(problem("0.0 0.0m 0.0\n1 1 1\n", 2), "motion.csv:1:5: \"0.0m\" is not a finite number"));
  EXPECT_TRUE(has(problem("0 nan 0\n1 1 1\n", 2), "motion.csv:1:3: "));
  EXPECT_TRUE(has(problem("t x y\n", 2), "contains no numbers"));
  EXPECT_TRUE(has(problem("0 0 0\n", 3), "motion.csv:1: 3 numbers; each line of a motion in 3D must have 4"));
}

}  // namespace
}  // namespace ricochet::test_support
