#include "ricochet/base/interruption.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "ricochet/base/temporary_folder.hpp"

namespace ricochet {
namespace {

namespace fs = std::filesystem;

// Taking the actions ends the process, so each test does it in a process of its own.

/// No interruption occurs between creating a resource and registering its removal.
TEST(Interruption, WaitsForWhatIsJustBeingMade) {
  const auto scenario = [] {
    std::thread other;
    bool is_made = false;
    const auto make = [&] {
      other = std::thread([] { _exit(interruption::run_actions() ? 1 : 2); });  // 1: nothing to remove yet
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      is_made = true;
    };
    const AtInterruption remove(make, [&] { _exit(is_made ? 0 : 3); });
    other.join();
  };
  EXPECT_EXIT(scenario(), testing::ExitedWithCode(0), "");
}

TEST(Interruption, WhatCouldNotBeMadeIsNotRemoved) {
  const auto fail = [] { throw std::runtime_error("no room"); };
  const auto scenario = [&] {
    try {
      const AtInterruption remove(fail, [] { _exit(1); });
    } catch (const std::runtime_error&) {
      _exit(interruption::run_actions() ? 0 : 2);
    }
  };
  EXPECT_EXIT(scenario(), testing::ExitedWithCode(0), "");
}

TEST(Interruption, TemporaryFoldersGo) {
  const TemporaryFolder outer(fs::temp_directory_path(), "ricochet-test");
  const auto scenario = [&] {
    const TemporaryFolder inner(outer.path(), "inner");
    std::ofstream(inner.file("file")) << "text";
    if (fs::is_empty(outer.path())) _exit(1);
    if (!interruption::run_actions()) _exit(2);
    // The process that takes the actions also takes those of the outer folder, but may have made it anew: check here.
    _exit(fs::exists(outer.path()) ? 3 : 0);
  };
  EXPECT_EXIT(scenario(), testing::ExitedWithCode(0), "");
}

/// A run at a stopping point is not ended half-way; the next run of the same process may be.
TEST(Interruption, AStoppingPointIsThatOfOneRun) {
  const auto scenario = [] {
    {
      const StoppingPoints first;
      interruption::reach_stopping_point();
      if (interruption::run_actions()) _exit(1);
    }
    if (interruption::has_stopping_points() || interruption::run_actions()) _exit(2);  // it still writes its results
    const StoppingPoints second;
    _exit(interruption::run_actions() ? 0 : 3);
  };
  EXPECT_EXIT(scenario(), testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace ricochet
