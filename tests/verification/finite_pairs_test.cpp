#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "ricochet/simulation/history/momentum_account.hpp"
#include "support/case_run.hpp"
#include "support/motion_totals.hpp"
#include "support/same_snapshots.hpp"

/// @file Contact between rotating bodies: the balances with contact rows that rotate with them.
namespace ricochet::test_support::finite_pairs_test {

/// Two blocks with non-matching meshes, one above the other; the upper one comes down, and both rotate.
struct Blocks {
  int dimension = 2;
  std::string contact = "friction = 0.3\n";
  double gap = 0.02, step = 0.005;
  int steps = 120;
  double turn = 0.0;                                            ///< rotation of both about the origin, in degrees
  std::string move = {};                                        ///< translation of the upper one
  std::string upper_motion = {}, lower_motion = {}, more = {};  ///< keys of [[motion]]; more sections
};

std::string mesh_of(int dimension, const std::string& name, double size) {
  return dimension == 2 ? mesh_geometry("pair-" + name + "-2d",
                                        "Rectangle(1) = {0, 0, 0, 1, 0.5};\nPhysical Surface(\"body\") = {1};\n"
                                        "Physical Curve(\"bottom\") = {1};\nPhysical Curve(\"top\") = {3};\n",
                                        size, 1)
                        : mesh_geometry("pair-" + name + "-3d",
                                        "Box(1) = {0, 0, 0, 1, 0.6, 0.5};\nPhysical Volume(\"body\") = {1};\n"
                                        "Physical Surface(\"bottom\") = {5};\nPhysical Surface(\"top\") = {6};\n",
                                        size, 1);
}

std::string case_of(const Blocks& blocks) {
  const bool plane = blocks.dimension == 2;
  const std::string lower = mesh_of(blocks.dimension, "lower", plane ? 0.2 : 0.3);
  const std::string upper = mesh_of(blocks.dimension, "upper", plane ? 0.13 : 0.25);
  const std::string turn = blocks.turn == 0.0 ? "" : fmt::format("turn = {{ angle = {:.17g} }}\n", blocks.turn);
  std::string text =
      "[part.lower]\nfile = \"" + lower + "\"\n" + turn + "[part.upper]\nfile = \"" + upper + "\"\n" + turn;
  text += "move = " +
          (blocks.move.empty() ? fmt::format("[0.1, {}{}]", plane ? "" : "0.05, ", 0.5 + blocks.gap) : blocks.move) +
          "\n";
  for (const std::string body : {"lower", "upper"}) {
    text += "[[material]]\ngroup = \"" + body + ".body\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\n" +
            "law = \"neo-hookean\"\n";
  }
  text += "[[contact]]\ngroup = \"upper.bottom\"\nagainst = \"lower.top\"\n" + blocks.contact + blocks.more +
          "[[motion]]\ngroup = \"lower.body\"\n" + blocks.lower_motion + "[[motion]]\ngroup = \"upper.body\"\n" +
          blocks.upper_motion;
  return text + "[time]\nscheme = \"reduced-kane\"\n" +
         fmt::format("step = {}\nend = {}\n", blocks.step, blocks.step * blocks.steps);
}

Blocks colliding(int dimension) {
  Blocks blocks{.dimension = dimension};
  if (dimension == 2) {
    blocks.upper_motion = "velocity = [0.2, -1.0]\nspin = 2.0\n";
    blocks.lower_motion = "spin = 2.0\n";
  } else {
    blocks.upper_motion = "velocity = [0.2, 0.1, -1.0]\nspin = [0.5, -2.0, 1.0]\n";
    blocks.lower_motion = "spin = [0.0, -2.0, 0.5]\n";
  }
  return blocks;
}

/// Bodies that collide, rotate and separate: no energy is created, both momenta are conserved, and the account closes.
TEST(FinitePairs, CollisionsKeepMomentaAndCreateNoEnergy) {
  for (const int dimension : {2, 3}) {
    for (const std::string contact :
         {"", "friction = 0.3\n", "multipliers = \"dual\"\nfriction = 0.3\n",
          "multipliers = \"p0\"\nunstable_multipliers = \"allow\"\n", "multipliers = \"nodal\"\nfriction = 0.3\n"}) {
      Blocks blocks = colliding(dimension);
      blocks.contact = contact;
      CaseRun run(case_of(blocks));
      const double start = energy_of(run);
      const Momenta first(run);
      MomentumAccount momentum(run.problem(), run.scheme(), run.state());
      double before = start, largest_force = 0.0;
      Vector displacement = run.state().displacement;
      run.run(
          [&] {
            const double energy = energy_of(run);
            const std::string what = fmt::format("{}D {} step {}", dimension, contact, run.state().step);
            EXPECT_LT(energy, before + 1e-11 * start) << what;
            before = energy;
            momentum.enter_step(run.state());
            const Energies energies = run.simulation().account().energies(run.state());
            EXPECT_NEAR(run.simulation().account().residual(energies), 0.0, 1e-11 * start) << what;
            const Momenta now(run);
            EXPECT_LT((now.linear - first.linear).norm(), 1e-12) << what;
            EXPECT_LT((now.angular - first.angular - momentum.impulse().moment).norm(), 1e-11) << what;
            // In 3D, friction transverse to the slip leaves a component along the normal.
            if (dimension == 2 || contact.find("friction") == std::string::npos) {
              EXPECT_LT((now.angular - first.angular).norm(), 1e-9) << what;
            }
            largest_force = std::max(largest_force, run.state().forces.normal_reaction.sum());
            Vector gap;
            run.problem().gaps(run.state().displacement, run.state().time, gap);
            // The iterations end with 1e-9 of the increment left in positions, of both bodies.
            const double increment = (run.state().displacement - displacement).lpNorm<Eigen::Infinity>();
            displacement = run.state().displacement;
            EXPECT_GT(gap.minCoeff(), -4e-9 * increment) << what;
          },
          false);
      EXPECT_GT(largest_force, 0.1) << contact;
    }
  }
}

/// Blocks that are tied together move like one body.
TEST(FinitePairs, TiedBodiesKeepEnergyAndMomenta) {
  for (const int dimension : {2, 3}) {
    Blocks blocks = colliding(dimension);
    blocks.contact = "tied = true\n";
    blocks.gap = 0.0;
    blocks.lower_motion = blocks.upper_motion =
        dimension == 2 ? "spin = 2.0\nabout = [0.5, 0.5]\n" : "spin = [0.5, -2.0, 0.5]\nabout = [0.5, 0.3, 0.5]\n";
    blocks.more = dimension == 2
                      ? "[initial]\ndisplacement = [\"0.02*sin(5*x)\", \"0.02*sin(5*y)\"]\n"
                      : "[initial]\ndisplacement = [\"0.02*sin(5*x)\", \"0.02*sin(5*y)\", \"0.02*sin(4*z+x)\"]\n";
    CaseRun run(case_of(blocks));
    const double start = energy_of(run);
    const Momenta first(run);
    run.run([&] {
      EXPECT_NEAR(energy_of(run), start, 1e-11 * start);
      const Momenta now(run);
      EXPECT_LT((now.linear - first.linear).norm(), 1e-12);
      EXPECT_LT((now.angular - first.angular).norm(), 1e-11);
    });
  }
}

/// Superposed rotations of the whole motion change only the positions, with contact and friction.
TEST(FinitePairs, AMotionThatIsTurnedIsTheSameMotion) {
  Blocks blocks = colliding(2);
  blocks.steps = 60;
  CaseRun one(case_of(blocks));
  const double angle = 0.7, c = std::cos(angle), s = std::sin(angle);
  // The parts are rotated about the origin before they are moved.
  Blocks turned = blocks;
  turned.turn = angle * 45.0 / std::atan(1.0);
  const auto rotated = [&](double x, double y) {
    return fmt::format("[{:.17g}, {:.17g}]", c * x - s * y, s * x + c * y);
  };
  turned.upper_motion = "velocity = " + rotated(0.2, -1.0) + "\nspin = 2.0\n";
  turned.move = rotated(0.1, 0.5 + blocks.gap);
  CaseRun other(case_of(turned));
  const Matrix rotation = (Matrix(2, 2) << c, -s, s, c).finished();
  // Nodes are numbered by position; the numbers of the file do not change.
  const auto places = [](const CaseRun& run) {
    const Index nodes = run.problem().nodes.cols();
    Points result(2, nodes);
    for (Index node = 0; node < nodes; ++node)
      result.col(run.model().space.number[std::size_t(node)]) =
          run.problem().nodes.col(node) + run.state().displacement.segment(2 * node, 2);
    return result;
  };
  const Points at_start = places(one);
  one.run([] {});
  other.run([] {});
  const Points first = places(one), second = places(other);
  EXPECT_LT((rotation * first - second).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_GT((first - at_start).cwiseAbs().maxCoeff(), 0.1);
}

/// A checkpoint contains lagged contact rows, warm starts and momenta.
TEST(FinitePairs, GoOnFromACheckpointWithTheSameBits) {
  for (const int dimension : {2, 3}) {
    Blocks blocks = colliding(dimension);
    blocks.steps = 40;
    CaseRun run(case_of(blocks));
    std::map<long, Snapshot> snapshots;
    run.run([&] {
      const long step = run.state().step;
      if (step % 7 == 0) run.simulation().save(snapshots[step]);
    });
    Snapshot end;
    run.simulation().save(end);
    for (const auto& [step, snapshot] : snapshots) {
      const std::unique_ptr<Scheme> scheme = make_scheme(run.input().time);
      Simulation resumed(run.problem(), *scheme, snapshot, step_solver_options(run.input()),
                         step_control_options(run.input().time));
      while (resumed.state().step < run.state().step) resumed.advance();
      Snapshot found;
      resumed.save(found);
      expect_same(end, found);
    }
    EXPECT_GE(snapshots.size(), 5U);
  }
}

}  // namespace ricochet::test_support::finite_pairs_test
