#include "ricochet/base/child_processes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <string>

#include "ricochet/base/timer.hpp"

namespace ricochet {
namespace {

ChildProcess shell(const std::string& command) {
  ChildProcess child;
  child.arguments = {"sh", "-c", command};
  child.output = "/dev/null";
  return child;
}

TEST(RunChildren, RunsAllInOrderAndNoMoreThanSoManyAtOnce) {
  for (const std::size_t at_once : {1u, 3u}) {
    std::vector<std::size_t> begun;
    std::vector<int> statuses(7, -1);
    std::size_t running = 0, most = 0;
    PoolWork work;
    work.make = [&](std::size_t i) {
      begun.push_back(i);
      most = std::max(most, ++running);
      return shell("sleep 0.05; exit " + std::to_string(i));
    };
    work.ended = [&](std::size_t i, const ChildResult& outcome) {
      --running;
      statuses[i] = outcome.exit_status();
    };
    EXPECT_EQ(run_children(7, at_once, work), 0);
    EXPECT_EQ(begun, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(statuses, (std::vector<int>{0, 1, 2, 3, 4, 5, 6}));
    EXPECT_EQ(most, at_once);
  }
}

TEST(RunChildren, EndsThoseThatRunAndStartsNoMoreWhenASignalComes) {
  const Timer timer;
  std::vector<std::size_t> ended;
  int begun = 0;
  PoolWork work;
  work.make = [&](std::size_t i) {
    ++begun;
    // One child ends as requested, in its own way; the other would continue.
    return shell(i == 0 ? "trap 'exit 7' TERM; sleep 600 & wait" : "sleep 600");
  };
  work.ended = [&](std::size_t i, const ChildResult& outcome) {
    ended.push_back(i);
    EXPECT_FALSE(outcome.succeeded());
  };
  work.stop_signal = [&] { return timer.seconds() > 0.3 ? SIGINT : 0; };
  EXPECT_EQ(run_children(5, 2, work), SIGINT);
  EXPECT_EQ(begun, 2);
  std::ranges::sort(ended);
  EXPECT_EQ(ended, (std::vector<std::size_t>{0, 1}));
  EXPECT_LT(timer.seconds(), 5.0);
}

TEST(RunChildren, TellsOfAProgramThatIsNotThere) {
  PoolWork work;
  bool is_absent = false;
  work.make = [](std::size_t) {
    ChildProcess child;
    child.arguments = {"ricochet-has-no-such-program"};
    child.output = "/dev/null";
    return child;
  };
  work.ended = [&](std::size_t, const ChildResult& outcome) { is_absent = outcome.is_absent(); };
  EXPECT_EQ(run_children(1, 1, work), 0);
  EXPECT_TRUE(is_absent);
}

TEST(UsableCores, AreAtLeastOne) { EXPECT_GE(usable_cores(), 1u); }

}  // namespace
}  // namespace ricochet
