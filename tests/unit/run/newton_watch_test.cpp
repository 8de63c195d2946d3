#include "ricochet/run/newton_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ricochet/base/error.hpp"

namespace ricochet {
namespace {

/// Number of the step, from 1, after which it reports; 0 if it does not.
int warns_after(NewtonWatch& watch, const std::vector<int>& iterations) {
  int warned = 0;
  for (std::size_t k = 0; k < iterations.size(); ++k) {
    if (!watch.enter_step(iterations[k], 0.5)) continue;
    EXPECT_EQ(warned, 0) << "it warns twice";
    warned = int(k) + 1;
  }
  return warned;
}

TEST(NewtonWatch, TellsOnceWhereManyIterationsBecomeUsual) {
  NewtonWatch in_a_row, with_others, now_and_then;
  EXPECT_EQ(warns_after(in_a_row, {10, 201, 1700, 390, 201, 5000, 700, 700}), 4);
  EXPECT_EQ(in_a_row.steps(), 7);
  EXPECT_DOUBLE_EQ(in_a_row.seconds_per_step(), 0.5);
  EXPECT_EQ(warns_after(with_others, {500, 30, 500, 30, 500, 30, 500, 30, 500}), 7);
  std::vector<int> rare;
  for (int k = 0; k < 200; ++k) rare.push_back(k % 20 == 0 ? 2000 : 200);
  EXPECT_EQ(warns_after(now_and_then, rare), 0);
}

TEST(NewtonWatch, GoesOnFromACheckpoint) {
  NewtonWatch watch;
  EXPECT_EQ(warns_after(watch, {500, 500}), 0);
  Snapshot snapshot;
  watch.persist(snapshot.saver("newton"));
  NewtonWatch other;
  other.persist(snapshot.loader("newton"));
  EXPECT_EQ(warns_after(other, {500, 500}), 1);
  EXPECT_EQ(other.steps(), 4);
}

TEST(NewtonWatch, RefusesACheckpointThatIsDamaged) {
  Snapshot snapshot;
  NewtonWatch().persist(snapshot.saver("newton"));
  const Vector good = snapshot.reals("newton");
  for (Index k = 0; k < good.size(); ++k) {
    for (const double bad : {-1.0, 1e15, std::numeric_limits<double>::infinity(), std::nan("")}) {
      Vector damaged = good;
      damaged[k] = bad;
      snapshot.save("newton", damaged);
      EXPECT_THROW(NewtonWatch().persist(snapshot.loader("newton")), Error) << k << ": " << bad;
    }
  }
  EXPECT_THROW(NewtonWatch().persist(Snapshot().loader("newton")), Error);
}

}  // namespace
}  // namespace ricochet
