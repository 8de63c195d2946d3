#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

// Coulomb's law and the effect of friction on the energy, step by step on any mesh. Rates, forces and energies are
// computed here from the states, not taken from the solver or the energy account.

namespace ricochet::test_support::friction_law_test {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

struct Method {
  std::string scheme;  ///< lines of [time]
  std::string mass;
  double gamma;  ///< forces enter the step with weights 1 − γ and γ; 1: the law holds at the instant of the step
  bool reduced = false;  ///< has another energy identity
};

std::vector<Method> methods() {
  std::vector<Method> all;
  for (const char* mass : {"consistent", "lumped", "equivalent"}) {
    if (std::string(mass) == "equivalent") {
      all.push_back({"scheme = \"reduced-kane\"\n", mass, 1.0, true});
      all.push_back({"scheme = \"reduced-kane\"\nreaction_weight = \"adaptive\"\n", mass, 1.0, true});
    } else {
      all.push_back({"scheme = \"midpoint\"\n", mass, 1.0});
      all.push_back({"scheme = \"klr-conserving\"\n", mass, 1.0});
    }
    all.push_back({"scheme = \"newmark\"\npreset = \"trapezoidal\"\n", mass, 0.5});
    all.push_back({"scheme = \"newmark\"\nbeta = 0.3025\ngamma = 0.6\n", mass, 0.6});
  }
  all.push_back({"scheme = \"semi-explicit\"\n", "equivalent-lumped", 0.5});
  return all;
}

/// Displacement from which the scheme defines the slip rate of the step: U₁−U₀, or (Uⁿ⁺¹−Uⁿ⁻¹)/2.
Vector slip_of(CaseRun& run, const Vector& before, const Vector& ahead_before) {
  const State& state = run.state();
  if (run.input().time.scheme != "klr-conserving") return state.displacement - before;
  return 0.5 * (ahead_before + state.dof_memory("increment_ahead"));
}

/// Largest violations of the law, relative to the largest reaction and slip so far, and the statuses that occurred.
struct Seen {
  double cone = 0.0, alignment = 0.0, dissipation = 0.0, complementarity = 0.0;
  long stick = 0, slip = 0;
};

/// y in the conditions 0 ≤ r_N ⟂ y ≥ 0 of the step: the gap at the instant of the scheme, or the normal part of the
/// increment.
Vector normal_motion(CaseRun& run, const Vector& increment) {
  const State& state = run.state();
  if (run.input().time.scheme == "klr-conserving") return run.problem().contact.rows->gap_operator * increment;
  const double ahead = run.input().time.scheme == "midpoint" ? 0.5 : 0.0;
  Vector gap;
  run.problem().gaps(state.displacement - ahead * increment, state.time - ahead * run.scheme().step(), gap);
  return gap;
}

/// Checks Coulomb's law (bound = F r_N) or Tresca's (a bound per point) at every point of the last step. Under Tresca's
/// law a point may graze: r_N = 0 = y with any friction up to the bound; otherwise a solution need not exist.
void check_law(CaseRun& run, const Vector& increment, double coefficient, const Vector& bounds, Seen& seen) {
  const State& state = run.state();
  const ContactBoundary& contact = run.problem().contact;
  const Vector slip = contact.rows->tangential_trace * increment;
  const Index tangents = contact.dimension - 1;
  const double force_size = state.forces.normal_reaction.maxCoeff();
  const double slip_size = increment.lpNorm<Eigen::Infinity>();
  if (force_size == 0.0) return;
  const Vector y = normal_motion(run, increment);
  for (Index i = 0; i < contact.size(); ++i) {
    const double normal = state.forces.normal_reaction[i];
    const Vector friction = state.forces.tangential_reaction.segment(i * tangents, tangents);
    const Vector w = slip.segment(i * tangents, tangents);
    const ContactStatus status = state.contact_status[std::size_t(i)];
    const bool grazes = bounds.size() > 0 && normal == 0.0 && status != ContactStatus::open;
    if (grazes) {
      EXPECT_LE(std::abs(y[i]), 1e-12 * slip_size);
      EXPECT_LE(friction.norm(), bounds[i] * (1.0 + 1e-12));
    }
    double bound = coefficient * normal;
    if (bounds.size() > 0) bound = grazes ? friction.norm() : normal > 0.0 ? bounds[i] : 0.0;
    ASSERT_GE(normal, 0.0);
    seen.cone = std::max(seen.cone, (friction.norm() - bound) / force_size);
    // r_T is F r_N times the direction of w, or w is zero.
    seen.alignment = std::max(seen.alignment, (bound * w - w.norm() * friction).norm() / (force_size * slip_size));
    seen.dissipation = std::max(seen.dissipation, -friction.dot(w) / (force_size * slip_size));
    EXPECT_EQ(status == ContactStatus::open, normal == 0.0 && !grazes);
    seen.stick += status == ContactStatus::stick ? 1 : 0;
    seen.slip += status == ContactStatus::slip ? 1 : 0;
    if (status == ContactStatus::stick) seen.complementarity = std::max(seen.complementarity, w.norm() / slip_size);
  }
}

void expect_law(const ThrownBody& body, const Method& method, const std::string& contact, double coefficient,
                bool tresca) {
  CaseRun run(thrown_case(body, method.mass, method.scheme, contact));
  const std::string name = body.name + ", " + method.mass + ", " + method.scheme + contact;
  const Vector bounds = tresca ? Vector(run.problem().contact.weights * 0.5) : Vector();
  Seen seen;
  Vector before = run.state().displacement;
  const auto ahead = [&] {
    return run.state().memory.count("increment_ahead") > 0 ? run.state().dof_memory("increment_ahead") : Vector();
  };
  Vector ahead_before = ahead();
  run.run(
      [&] {
        check_law(run, slip_of(run, before, ahead_before), coefficient, bounds, seen);
        before = run.state().displacement;
        ahead_before = ahead();
      },
      false);
  EXPECT_LT(seen.cone, 1e-13) << name;
  // The slip, of order h |v|, is a difference of displacements of order 1.
  EXPECT_LT(seen.alignment, 1e-11) << name;
  EXPECT_LT(seen.dissipation, 1e-11) << name << ": friction drives the slip";
  EXPECT_LT(seen.complementarity, 1e-10) << name << ": sticking points slip";
  EXPECT_GT(coefficient > 1.0 ? seen.stick : seen.slip, 0) << name;
}

TEST(FrictionLaw, CoulombsLawHoldsInEveryStep) {
  for (const ThrownBody& body : thrown_bodies()) {
    for (const Method& method : methods()) {
      expect_law(body, method, "friction = 0.2\n", 0.2, false);
      if (body.degree == 1) expect_law(body, method, "friction = 1.5\n", 1.5, false);
    }
  }
}

TEST(FrictionLaw, TrescasLawHoldsInEveryStep) {
  for (const ThrownBody& body : thrown_bodies()) {
    if (body.degree == 2) continue;  // the bound of a point is friction_bound times its weight: positive on degree 1
    for (const Method& method : methods()) expect_law(body, method, "friction_bound = 0.5\n", 0.0, true);
  }
}

TEST(FrictionLaw, HoldsWithEveryMultiplierSpace) {
  for (const ThrownBody& body : thrown_bodies()) {
    for (const Method& method : methods()) {
      if (method.mass == "lumped" || method.gamma == 0.6) continue;
      for (const char* space : {"p0", "p1", "dual"}) {
        const bool stable =
            instability(space, body.dimension == 2 ? CellShape::interval : CellShape::triangle, body.degree).empty();
        if (!stable) continue;  // W may be singular
        expect_law(body, method, "friction = 0.2\nmultipliers = \"" + std::string(space) + "\"\n", 0.2, false);
      }
    }
  }
}

TEST(FrictionLaw, StickAndSlipAreBothSeen) {
  for (const ThrownBody& body : thrown_bodies()) {
    CaseRun run(
        thrown_case(body, "equivalent", "scheme = \"newmark\"\npreset = \"trapezoidal\"\n", "friction = 0.3\n"));
    Seen own;
    Vector before = run.state().displacement;
    run.run(
        [&] {
          check_law(run, run.state().displacement - before, 0.3, Vector(), own);
          before = run.state().displacement;
        },
        false);
    EXPECT_GT(own.stick, 0) << body.name;
    EXPECT_GT(own.slip, 0) << body.name;
  }
}

// At the corner two obstacles impose two conditions and two slips on two dofs: the Delassus operator is singular, and
// the points press against each other until one of them slips.
TEST(FrictionLaw, HoldsInACornerBetweenTwoObstacles) {
  const std::string mesh =
      mesh_geometry("corner",
                    "Rectangle(1)={0,0,0,1,1}; Physical Surface(\"body\")={1}; Physical Curve(\"bottom\")={1}; "
                    "Physical Curve(\"left\")={4};",
                    0.1, 1);
  for (const auto& [scheme, friction] : {std::pair{"newmark\"\npreset = \"trapezoidal", 0.5},
                                         {"newmark\"\npreset = \"trapezoidal", 3.0},
                                         {"reduced-kane", 0.5}}) {
    const std::string law = "friction = " + std::to_string(friction) + "\n";
    CaseRun run("[mesh]\nfile = \"" + mesh +
                "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 100.0\npoisson = 0.3\n"
                "[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, -0.02]\nnormal = [0.0, 1.0]\n"
                "[obstacle.wall]\ntype = \"plane\"\npoint = [-0.02, 0.0]\nnormal = [1.0, 0.0]\n"
                "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\n" +
                law + "[[contact]]\ngroup = \"left\"\nobstacle = \"wall\"\n" + law +
                "[load]\ngravity = [-1.0, -2.0]\n[initial]\nvelocity = [-0.5, -0.5]\n[time]\nscheme = \"" + scheme +
                "\"\nstep = 0.005\nend = 3.0\n");
    Seen seen;
    Vector before = run.state().displacement;
    run.run(
        [&, mu = friction] {
          check_law(run, run.state().displacement - before, mu, Vector(), seen);
          before = run.state().displacement;
        },
        false);
    EXPECT_LT(seen.cone, 1e-13) << scheme << friction;
    EXPECT_LT(seen.alignment, 1e-9) << scheme << friction;
    EXPECT_GT(seen.stick, 0) << scheme << friction;
    EXPECT_GT(seen.slip, 0) << scheme << friction;
  }
}

// The frictionless identities plus the friction work −[(1−γ) r_T0 + γ r_T1]·B_T ΔU.
// For semi-explicit, Newmark's with β = 0, the energy is J − (h²/8)AᵀMA.
TEST(FrictionEnergy, MidpointAndNewmarkIdentitiesWithFriction) {
  for (const ThrownBody& body : thrown_bodies()) {
    for (const Method& method : methods()) {
      if (method.scheme.find("klr") != std::string::npos || method.gamma == 0.6 || method.reduced) continue;
      const bool midpoint = method.gamma == 1.0;
      CaseRun run(thrown_case(body, method.mass, method.scheme, "friction = 0.3\n"));
      const std::string name = body.name + ", " + method.mass + ", " + method.scheme;
      const SparseMatrix mass = run.problem().mass.to_sparse();
      const double factor =
          method.mass == "equivalent-lumped" ? 0.125 * run.scheme().step() * run.scheme().step() : 0.0;
      StepEnd before(run);
      double worst = 0.0, friction_total = 0.0, largest_gain = 0.0;
      run.run(
          [&] {
            const StepEnd after(run);
            const Vector slip =
                run.problem().contact.rows->tangential_trace * (after.displacement - before.displacement);
            const double contact = midpoint ? -2.0 * after.normal.dot(before.gap)
                                            : 0.5 * (before.normal.dot(after.gap) - after.normal.dot(before.gap));
            const double friction =
                midpoint ? -after.tangential.dot(slip) : -0.5 * (before.tangential + after.tangential).dot(slip);
            friction_total += friction;
            const double size = after.size_of_energy_terms;
            if (midpoint) largest_gain = std::max(largest_gain, friction / size);
            const double algorithmic = factor * (before.acceleration.dot(mass * before.acceleration) -
                                                 after.acceleration.dot(mass * after.acceleration));
            worst = std::max(worst, std::abs(after.energy + algorithmic - before.energy - contact - friction) / size);
            before = after;
          },
          false);
      EXPECT_LT(worst, 20.0 * epsilon) << name;
      EXPECT_LT(largest_gain, epsilon) << name << ": friction gave energy in a step";
      // Newmark's weights can create energy if contact nodes with inertia rattle.
      const bool loses = midpoint || method.mass.starts_with("equivalent");
      if (loses) {
        EXPECT_LT(friction_total, 0.0) << name;
      }
      EXPECT_NEAR(friction_total, run.simulation().account().works().friction, 1e-11 * std::abs(friction_total))
          << name;
    }
  }
}

TEST(FrictionEnergy, KlrLosesWhatFrictionTakesAndNeverGains) {
  for (const ThrownBody& body : thrown_bodies()) {
    for (const char* mass : {"consistent", "lumped"}) {
      CaseRun run(thrown_case(body, mass, "scheme = \"klr-conserving\"\n", "friction = 0.3\n"));
      Vector displacement, velocity;
      const auto energy = [&] {
        run.scheme().energy_state(run.state(), displacement, velocity);
        return total_energy(run.problem(), displacement, velocity);
      };
      double before = energy(), worst = 0.0, gain = 0.0, total = 0.0;
      const double first = before;
      Vector ahead = run.state().dof_memory("increment_ahead");
      run.run(
          [&] {
            const Vector& next = run.state().dof_memory("increment_ahead");
            const Vector slip = run.problem().contact.rows->tangential_trace * (0.5 * (ahead + next));
            const double friction = -run.state().forces.tangential_reaction.dot(slip);
            const double now = energy();
            worst = std::max(worst, std::abs(now - before - friction) / first);
            gain = std::max(gain, friction / first);
            total += friction;
            before = now;
            ahead = next;
          },
          false);
      EXPECT_LT(worst, 1e-12) << body.name << ", " << mass;
      EXPECT_LT(gain, 8.0 * epsilon) << body.name << ", " << mass;
      EXPECT_LT(total, -1e-3 * first) << body.name << ", " << mass;
    }
  }
}

/// Resultant and moment about the origin (reference positions) of nodal vectors: 2 + 1 or 3 + 3 numbers.
Vector resultants(const SemidiscreteProblem& problem, const Vector& nodal) {
  const int d = problem.dimension;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  for (Index node = 0; node < problem.nodes.cols(); ++node) {
    Eigen::Vector3d x = Eigen::Vector3d::Zero(), f = Eigen::Vector3d::Zero();
    x.head(d) = problem.nodes.col(node);
    f.head(d) = nodal.segment(node * d, d);
    sum += f;
    moment += x.cross(f);
  }
  Vector result(6);
  result << sum, moment;
  return result;
}

// Linear and angular momentum change only by the impulses of gravity and contact, friction included.
TEST(FrictionMomentum, BalancesCloseToRounding) {
  for (const ThrownBody& body : thrown_bodies()) {
    for (const Method& method : methods()) {
      CaseRun run(thrown_case(body, method.mass, method.scheme, "friction = 0.3\n"));
      const SemidiscreteProblem& problem = run.problem();
      const bool klr = method.scheme.find("klr") != std::string::npos;
      const double h = run.input().time.step;
      const auto momentum = [&]() -> Vector {
        const Vector v = klr ? Vector(run.state().dof_memory("increment_ahead") / h) : run.state().velocity;
        return resultants(problem, problem.mass.to_sparse() * v);
      };
      const auto force = [&] {
        Vector nodal = problem.loads.constant();
        run.state().forces.rows->add_force(run.state().forces.acting_normal(), run.state().forces.acting_tangential(),
                                           nodal);
        return resultants(problem, nodal);
      };
      Vector force_before = force(), momentum_before = momentum();
      double worst = 0.0, size = 0.0, turned = 0.0;
      const Vector first = momentum_before;
      run.run(
          [&] {
            const Vector now = force(), after = momentum();
            const Vector impulse = h * ((1.0 - method.gamma) * force_before + method.gamma * now);
            size = std::max({size, after.lpNorm<Eigen::Infinity>(), impulse.lpNorm<Eigen::Infinity>()});
            worst = std::max(worst, (after - momentum_before - impulse).lpNorm<Eigen::Infinity>() / size);
            turned = std::max(turned, (after - first).tail(3).norm() / size);
            force_before = now;
            momentum_before = after;
          },
          false);
      EXPECT_LT(worst, 1e-12) << body.name << ", " << method.mass << ", " << method.scheme;
      EXPECT_GT(turned, 0.01) << body.name;
    }
  }
}

// With friction and an obstacle that moves along and across its plane, and rotates.
TEST(FrictionEnergy, AccountClosesWithMovingObstacles) {
  for (const ThrownBody& body : thrown_bodies()) {
    for (const Method& method : methods()) {
      const std::string obstacle =
          body.dimension == 2 ? "velocity = [0.4, 0.1]\n" : "velocity = [0.4, -0.1, 0.1]\nrotation_rate = 0.7\n";
      CaseRun run(thrown_case(body, method.mass, method.scheme, "friction = 0.4\n", obstacle));
      const std::string name = body.name + ", " + method.mass + ", " + method.scheme;
      double worst = 0.0, largest = 0.0;
      run.run([&] {
        const Energies now = run.simulation().account().energies(run.state());
        largest = std::max({largest, std::abs(now.kinetic), std::abs(now.elastic), std::abs(now.total())});
        worst = std::max(worst, std::abs(run.simulation().account().residual(now)));
      });
      EXPECT_LT(worst, 1e-12 * largest) << name;
      // Newmark's weights can create energy if contact nodes with inertia rattle.
      const bool loses = method.gamma == 1.0 || method.mass == "equivalent";
      if (loses) {
        EXPECT_LT(run.simulation().account().works().friction, 0.0) << name;
      }
      EXPECT_EQ(run.simulation().account().works().obstacle != 0.0, body.against.empty()) << name;
    }
  }
}

}  // namespace ricochet::test_support::friction_law_test
