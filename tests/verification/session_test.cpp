#include <gtest/gtest.h>

#include <filesystem>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/case/read_case.hpp"
#include "ricochet/io/history_file.hpp"
#include "ricochet/run/session.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Sessions: runs of a case controlled by the program that opens it.
namespace ricochet::test_support::session_test {

std::string block_text() {
  return thrown_case(one_sided_block(), "equivalent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n",
                     "friction = 0.3\n");
}

class SessionTest : public ::testing::Test {
 protected:
  void SetUp() override {
    log::set_level(log::Level::error);
    path_ = write_temporary("case.toml", block_text());
    directory_ = (std::filesystem::path(path_).parent_path() / "out").string();
  }
  std::string path_, directory_;
};

TEST_F(SessionTest, StepsToTheEndOfTheRun) {
  Session session(path_, {"time.end=0.5"});
  EXPECT_EQ(session.steps(), 50);
  long steps = 0;
  session.run([&] { ++steps; });
  EXPECT_EQ(steps, 50);
  EXPECT_FALSE(session.step());
  EXPECT_DOUBLE_EQ(session.time(), session.end());
}

TEST_F(SessionTest, GoesOnFromASnapshotWithTheSameBits) {
  Session first(path_);
  Snapshot middle;
  for (int k = 0; k < 40; ++k) ASSERT_TRUE(first.step());
  first.save(middle);
  for (int k = 0; k < 40; ++k) ASSERT_TRUE(first.step());
  Session second(path_);
  second.resume(middle);
  EXPECT_EQ(second.state().step, 40);
  for (int k = 0; k < 40; ++k) ASSERT_TRUE(second.step());
  EXPECT_EQ(first.state().displacement, second.state().displacement);
  EXPECT_EQ(first.state().velocity, second.state().velocity);
  EXPECT_THROW(second.resume(middle), Error);
}

/// A stepped session writes the same files as a run.
TEST_F(SessionTest, WritesWhatARunWrites) {
  (void)run_case(read_case(path_), {.output_directory = directory_, .force = true, .quiet = true});
  Session session(path_);
  session.write_to({.output_directory = directory_ + "-session", .force = true, .quiet = true});
  while (session.step()) {
  }
  const RunSummary summary = session.finish();
  EXPECT_EQ(summary.status, "done");
  const HistoryTable one = read_history(directory_ + "/history.csv");
  const HistoryTable other = read_history(directory_ + "-session/history.csv");
  EXPECT_EQ(one.names, other.names);
  EXPECT_EQ(one.columns, other.columns);
}

/// A spring implemented by the program: its work is in the account, which closes.
TEST_F(SessionTest, FeedsALoadBack) {
  Session free(path_, {"time.end=1"}), held(path_, {"time.end=1"});
  const Index dofs = held.problem().dof_count();
  Vector weight, ones = Vector::Ones(dofs);
  held.problem().mass.multiply(ones, weight);
  double worst = 0.0, largest = 0.0;
  do {
    held.set_load(-4.0 * held.state().displacement.cwiseProduct(weight));
    EnergyAccount& account = held.simulation().account();
    const Energies now = account.energies(held.state());
    worst = std::max(worst, std::abs(account.residual(now)));
    largest = std::max({largest, now.kinetic, now.elastic, std::abs(now.total())});
  } while (held.step());
  free.run();
  EXPECT_LE(worst, 1e-12 * largest);
  EXPECT_NE(held.simulation().account().works().load, 0.0);
  EXPECT_LT(held.state().displacement.norm(), 0.9 * free.state().displacement.norm());
  EXPECT_THROW(held.set_load(Vector::Zero(dofs - 1)), Error);
}

/// A checkpoint contains the load that was set; a session that does not set it again is refused.
TEST_F(SessionTest, ResumesWithTheLoadThatWasSet) {
  const auto spring = [](Session& session) { session.set_load(-4.0 * session.state().displacement); };
  const RunOptions options{.output_directory = directory_ + "-loaded", .force = true, .quiet = true};
  Session whole(path_, {"time.end=1", "output.checkpoint_every=10"});
  while (true) {
    spring(whole);
    if (!whole.step()) break;
  }
  {
    Session first(path_, {"time.end=1", "output.checkpoint_every=10"});
    first.write_to(options);
    for (int k = 0; k < 25; ++k) {
      spring(first);
      ASSERT_TRUE(first.step());
    }
  }  // destroyed in the middle
  RunOptions resume = options;
  resume.force = false;
  resume.resume = true;
  Session program(path_, {"time.end=1", "output.checkpoint_every=10"});
  EXPECT_THROW((void)run_case(program, resume), Error);
  Session second(path_, {"time.end=1", "output.checkpoint_every=10"});
  second.write_to(resume);
  EXPECT_EQ(second.state().step, 20);
  while (true) {
    spring(second);
    if (!second.step()) break;
  }
  EXPECT_EQ(second.finish().status, "done");
  EXPECT_EQ(second.state().displacement, whole.state().displacement);
}

/// A program that stops early leaves an interrupted run, which can be resumed, instead of a complete one.
TEST_F(SessionTest, LeavesAnInterruptedRunWhereItEndsEarly) {
  const std::vector<std::string> changes{"time.end=0.5"};
  Session first(path_, changes);
  const RunOptions options{.output_directory = directory_ + "-early", .force = true, .quiet = true};
  first.write_to(options);
  for (int k = 0; k < 7; ++k) ASSERT_TRUE(first.step());
  const RunSummary early = first.finish();
  EXPECT_EQ(early.status, "interrupted");
  EXPECT_EQ(early.steps, 7);
  EXPECT_EQ(early.checkpoint_step, 7);
  EXPECT_TRUE(early.expectations.empty());
  EXPECT_EQ(read_history(options.output_directory + "/history.csv").columns.at("time").size(), 8U);

  RunOptions resume = options;
  resume.force = false;
  resume.resume = true;
  Session second(path_, changes), whole(path_, changes);
  second.write_to(resume);
  EXPECT_EQ(second.state().step, 7);
  while (second.state().step < second.steps()) ASSERT_TRUE(second.step());
  EXPECT_EQ(second.finish().status, "done") << "all steps were taken, though step() has not said so";
  whole.run();
  EXPECT_EQ(second.state().displacement, whole.state().displacement);
}

TEST_F(SessionTest, RefusesWhatDoesNotFitTogether) {
  Session session(path_, {"time.end=0.2"});
  EXPECT_THROW((void)session.finish(), Error);
  Snapshot snapshot;
  ASSERT_TRUE(session.step());
  session.save(snapshot);
  EXPECT_THROW(session.write_to({.output_directory = directory_}), Error) << "the history would begin midway";
  EXPECT_THROW(session.set_load(Vector::Constant(session.problem().dof_count(), std::nan(""))), Error);
  Session other_step(path_, {"time.step=0.005"});
  EXPECT_THROW(other_step.resume(snapshot), Error) << "a state of another case";
  // A directory that holds a run is refused, and the session is unchanged.
  Session first(path_, {"time.end=0.2"});
  (void)run_case(first, {.output_directory = directory_, .force = true, .quiet = true});
  EXPECT_THROW((void)first.step(), Error) << "it has finished";
  Session again(path_, {"time.end=0.2"});
  EXPECT_THROW(again.write_to({.output_directory = directory_, .quiet = true}), Error);
  EXPECT_TRUE(again.step());
  // A complete run has no state.
  Session complete(path_, {"time.end=0.2"});
  complete.write_to({.output_directory = directory_, .quiet = true, .resume = true});
  EXPECT_FALSE(complete.step());
  EXPECT_THROW((void)complete.state(), Error);
  EXPECT_EQ(complete.finish().status, "done");
}

/// Warnings belong to the session, including those from reading its case.
TEST_F(SessionTest, OwnsItsWarnings) {
  Session quiet(path_);
  Session warned(path_, {"initial.parameters.unused=1"});
  EXPECT_TRUE(quiet.warnings().empty());
  ASSERT_EQ(warned.warnings().size(), 1u);
  EXPECT_NE(warned.warnings().front().find("no formula"), std::string::npos);
  warned.write_to({.output_directory = directory_, .force = true, .quiet = true});
  warned.run();
  const RunSummary summary = warned.finish();
  EXPECT_EQ(summary.warnings.front(), warned.warnings().front());
}

}  // namespace ricochet::test_support::session_test
