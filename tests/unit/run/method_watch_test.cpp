#include "ricochet/run/method_watch.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/error.hpp"

namespace ricochet {
namespace {

/// Enters a step with this method energy so far, and a mean of this weight that acts on a point, or on none.
void enter(MethodWatch& watch, double method_energy, double weight = 0.0, double reaction = 1.0) {
  State state;
  state.forces.mean_normal_reaction = Vector::Constant(1, reaction);
  state.forces.end_weight = weight;
  watch.enter_step(state, method_energy);
}

TEST(MethodWatch, TellsLossAndCreationAndWhatIsLeftOfThem) {
  MethodWatch watch(std::nullopt);
  enter(watch, 1.0);
  enter(watch, -3.0);
  enter(watch, -1.5);
  const MethodEnergy energy = watch.energy(8.0);
  EXPECT_EQ(energy.created, 1.0 / 8.0);
  EXPECT_EQ(energy.lost, 3.0 / 8.0);
  EXPECT_EQ(energy.at_end, -1.5 / 8.0);
  EXPECT_EQ(watch.energy(0.0).lost, 0.0) << "there is no energy";
  EXPECT_FALSE(watch.reactions().has_value()) << "the scheme has no choice";
}

TEST(MethodWatch, TellsTheWeightsThatActed) {
  MethodWatch watch(ActingReaction::mixed_mean);
  EXPECT_EQ(watch.reactions()->mean_steps, 0);
  enter(watch, 0.0, 0.25);
  enter(watch, 0.0, 0.5, 0.0);  // no pressure
  enter(watch, 0.0, 0.125);
  enter(watch, 0.0, 1.0);  // no mean was found
  const ActingReactions acting = *watch.reactions();
  EXPECT_EQ(acting.kind, "adaptive");
  EXPECT_EQ(acting.least_weight, 0.125);
  EXPECT_EQ(acting.largest_weight, 0.25);
  EXPECT_EQ(acting.mean_steps, 2);
  EXPECT_EQ(acting.end_steps, 1);
  MethodWatch of_end(ActingReaction::end);
  enter(of_end, 0.0, 0.25);
  EXPECT_EQ(of_end.reactions()->kind, "end");
  EXPECT_EQ(of_end.reactions()->mean_steps, 0);
}

/// Enters a step of parts in which corrections add these energies, and which ends with this energy.
void enter_corrections(MethodWatch& watch, double time, const std::vector<double>& added, double energy) {
  for (const double each : added) watch.enter_part({.velocity_correction = each, .energy_at_end = energy});
  State state;
  state.time = time;
  watch.enter_step(state, 0.0);
}

TEST(MethodWatch, CountsStepsWithLargeCorrectionsOfVelocities) {
  MethodWatch watch(std::nullopt, one_rank(), true);
  const double limit = VelocityCorrections::noticeable;
  enter_corrections(watch, 1.0, {0.5 * limit}, 2.0);
  EXPECT_EQ(watch.velocity_corrections()->steps, 0);
  EXPECT_EQ(watch.velocity_corrections()->largest, 0.25 * limit);
  enter_corrections(watch, 2.0, {1.5 * limit, -1.5 * limit}, 2.0);  // parts do not cancel
  enter_corrections(watch, 3.0, {-8.0 * limit}, 2.0);
  enter_corrections(watch, 4.0, {1.0}, 1e-13);  // at rest
  enter_corrections(watch, 5.0, {0.0}, 0.0);
  const VelocityCorrections found = *watch.velocity_corrections();
  EXPECT_EQ(found.steps, 2);
  EXPECT_EQ(found.first_time, 2.0);
  EXPECT_EQ(found.largest, 4.0 * limit);
  EXPECT_EQ(found.time, 3.0);
  EXPECT_FALSE(MethodWatch(std::nullopt).velocity_corrections().has_value()) << "the scheme makes none";

  Snapshot snapshot;
  watch.persist(snapshot.saver("method"));
  MethodWatch resumed(std::nullopt, one_rank(), true);
  resumed.persist(snapshot.loader("method"));
  enter_corrections(resumed, 6.0, {-9.0 * limit}, 2.0);
  EXPECT_EQ(resumed.velocity_corrections()->steps, 3);
  EXPECT_EQ(resumed.velocity_corrections()->first_time, 2.0);
  EXPECT_EQ(resumed.velocity_corrections()->time, 6.0);
}

TEST(MethodWatch, GoesOnFromASnapshot) {
  MethodWatch watch(ActingReaction::mixed_mean), resumed(ActingReaction::mixed_mean);
  enter(watch, -1.0, 0.25);
  Snapshot snapshot;
  watch.persist(snapshot.saver("method"));
  resumed.persist(snapshot.loader("method"));
  for (MethodWatch* each : {&watch, &resumed}) enter(*each, -0.5, 0.5);
  Snapshot one, other;
  watch.persist(one.saver("method"));
  resumed.persist(other.saver("method"));
  EXPECT_TRUE(one.values() == other.values());
  EXPECT_EQ(resumed.energy(1.0).lost, 1.0);
  snapshot.save("method.steps", Snapshot::Integers{1});
  EXPECT_THROW(resumed.persist(snapshot.loader("method")), Error);
}

}  // namespace
}  // namespace ricochet
