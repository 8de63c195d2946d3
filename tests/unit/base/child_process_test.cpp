#include "ricochet/base/child_process.hpp"

#include <gtest/gtest.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

#include "ricochet/base/temporary_folder.hpp"

namespace ricochet {
namespace {

class ChildProcesses : public testing::Test {
 protected:
  ChildProcess child(std::vector<std::string> arguments) const {
    ChildProcess result;
    result.arguments = std::move(arguments);
    result.output = folder_.file("output");
    return result;
  }
  [[nodiscard]] std::string said() const {
    std::ifstream file(folder_.file("output"));
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  TemporaryFolder folder_{std::filesystem::temp_directory_path(), "ricochet-test"};
};

TEST_F(ChildProcesses, TakeArgumentsVariablesAndInputAsTheyAre) {
  ChildProcess cat = child({"sh", "-c", "cat; printf '%s|' \"$@\" \"$WORD\"; echo error >&2", "sh", "a b", "$c", ""});
  cat.variables = {"WORD=one two"};
  const TemporaryFolder folder(std::filesystem::temp_directory_path(), "ricochet-test");
  cat.input = folder.file("input");
  std::ofstream(cat.input) << "input\n";
  EXPECT_TRUE(run_child(cat).succeeded());
  EXPECT_EQ(said(), "input\na b|$c||one two|error\n");
}

TEST_F(ChildProcesses, TellHowTheyEnd) {
  EXPECT_EQ(run_child(child({"sh", "-c", "exit 7"})).description(), "ended with status 7");
  EXPECT_EQ(run_child(child({"sh", "-c", "kill -9 $$"})).description(), "was killed by signal 9");
  const ChildResult absent = run_child(child({"ricochet-has-no-such-program"}));
  EXPECT_TRUE(absent.is_absent());
  EXPECT_FALSE(absent.succeeded());
  EXPECT_EQ(absent.description(), "cannot be run: No such file or directory");
  const ChildResult directory = run_child(child({std::filesystem::temp_directory_path().string()}));
  EXPECT_FALSE(directory.is_absent());
  EXPECT_EQ(directory.spawn_error, EACCES);
  ChildProcess without_input = child({"true"});
  without_input.input = "/there/is/no/such/file";
  EXPECT_EQ(run_child(without_input).spawn_error, ENOENT);
}

/// When the waiting process is killed and cannot react, its child ends with it.
TEST_F(ChildProcesses, EndWithTheProcessThatIsKilled) {
  ASSERT_EQ(prctl(PR_SET_CHILD_SUBREAPER, 1), 0);  // orphans come here
  const pid_t parent = fork();
  if (parent == 0) {
    static_cast<void>(run_child(child({"sh", "-c", "echo $$; exec sleep 600"})));
    _exit(0);
  }
  ASSERT_GT(parent, 0);
  for (int k = 0; k < 1000 && said().find('\n') == std::string::npos; ++k)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const auto grandchild = static_cast<pid_t>(std::stol(said()));
  ASSERT_EQ(kill(grandchild, 0), 0);
  ASSERT_EQ(kill(parent, SIGKILL), 0);
  int status = 0;
  ASSERT_EQ(waitpid(parent, &status, 0), parent);
  pid_t ended = 0;
  for (int k = 0; k < 1000 && ended == 0; ++k) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ended = waitpid(grandchild, &status, WNOHANG);
  }
  if (ended == 0) kill(grandchild, SIGTERM);
  ASSERT_EQ(ended, grandchild) << "it lives on";
  EXPECT_TRUE(WIFSIGNALED(status));
  EXPECT_EQ(WTERMSIG(status), SIGKILL);
  prctl(PR_SET_CHILD_SUBREAPER, 0);
}

}  // namespace
}  // namespace ricochet
