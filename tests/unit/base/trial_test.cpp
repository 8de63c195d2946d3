#include "ricochet/base/trial.hpp"

#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <stdexcept>

namespace ricochet {
namespace {

TEST(Trial, TellsWhatCameOfTheWork) {
  EXPECT_TRUE(try_in_child([] { return true; }, 10.0).succeeded);
  const TrialResult failed = try_in_child([] { return false; }, 10.0);
  EXPECT_FALSE(failed.succeeded);
  EXPECT_EQ(failed.signal, 0);
  EXPECT_FALSE(try_in_child([]() -> bool { throw std::runtime_error("no"); }, 10.0).succeeded);
  const TrialResult crashed = try_in_child([] { return raise(SIGSEGV) == 0; }, 10.0);
  EXPECT_FALSE(crashed.succeeded);
  EXPECT_EQ(crashed.signal, SIGSEGV);
  EXPECT_EQ(crashed.description(), "crashed with signal 11");
}

/// A daemon that ignores the ends of its children passes this on to the processes it starts.
TEST(Trial, TellsWhatCameOfTheWorkWhereEndsOfChildrenAreIgnored) {
  const auto before = signal(SIGCHLD, SIG_IGN);
  EXPECT_TRUE(try_in_child([] { return true; }, 10.0).succeeded);
  EXPECT_EQ(try_in_child([] { return raise(SIGSEGV) == 0; }, 10.0).signal, SIGSEGV);
  EXPECT_EQ(signal(SIGCHLD, before), SIG_IGN) << "as it was";
}

TEST(Trial, EndsWhatHasNoEnd) {
  volatile bool goes_on = true;
  const TrialResult endless = try_in_child(
      [&] {
        while (goes_on) {
        }
        return true;
      },
      0.5);
  EXPECT_TRUE(endless.endless);
  EXPECT_EQ(endless.description(), "does not end");
}

/// Effects of the child stay in the child: neither memory nor handlers of this process change.
TEST(Trial, LeavesThisProcessAlone) {
  static volatile sig_atomic_t handled = 0;
  const auto before = signal(SIGABRT, [](int) { handled = 1; });
  int value = 1;
  const TrialResult outcome = try_in_child(
      [&value]() -> bool {
        value = 2;
        std::abort();
      },
      10.0);
  signal(SIGABRT, before);
  EXPECT_EQ(outcome.signal, SIGABRT);
  EXPECT_EQ(value, 1);
  EXPECT_EQ(handled, 0);
}

}  // namespace
}  // namespace ricochet
