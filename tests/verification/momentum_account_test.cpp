#include "ricochet/simulation/history/momentum_account.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/error.hpp"
#include "ricochet/simulation/history/sensor.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

// P(t) − P(0) is the impulse of the forces, to rounding, and likewise for moments: every scheme, mass and multiplier
// space, with friction on a moving plane, varying loads, damping and supports.

namespace ricochet::test_support::momentum_account_test {

Resultant momentum(const CaseRun& run, const HistoryRecorder& recorder, const std::vector<double>& row) {
  Resultant result;
  const auto value = [&](const std::string& name) {
    const auto& columns = recorder.columns();
    return row[std::size_t(std::ranges::find(columns, name) - columns.begin())];
  };
  const bool flat = run.problem().dimension == 2;
  result.force << value("momentum_x"), value("momentum_y"), flat ? 0.0 : value("momentum_z");
  if (flat) {
    result.moment[2] = value("angular_momentum_z");
  } else {
    result.moment << value("angular_momentum_x"), value("angular_momentum_y"), value("angular_momentum_z");
  }
  return result;
}

/// Largest difference relative to all impulses and momenta, or −1 if the program refuses the case; that of the energy
/// is relative to its largest parts. `of_contact`: of momentum, relative to the impulses of all contact points.
struct Difference {
  double momentum = -1.0, angular = -1.0, energy = 0.0, of_contact = 0.0;
};
Difference largest_difference(const std::string& text) {
  std::unique_ptr<CaseRun> run;
  try {
    run = std::make_unique<CaseRun>(text);
  } catch (const Error&) {
    return {};
  }
  HistoryRecorder recorder(run->problem(), *run->model().rotation);
  MomentumAccount account(run->problem(), run->scheme(), run->state());
  const auto now = [&] { return momentum(*run, recorder, recorder.row(run->state(), run->simulation().account())); };
  const Resultant start = now();
  double force = 0.0, moment = 0.0, size = start.force.norm(), energy = 0.0, parts = 0.0;
  run->run(
      [&] {
        account.enter_step(run->state());
        const Resultant at = now();
        force = std::max(force, (at.force - start.force - account.impulse().force).norm());
        moment = std::max(moment, (at.moment - start.moment - account.impulse().moment).norm());
        size = std::max(size, at.force.norm());
        const Energies energies = run->simulation().account().energies(run->state());
        energy = std::max(energy, std::abs(run->simulation().account().residual(energies)));
        parts = std::max({parts, energies.kinetic, energies.elastic, std::abs(energies.load_potential)});
      },
      false);
  size += account.size();
  EXPECT_GT(size, 0.0);
  return {force / size, moment / (size * account.arm()), energy / parts, force / account.contact_size()};
}

TEST(MomentumAccount, BalancesInEverySchemeMassAndMultiplierSpace) {
  const std::vector<ThrownBody> bodies = thrown_bodies();
  const ThrownBody block = one_sided_block();
  for (const Discretization& each : all_discretizations()) {
    const Difference found = largest_difference(dragged_case(block, each.mass, each.time(), each.contact()));
    EXPECT_EQ(found.momentum >= 0.0, each.is_possible()) << each.label();
    EXPECT_LT(found.momentum, 1e-13) << each.label();
    EXPECT_LT(found.angular, 1e-13) << each.label();
  }
  for (const std::size_t body : {std::size_t{2}, std::size_t{3}, std::size_t{4}}) {
    const Difference found =
        largest_difference(dragged_case(bodies[body], "equivalent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n",
                                        "friction = 0.3\nmultipliers = \"p1\"\nunstable_multipliers = \"allow\"\n"));
    EXPECT_GE(found.momentum, 0.0) << bodies[body].name;
    EXPECT_LT(found.momentum, 1e-13) << bodies[body].name;
    EXPECT_LT(found.angular, 1e-13) << bodies[body].name;
  }
}

/// Contact presses at the start: the accounts begin with the scheme's state there.
TEST(MomentumAccount, BalancesWithTheEnergyFromAStaticStart) {
  const ThrownBody block = one_sided_block();
  for (const std::string& scheme : scheme_names()) {
    for (const std::string& mass : masses_of(scheme)) {
      std::string time = time_of(scheme);
      if (scheme == "nonsmooth-generalized-alpha") time += "spectral_radius = 0.5\n";
      std::string text = thrown_case(block, mass, time);
      const auto replace = [&](const std::string& old, const std::string& now) {
        ASSERT_NE(text.find(old), std::string::npos) << old;
        text.replace(text.find(old), old.size(), now);
      };
      replace("normal = [0.1, 1.0]", "normal = [0.0, 1.0]");
      replace("gravity = [0.3, -1.0]", "gravity = [0.0, -1.0]");
      replace("velocity = [\"0.1-0.2*y\", \"-0.5+0.2*x\"]", "displacement = \"static\"");
      const Difference found =
          largest_difference(text + "[[traction]]\ngroup = \"contact\"\nvalue = [\"0.1*sin(9*t)\", \"x*sin(9*t)\"]\n");
      const std::string name = scheme + ' ' + mass;
      EXPECT_GE(found.momentum, 0.0) << name;
      EXPECT_LT(found.momentum, 1e-13) << name;
      EXPECT_LT(found.angular, 1e-13) << name;
      EXPECT_LT(found.energy, 1e-12) << name;
    }
  }
}

/// The forces of two obstacles cancel in the resultant, and the body does not move.
TEST(MomentumAccount, IsRelativeToForcesThatCancel) {
  const std::string mesh =
      mesh_geometry("squeezed",
                    "Rectangle(1)={0,0,0,2,1}; Physical Surface(\"body\")={1}; Physical Curve(\"bottom\")={1}; "
                    "Physical Curve(\"top\")={3};",
                    0.25, 1);
  const Difference found = largest_difference(
      "[mesh]\nfile = \"" + mesh +
      "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\n"
      "[obstacle.lower]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n"
      "[obstacle.upper]\ntype = \"plane\"\npoint = [0.0, 0.99]\nnormal = [0.0, -1.0]\n"
      "[[contact]]\ngroup = \"bottom\"\nobstacle = \"lower\"\n[[contact]]\ngroup = \"top\"\nobstacle = \"upper\"\n"
      "[initial]\ndisplacement = \"static\"\n[time]\nstep = 1e-3\nend = 0.01\n");
  EXPECT_GT(found.momentum, 1e-8) << "relative to resultants, which are rounding";
  EXPECT_LT(found.of_contact, 1e-13);
}

/// Under Tresca's law points without pressure may carry friction: the account and a contact's resultant include it.
TEST(MomentumAccount, BalancesUnderTrescasLaw) {
  int without_pressure = 0;
  for (const auto& [scheme, mass] : {std::pair{"newmark\"\npreset = \"trapezoidal", "equivalent"},
                                     std::pair{"midpoint", "consistent"}, std::pair{"klr-conserving", "consistent"}}) {
    for (const ThrownBody& body : {thrown_bodies()[0], thrown_bodies()[3]}) {
      const std::string text =
          dragged_case(body, mass, std::string("scheme = \"") + scheme + "\"\n", "friction_bound = 0.3\n");
      const Difference found = largest_difference(text);
      EXPECT_GE(found.momentum, 0.0);
      EXPECT_LT(found.momentum, 1e-13) << scheme << ' ' << body.name;
      EXPECT_LT(found.angular, 1e-13) << scheme << ' ' << body.name;
      CaseRun run(text);
      const std::unique_ptr<Sensor> contact = make_contact_sensor("contact", run.problem(), {SensedPair{0}});
      Observer observer(run.problem());
      run.run([&] {
        const StepForces& forces = run.state().forces;
        SpaceVector sum = SpaceVector::Zero(body.dimension);
        for (Index i = 0; i < run.problem().contact.size(); ++i) {
          sum += contact_force(forces, i);
          if (forces.normal_reaction[i] == 0.0 && carries_force(forces, i)) ++without_pressure;
        }
        std::vector<double> row;
        contact->observe(observer.observe(run.state()), row);
        for (int k = 0; k < body.dimension; ++k) EXPECT_EQ(row[std::size_t(k)], sum[k]);
      });
    }
  }
  EXPECT_GT(without_pressure, 0);
}

TEST(MomentumAccount, BalancesWithMovingSupports) {
  for (const auto& [scheme, text] : moving_support_cases()) {
    const Difference found = largest_difference(text);
    EXPECT_GE(found.momentum, 0.0) << scheme;
    EXPECT_LT(found.momentum, 1e-13) << scheme;
    EXPECT_LT(found.angular, 1e-13) << scheme;
  }
}

}  // namespace ricochet::test_support::momentum_account_test
