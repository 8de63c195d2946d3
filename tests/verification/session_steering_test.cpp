#include <gtest/gtest.h>

#include <filesystem>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/io/history_file.hpp"
#include "ricochet/run/session.hpp"
#include "ricochet/scheme/scheme.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

/// @file Velocities and motions of obstacles set by a program during a run.
namespace ricochet::test_support::session_steering_test {

class SessionSteeringTest : public ::testing::Test {
 protected:
  void SetUp() override {
    log::set_level(log::Level::error);
    path_ = write_temporary("case.toml", text("scheme = \"newmark\"\npreset = \"trapezoidal\"\n"));
    directory_ = (std::filesystem::path(path_).parent_path() / "out").string();
  }
  static std::string text(const std::string& time) {
    return thrown_case(one_sided_block(), "equivalent", time, "friction = 0.3\n");
  }
  /// Runs the case under every scheme and mass that support it, and steers each run. Its accounts must close.
  template <class Steer, class Look>
  void expect_closed_accounts(const std::vector<std::string>& more_changes, const Steer& steer, const Look& look) {
    int schemes = 0;
    for (const std::string& name : scheme_names()) {
      for (const char* mass : {"equivalent", "lumped"}) {
        SCOPED_TRACE(name + ", " + mass);
        std::vector<std::string> changes{"time.scheme=" + name, std::string("mass.type=") + mass, "time.end=0.3"};
        changes.insert(changes.end(), more_changes.begin(), more_changes.end());
        try {
          Session session(path_, changes);
          session.write_to({.output_directory = directory_, .force = true, .quiet = true});
          ASSERT_NO_FATAL_FAILURE(steer(session));
          const RunSummary summary = session.finish();
          ++schemes;
          for (const CheckResult& check : summary.checks) EXPECT_LT(check.largest, 1e-9) << check.name;
          look(summary);
        } catch (const Error& problem) {
          // The scheme does not support this mass or this step.
          ASSERT_EQ(problem.kind(), ErrorKind::invalid_input) << problem.what();
        }
      }
    }
    EXPECT_GT(schemes, 12);
  }
  std::string path_, directory_;
};

/// The accounts close across a change of the velocity.
TEST_F(SessionSteeringTest, AccountsContainAnImpulse) {
  expect_closed_accounts(
      {"output.history_every=1"},
      [](Session& session) {
        for (int k = 0; k < 12; ++k) ASSERT_TRUE(session.step());
        Vector velocity = session.state().velocity;
        const int d = session.problem().dimension;
        for (Index node = 0; node < velocity.size() / d; ++node) velocity[node * d] += 0.4;
        session.set_velocity(velocity);
        session.run();
      },
      [](const RunSummary& summary) { EXPECT_NE(summary.digest("load_work").last, 0.0); });
}

/// A load set between two steps acts from there on: the forces of the previous step belong to the old load.
TEST_F(SessionSteeringTest, AccountsContainALoadThatIsSet) {
  expect_closed_accounts(
      {},
      [](Session& session) {
        Vector load = Vector::Zero(session.problem().dof_count());
        for (int k = 0; session.step(); ++k) {
          if (k % 5 != 2) continue;
          for (Index dof = 1; dof < load.size(); dof += 2) load[dof] = k % 2 == 0 ? 0.01 : -0.02;
          session.set_load(load);
        }
      },
      [](const RunSummary&) {});
}

TEST_F(SessionSteeringTest, AVelocityWithoutAFiniteEnergyIsRefused) {
  Session session(path_);
  const Vector before = session.state().velocity;
  EXPECT_THROW(session.set_velocity(Vector::Constant(before.size(), 1e200)), Error);
  EXPECT_EQ(session.state().velocity, before);
}

/// A body in free flight continues with the new velocity.
TEST_F(SessionSteeringTest, BodiesFlyWithTheVelocityThatWasSet) {
  Session session(path_, {"load.gravity=[0, 0]"});
  Vector velocity = Vector::Zero(session.problem().dof_count());
  for (Index dof = 1; dof < velocity.size(); dof += 2) velocity[dof] = 2.0;
  session.set_velocity(velocity);
  const Vector before = session.state().displacement;
  for (int k = 0; k < 10; ++k) ASSERT_TRUE(session.step());
  const Vector change = session.state().displacement - before;
  EXPECT_NEAR(change.maxCoeff(), 2.0 * session.time(), 1e-9);
}

/// An obstacle with a velocity from the program moves like one with the same velocity from the case.
TEST_F(SessionSteeringTest, ObstaclesMoveAsWithTheVelocityOfTheCase) {
  Session of_case(path_, {"obstacle.plane.velocity=[0.1, 0.5]", "time.end=0.5"});
  Session steered(path_, {"time.end=0.5"});
  steered.set_obstacle_velocity("plane", Vector{{0.1, 0.5}});
  while (of_case.step() && steered.step()) {
    ASSERT_LT((of_case.state().displacement - steered.state().displacement).cwiseAbs().maxCoeff(), 1e-11);
  }
  EXPECT_GT(of_case.simulation().account().works().obstacle, 0.0);
}

TEST_F(SessionSteeringTest, AccountsContainTheMotionAndItIsResumedWithTheSameBits) {
  const auto steer = [](Session& session, int k) {
    if (k % 7 == 0) session.set_obstacle_velocity("plane", Vector{{0.1, 0.3 * ((k / 7) % 3 - 1.0)}});
  };
  Session whole(path_, {"time.end=0.8"});
  whole.set_obstacle_velocity("plane", Vector{{0.0, 0.0}});
  whole.write_to({.output_directory = directory_, .force = true, .quiet = true});
  Snapshot middle;
  for (int k = 0; k < 80; ++k) {
    steer(whole, k);
    if (k == 33) whole.save(middle);
    ASSERT_TRUE(whole.step());
  }
  const Vector end = whole.state().displacement;
  const RunSummary summary = whole.finish();
  EXPECT_NE(summary.digest("obstacle_work").last, 0.0);
  for (const CheckResult& check : summary.checks) EXPECT_LT(check.largest, 1e-9) << check.name;
  Session second(path_, {"time.end=0.8"});
  second.resume(middle);
  for (int k = 33; k < 80; ++k) {
    if (k > 33) steer(second, k);
    ASSERT_TRUE(second.step());
  }
  EXPECT_EQ(end, second.state().displacement);
  EXPECT_TRUE(Session::is_steered(middle));
}

TEST_F(SessionSteeringTest, RefusesWhatComesTooLateOrDoesNotFit) {
  Session session(path_);
  EXPECT_THROW(session.set_obstacle_velocity("wall", Vector::Zero(2)), Error);
  EXPECT_THROW(session.set_obstacle_velocity("plane", Vector::Zero(3)), Error);
  EXPECT_THROW(session.set_obstacle_velocity("plane", Vector::Zero(2), Vector::Zero(1)), Error) << "it does not turn";
  EXPECT_THROW(session.set_velocity(Vector::Zero(3)), Error);
  EXPECT_THROW(session.set_velocity(Vector::Constant(session.problem().dof_count(), std::nan(""))), Error);
  Session late(path_);
  ASSERT_TRUE(late.step());
  EXPECT_THROW(late.set_obstacle_velocity("plane", Vector::Zero(2)), Error);
}

}  // namespace ricochet::test_support::session_steering_test
