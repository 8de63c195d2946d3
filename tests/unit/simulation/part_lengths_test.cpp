#include "ricochet/simulation/part_lengths.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "ricochet/base/error.hpp"
#include "support/errors.hpp"
#include "support/same_snapshots.hpp"

namespace ricochet {
namespace {

constexpr long whole = PartLengths::whole;

struct Attempts {
  long solved = 0, failed = 0;
};

/// Takes a step in which parts above the level `longest` have no solution.
Attempts take_step(PartLengths& lengths, int longest) {
  Attempts attempts;
  do {
    if (lengths.level() < longest) {
      lengths.record_failure();
      ++attempts.failed;
    } else {
      lengths.record_solution();
      ++attempts.solved;
    }
  } while (lengths.done() > 0 || attempts.solved == 0);
  return attempts;
}

/// Each step begins whole, and tries a longer part as soon as it fits.
TEST(PartLengths, StartAnewWithoutMemory) {
  PartLengths lengths(false);
  for (int step = 0; step < 3; ++step) {
    const Attempts attempts = take_step(lengths, 3);
    EXPECT_EQ(attempts.solved, 8);
    // At the start 1, 1/2 and 1/4 fail, then 1/4, after half of the step 1/2 and 1/4, and 1/4 at last.
    EXPECT_EQ(attempts.failed, 3 + 1 + 2 + 1);
    EXPECT_EQ(lengths.level(), 0);
  }
}

TEST(PartLengths, AreWholeStepsUntilOneFails) {
  PartLengths lengths;
  for (int step = 0; step < 5; ++step) EXPECT_EQ(take_step(lengths, 0).solved, 1);
}

/// In a difficulty that lasts, the length is found by halving once, and pauses of 1, 2 and 4 lengths precede the ones
/// of 8 lengths or 16 solved parts.
TEST(PartLengths, FailRarelyInADifficultyThatLasts) {
  for (int longest = 1; longest <= PartLengths::deepest; ++longest) {
    PartLengths lengths;
    Attempts all;
    for (int step = 0; step < 100; ++step) {
      const Attempts attempts = take_step(lengths, longest);
      EXPECT_EQ(attempts.solved, 1L << longest);
      all.solved += attempts.solved;
      all.failed += attempts.failed;
    }
    EXPECT_LE(all.failed, longest + 3 + all.solved / 16) << longest;
  }
}

/// A longer part is never further away than its longest pause, and each success allows the next one.
TEST(PartLengths, GrowToWholeStepsAfterADifficulty) {
  for (int longest = 1; longest <= PartLengths::deepest; ++longest) {
    PartLengths lengths;
    for (int step = 0; step < 100; ++step) take_step(lengths, longest);
    const int pause = 1 + (PartLengths::longest_pause * 2 >> longest);
    for (int step = 0; step <= pause; ++step) take_step(lengths, 0);
    const Attempts after = take_step(lengths, 0);
    EXPECT_EQ(after.solved, 1) << longest;
    EXPECT_EQ(after.failed, 0) << longest;
  }
}

/// After a step that fails once and is solved in halves the next one is whole.
TEST(PartLengths, AreWholeAfterASingleFailure) {
  PartLengths lengths;
  EXPECT_EQ(take_step(lengths, 1).solved, 2);
  EXPECT_EQ(take_step(lengths, 0).solved, 1);
}

TEST(PartLengths, EndWithTheStepWhateverFails) {
  std::mt19937 random(3);
  PartLengths lengths;
  for (int attempt = 0; attempt < 10000; ++attempt) {
    const long length = whole >> lengths.level();
    EXPECT_EQ(lengths.done() % length, 0);
    EXPECT_LE(lengths.done() + length, whole);
    if (!lengths.is_shortest() && random() % 3 == 0) {
      lengths.record_failure();
    } else {
      lengths.record_solution();
    }
  }
}

TEST(PartLengths, ContinueFromASnapshot) {
  PartLengths lengths;
  for (int step = 0; step < 7; ++step) take_step(lengths, 3);
  Snapshot saved, again;
  lengths.persist(saved.saver("parts"));
  PartLengths loaded;
  loaded.persist(saved.loader("parts"));
  loaded.persist(again.saver("parts"));
  test_support::expect_same(saved, again);
  for (int step = 0; step < 20; ++step) {
    const int longest = step < 10 ? 3 : 0;
    const Attempts expected = take_step(lengths, longest), found = take_step(loaded, longest);
    EXPECT_EQ(found.solved, expected.solved) << step;
    EXPECT_EQ(found.failed, expected.failed) << step;
  }
  saved.save("parts.level", std::int64_t{9});
  EXPECT_TRUE(test_support::has(
      test_support::message_of([&] { loaded.persist(saved.loader("parts")); }, ErrorKind::invalid_input),
      "parts.level"));
}

}  // namespace
}  // namespace ricochet
