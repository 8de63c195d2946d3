#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/scheme/scheme.hpp"
#include "support/box_mesh.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"
#include "support/two_bodies.hpp"

// Friction on rotating obstacles acts relative to their material at the positions of the points, not at the positions
// without reactions. Points are pressed in by a hundredth of the radius: velocities at the predicted position differ by
// as much for every step length.

namespace ricochet::test_support::turning_obstacles_test {

struct Turning {
  std::string name;
  int dimension;
  std::string obstacle;  ///< lines of [obstacle.drum]
};

std::vector<Turning> turning_obstacles() {
  const std::string drum = "type = \"sphere\"\ncentre = [0.0, -1.0]\nradius = 1.0\n";
  const std::string floor = "type = \"plane\"\npoint = [0.0, 0.0, 0.0]\nnormal = [0.0, 0.0, 1.0]\n";
  return {{"circle, rotation", 2, drum + "rotation = \"0.1*t\"\n"},
          {"circle, rotation about another point", 2, drum + "rotation = \"0.05*t\"\nabout = [0.1, -1.1]\n"},
          {"circle, rotation and motion", 2, drum + "rotation = \"0.3*t^2\"\nmotion = [\"0.02*t\", \"0\"]\n"},
          {"circle, rotation_rate", 2, drum + "rotation_rate = 0.1\n"},
          {"plane that tilts", 2,
           "type = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\nrotation = \"0.1*t\"\nabout = [0.3, -0.2]\n"},
          {"expression, rotation", 2,
           "type = \"implicit\"\nexpression = \"y + 0.5*x^2\"\nrotation = \"0.1*t\"\nabout = [0.0, -1.0]\n"},
          {"turntable", 3, floor + "rotation_rate = 0.1\n"},
          {"plane that turns", 3, floor + "rotation = [\"0.02*t\", \"0\", \"0.1*t\"]\nabout = [0.2, 0.1, -0.1]\n"}};
}

/// A block on the obstacle, pressed down by its upper side, which does not rotate.
std::string pressed_block(const Turning& turning, const std::string& law, const std::string& scheme,
                          const std::string& mass) {
  const bool flat = turning.dimension == 2;
  BoxMesh box =
      box_of(flat ? CellShape::quadrilateral : CellShape::hexahedron, flat ? std::vector{4, 4} : std::vector{2, 2, 4});
  box.map = [](const Vector& x) -> Vector {
    Vector y = 0.2 * x;
    y.head(y.size() - 1).array() -= 0.08;
    y[y.size() - 1] += 0.0001;
    return y;
  };
  const std::string mesh = write_mesh(fmt::format("turned_block{}.msh", turning.dimension), make_box_mesh(box));
  const std::string up = flat ? "y" : "z";
  std::string text = fmt::format(
      "[mesh]\nfile = \"{}\"\n{}"
      "[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 1000.0\npoisson = 0.3\nlaw = \"{}\"\n"
      "[obstacle.drum]\n{}"
      "[[contact]]\ngroup = \"{}0\"\nobstacle = \"drum\"\nfriction = 0.8\n"
      "[[support]]\ngroup = \"{}1\"\ncomponents = [{}]\n"
      "[[support]]\ngroup = \"{}1\"\ncomponents = [\"{}\"]\nvalue = \"-0.01*min(t/0.02, 1)\"\n"
      "[mass]\ntype = \"{}\"\n[time]\nstep = {}\nend = 0.08\n{}",
      mesh, flat ? "plane = \"strain\"\n" : "", law, turning.obstacle, up, up, flat ? "\"x\"" : "\"x\", \"y\"", up, up,
      mass, scheme == "semi-explicit" || scheme.find("cd-") == 0 ? 2e-4 : 1e-3, time_of(scheme));
  return text;
}

/// Slips of the points over the last step, relative to the material of the obstacle at their positions in the middle of
/// the step, and the motion of that material, both computed from the obstacle itself.
struct Slips {
  Vector slip, travel;
  double largest = 0.0;

  Slips(const CaseRun& run, const Vector& before, double step) {
    const State& state = run.state();
    run.problem().obstacle_velocity(0.5 * (before + state.displacement), state.time - 0.5 * step, step, motion_);
    project_motion(*state.forces.rows, motion_);
    travel = step * motion_.tangential;
    state.forces.rows->tangential_motion(state.displacement - before, slip);
    slip -= travel;
    largest = travel.lpNorm<Eigen::Infinity>();
  }

 private:
  ObstacleMotion motion_;
};

/// Schemes whose friction acts over a whole step, on the slip of that step.
const std::vector<std::string> schemes_of_steps = {"reduced-kane",       "newmark",       "kane",
                                                   "contact-stabilized", "semi-explicit", "generalized-alpha"};

std::string mass_of(const std::string& scheme) {
  if (scheme == "semi-explicit") return "equivalent-lumped";
  return scheme == "reduced-kane" || scheme == "newmark" ? "equivalent" : "consistent";
}

/// Expects that sticking points move with the obstacle's material at their positions.
void expect_no_slip(const Turning& turning, const std::string& law, const std::string& scheme) {
  CaseRun run(pressed_block(turning, law, scheme, mass_of(scheme)));
  const std::string name = turning.name + ", " + law + ", " + scheme;
  const Index tangents = turning.dimension - 1;
  Vector before = run.state().displacement;
  double time = 0.0, worst = 0.0;
  int stuck = 0;
  run.run(
      [&] {
        const Slips slips(run, before, run.state().time - time);
        for (Index i = 0; i < run.problem().contact.size(); ++i) {
          if (run.state().contact_status[std::size_t(i)] != ContactStatus::stick) continue;
          ++stuck;
          worst = std::max(worst, slips.slip.segment(i * tangents, tangents).norm() / slips.largest);
        }
        before = run.state().displacement;
        time = run.state().time;
      },
      false);
  EXPECT_GT(stuck, 100) << name;
  EXPECT_LE(worst, 1e-9) << name;
}

TEST(TurningObstacles, PointsThatStickMoveWithTheMaterial) {
  for (const Turning& turning : turning_obstacles()) {
    for (const std::string& scheme : schemes_of_steps) expect_no_slip(turning, "linear", scheme);
  }
}

// Every Newton iteration updates the positions.
TEST(TurningObstacles, PointsThatStickMoveWithTheMaterialAtFiniteStrain) {
  for (const Turning& turning : turning_obstacles()) {
    for (const std::string scheme : {"reduced-kane", "newmark", "semi-explicit"})
      expect_no_slip(turning, "neo-hookean", scheme);
  }
}

// Friction dissipates energy for every motion of the obstacle, in every step of all schemes with that property.
TEST(TurningObstacles, FrictionGivesNoEnergy) {
  for (const Turning& turning : turning_obstacles()) {
    for (const std::string law : {"linear", "neo-hookean"}) {
      CaseRun run(pressed_block(turning, law, "reduced-kane", "equivalent"));
      double largest = 0.0, friction = 0.0, total = 0.0;
      run.run([&] {
        EnergyAccount& account = run.simulation().account();
        const Energies now = account.energies(run.state());
        largest = std::max(largest, std::abs(now.kinetic) + std::abs(now.elastic));
        EXPECT_LE(account.works().friction - friction, 1e-14 * largest) << turning.name << ", " << law;
        EXPECT_LE(std::abs(account.residual(now)), 1e-12 * largest) << turning.name << ", " << law;
        friction = account.works().friction;
        total = largest;
      });
      EXPECT_GT(total, 0.0);
    }
  }
}

}  // namespace ricochet::test_support::turning_obstacles_test
