#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "support/case_run.hpp"
#include "support/energy_identity.hpp"
#include "support/thrown_body.hpp"

// The discrete energy identities of published schemes, over all masses that they are defined for. Energies, gaps and
// works are computed here from states, not taken from the energy account. λ are normal forces, g₀ and g₁ the gaps.

namespace ricochet::test_support::published_schemes_test {

constexpr double rounding = 20.0 * std::numeric_limits<double>::epsilon();

/// Runs a scheme on every body with every mass that it supports and that can be computed for the body.
void each_run(const std::string& scheme, const std::string& keys,
              const std::function<void(CaseRun&, const std::string&)>& check, const std::string& contact = "") {
  auto bodies = thrown_bodies();
  bodies.push_back(one_sided_block());
  for (const auto& body : bodies) {
    for (const std::string& mass : masses_of(scheme)) {
      if (mass.starts_with("equivalent-") && body.name != bodies.back().name) continue;
      // The nodal areas at the vertices of six-node triangles are zero.
      const bool needs_area = scheme == "nitsche" && body.dimension == 3 && body.degree == 2;
      CaseRun run(
          thrown_case(body, mass, time_of(scheme) + keys, needs_area ? contact + "multipliers = \"p1\"\n" : contact));
      check(run, scheme + ' ' + keys + mass + ", " + body.name);
    }
  }
}

TEST(PublishedScheme, KaneLosesForceTimesFirstGap) {
  each_run("kane", "", [](CaseRun& run, const std::string& name) {
    double created = 0.0, deepest = 0.0;
    expect_identity(run, name, [&](const StepEnd& a, const StepEnd& b) {
      const double change = -b.normal.dot(a.gap);
      created = std::max(created, change / b.size_of_energy_terms);
      deepest = std::max(deepest, -b.gap.minCoeff());
      return change;
    });
    EXPECT_LT(created, rounding) << name;
    EXPECT_LT(deepest, 1e-12) << name;
  });
}

TEST(PublishedScheme, KaneLosesByFriction) {
  const auto check = [](CaseRun& run, const std::string& name) {
    double created = 0.0;
    expect_identity(run, name, [&](const StepEnd& a, const StepEnd& b) {
      Vector slip;
      run.problem().contact.rows->tangential_motion(b.displacement - a.displacement, slip);
      const double friction = -b.tangential.dot(slip);
      created = std::max(created, friction / b.size_of_energy_terms);
      return friction - b.normal.dot(a.gap);
    });
    EXPECT_LT(created, rounding) << name;
  };
  each_run("kane", "", check, "friction = 0.3\n");
}

TEST(PublishedScheme, LaursenChawlaKeepsEnergy) {
  each_run("laursen-chawla", "", [](CaseRun& run, const std::string& name) {
    double penetration = 0.0;
    expect_identity(run, name, [&](const StepEnd&, const StepEnd& b) {
      penetration = std::max(penetration, -b.gap.minCoeff());
      return 0.0;
    });
    EXPECT_GT(penetration, 1e-6) << name << ": the scheme is known to let nodes in a little";
  });
}

TEST(PublishedScheme, LaursenLoveKeepsEnergyWithoutPenetration) {
  each_run("laursen-love", "", [](CaseRun& run, const std::string& name) {
    double deepest = 0.0;
    bool pulled = false, kicked = false;
    expect_identity(run, name, [&](const StepEnd&, const StepEnd& b) {
      deepest = std::max(deepest, -b.gap.minCoeff());
      for (const OtherStageForces& part : run.scheme().last_step().other_stages) {
        kicked = true;
        pulled = pulled || part.forces.normal_reaction.minCoeff() < 0.0;
      }
      return 0.0;
    });
    EXPECT_LT(deepest, 1e-12) << name;
    EXPECT_TRUE(kicked) << name;
    EXPECT_FALSE(pulled) << name;
  });
}

TEST(PublishedScheme, PenaltyMidpointKeepsEnergyAndThatOfThePenalty) {
  for (const double penalty : {0.1, 10.0, 1e4, 1e6}) {
    const auto check = [penalty](CaseRun& run, const std::string& name) {
      const SparseRowMatrix& rows = run.problem().contact.rows->gap_operator;
      const SparseMatrix& k = run.problem().internal_force->tangent();
      Vector stiffness(rows.rows());
      for (Index i = 0; i < rows.rows(); ++i) {
        const Vector row = Vector(rows.row(i));
        stiffness[i] = penalty * row.dot(k * row) / (row.squaredNorm() * row.squaredNorm());
      }
      const auto stored = [&](const StepEnd& end) { return 0.5 * stiffness.dot(end.gap.cwiseMin(0.0).cwiseAbs2()); };
      double deepest = 0.0, least = 0.0;
      const auto identity = [&](const StepEnd& a, const StepEnd& b) {
        deepest = std::max(deepest, -b.gap.minCoeff());
        least = std::min(least, b.normal.minCoeff());
        return stored(a) - stored(b);
      };
      // The penalty multiplies the rounding of gaps, which are differences of displacements between two bodies.
      expect_identity(run, name, identity, penalty > 1e5 ? 40.0 : 20.0);
      EXPECT_GT(deepest, 0.0) << name;
      EXPECT_EQ(least, 0.0) << name << ": forces never pull";
    };
    each_run("penalty-midpoint", "penalty = " + std::to_string(penalty) + "\n", check);
  }
}

/// J − ½Σs²/Γ + ½Σ[p]₊²/Γ, with p = s − Γg.
TEST(PublishedScheme, NitscheLosesWherePressuresBeginAndEnd) {
  for (const double penalty : {1.1, 4.0, 1e3}) {
    const auto check = [penalty](CaseRun& run, const std::string& name) {
      const ContactStress stress = run.problem().contact_stress();
      const Vector gamma = penalty * stress.stiffness;
      const auto p_of = [&](const StepEnd& end) {
        return Vector(stress.rows * end.displacement - gamma.cwiseProduct(end.gap));
      };
      const auto added = [&](const StepEnd& end) {
        const Vector s = stress.rows * end.displacement;
        return 0.5 * (p_of(end).cwiseMax(0.0).cwiseAbs2() - s.cwiseAbs2()).cwiseQuotient(gamma).sum();
      };
      double deepest = 0.0, least = 0.0, law = 0.0, largest = 0.0, ends = 0.0;
      expect_identity(run, name, [&](const StepEnd& a, const StepEnd& b) {
        deepest = std::max(deepest, -b.gap.minCoeff());
        least = std::min(least, b.normal.minCoeff());
        largest = std::max(largest, b.normal.maxCoeff());
        const Vector before = p_of(a), after = p_of(b);
        double lost = 0.0;
        for (Index i = 0; i < before.size(); ++i) {
          const bool pressed = before[i] > 0.0;
          const double r = pressed ? std::max(0.5 * (before[i] + after[i]), 0.0) : 0.5 * std::max(after[i], 0.0);
          law = std::max(law, std::abs(b.normal[i] - r));
          if (pressed && after[i] <= 0.0) {
            lost += 0.5 * std::pow(r > 0.0 ? after[i] : before[i], 2) / gamma[i];
          } else if (!pressed && after[i] > 0.0) {
            lost += 0.5 * -before[i] * after[i] / gamma[i];
          }
        }
        ends += lost;
        return added(a) - added(b) - lost;
      });
      EXPECT_GT(deepest, 0.0) << name;
      EXPECT_EQ(least, 0.0) << name << ": forces never pull";
      EXPECT_LT(law, 1e-9 * largest) << name << ": r follows the law at these positions";
      EXPECT_GT(ends, 0.0) << name;
    };
    each_run("nitsche", "penalty = " + std::to_string(penalty) + "\n", check);
  }
}

/// J + ½h²(β−γ/2)AᵀMA, A the algorithmic acceleration.
TEST(PublishedScheme, AlphaSchemesDissipateInClosedForm) {
  struct Weights {
    std::string scheme;
    double rho, inertia, force;
  };
  std::vector<Weights> all;
  for (const double rho : {0.0, 0.8, 1.0})
    all.push_back({"generalized-alpha", rho, (2.0 * rho - 1.0) / (rho + 1.0), rho / (rho + 1.0)});
  for (const double rho : {0.5, 0.9}) all.push_back({"hht-alpha", rho, 0.0, (1.0 - rho) / (1.0 + rho)});
  for (const double rho : {0.2, 0.8}) all.push_back({"wbz-alpha", rho, (rho - 1.0) / (rho + 1.0), 0.0});
  for (const auto& [scheme, rho, inertia, force] : all) {
    const double gamma = 0.5 + force - inertia, beta = 0.25 * (0.5 + gamma) * (0.5 + gamma);
    const auto check = [&, force = force](CaseRun& run, const std::string& name) {
      const double h = run.scheme().step(), factor = 0.5 * h * h * (beta - 0.5 * gamma);
      const SparseMatrix m = run.problem().mass.to_sparse();
      const SparseMatrix& k = run.problem().internal_force->tangent();
      Vector before = run.state().dof_memory("algorithmic_acceleration");
      expect_identity(run, name, [&](const StepEnd& a, const StepEnd& b) {
        const Vector now = run.state().dof_memory("algorithmic_acceleration");
        const Vector du = b.displacement - a.displacement, da = now - before, mda = m * da;
        const double algorithmic = factor * (now.dot(m * now) - before.dot(m * before));
        before = now;
        return force * a.normal.dot(b.gap) - (1.0 - force) * b.normal.dot(a.gap) -
               (0.5 - force) * (du.dot(k * du) + du.dot(mda)) - factor * (2.0 * gamma - 1.0) * da.dot(mda) -
               algorithmic;
      });
    };
    each_run(scheme, "spectral_radius = " + std::to_string(rho) + "\n", check);
  }
}

/// Neither penetration nor drift, and Λ·G(V₀+V₁)/2 − (½−α_f)(ΔUᵀKΔU + ΔUᵀMΔA) − … − (Q−½hW)ᵀMA*, with Q and W from the
/// formulas of the state.
TEST(PublishedScheme, NonsmoothGeneralizedAlphaDissipatesInClosedForm) {
  for (const auto& [rho, e] : {std::pair{0.8, 0.0}, {0.8, 0.5}, {1.0, 0.0}, {0.0, 1.0}}) {
    const double force = rho / (rho + 1.0), inertia = (2.0 * rho - 1.0) / (rho + 1.0);
    const double gamma = 0.5 + force - inertia, beta = 0.25 * (0.5 + gamma) * (0.5 + gamma);
    const auto check = [=](CaseRun& run, const std::string& name) {
      const double h = run.scheme().step(), factor = 0.5 * h * h * (beta - 0.5 * gamma);
      const SparseMatrix m = run.problem().mass.to_sparse();
      const SparseMatrix& k = run.problem().internal_force->tangent();
      Vector before = run.state().dof_memory("algorithmic_acceleration");
      double deepest = 0.0;
      expect_identity(run, name, [&](const StepEnd& a, const StepEnd& b) {
        deepest = std::max(deepest, -b.gap.minCoeff());
        const Vector now = run.state().dof_memory("algorithmic_acceleration");
        const Vector du = b.displacement - a.displacement, da = now - before, mda = m * da;
        const Vector mean = (1.0 - gamma) * before + gamma * now;
        const Vector q = du - h * a.velocity - h * h * ((0.5 - beta) * before + beta * now);
        const Vector w = b.velocity - a.velocity - h * mean;
        Vector approach;
        run.problem().contact.rows->normal_motion(0.5 * (a.velocity + b.velocity), approach);
        const double algorithmic = factor * (now.dot(m * now) - before.dot(m * before));
        before = now;
        return h * b.normal.dot(approach) - (0.5 - force) * (du.dot(k * du) + du.dot(mda)) -
               factor * (2.0 * gamma - 1.0) * da.dot(mda) - (q - 0.5 * h * w).dot(m * mean) - algorithmic;
      });
      EXPECT_LT(deepest, 1e-12) << name;
    };
    each_run("nonsmooth-generalized-alpha",
             "spectral_radius = " + std::to_string(rho) + "\nrestitution = " + std::to_string(e) + "\n", check);
  }
}

/// E₁ − E₀ = ⅔(F₀+F_½)·Δ₁ + ⅓F₁·hV₁ − ½⟨a−b, a+b/3⟩ with a = (Δ₂, V₁−V_½) and b = (Δ₁, V_½−V₀) in the norm of K and M:
/// a form other than that of the energy account.
TEST(PublishedScheme, BatheDissipatesInClosedForm) {
  each_run("bathe", "", [](CaseRun& run, const std::string& name) {
    const double h = run.scheme().step();
    const SparseMatrix m = run.problem().mass.to_sparse();
    const SparseMatrix& k = run.problem().internal_force->tangent();
    expect_identity(run, name, [&](const StepEnd& s, const StepEnd& e) {
      const OtherStageForces& middle = run.scheme().last_step().other_stages[1];
      const Vector hv = run.simulation().increment();  // 3Δ₂ − Δ₁
      const Vector first = (middle.increment - 0.25 * hv) / 1.5, second = (hv + first) / 3.0;
      Vector gap_first, gap_hv;
      run.problem().contact.rows->normal_motion(first, gap_first);
      run.problem().contact.rows->normal_motion(hv, gap_hv);
      const Vector v_middle = (4.0 / h) * first - s.velocity, v_end = hv / h;
      const Vector au = second - first, av = v_end - 2.0 * v_middle + s.velocity;
      const Vector bu = second + first / 3.0, bv = v_end - v_middle + (v_middle - s.velocity) / 3.0;
      return 2.0 / 3.0 * (s.normal + middle.forces.normal_reaction).dot(gap_first) + e.normal.dot(gap_hv) / 3.0 -
             0.5 * (au.dot(k * bu) + av.dot(m * bv));
    });
  });
}

TEST(PublishedScheme, MoreauJeanChangesByTheImpulsesOnTheVelocitiesBefore) {
  for (const auto& [theta, e] : {std::pair{0.5, 0.0}, {0.5, 0.5}, {0.75, 0.0}, {1.0, 0.3}}) {
    const auto check = [theta = theta, e = e](CaseRun& run, const std::string& name) {
      const double h = run.scheme().step();
      const SparseMatrix m = run.problem().mass.to_sparse();
      const SparseMatrix& k = run.problem().internal_force->tangent();
      expect_identity(run, name, [&](const StepEnd& a, const StepEnd& b) {
        Vector approach;
        run.problem().contact.rows->normal_motion(a.velocity, approach);
        const Vector du = b.displacement - a.displacement, dv = b.velocity - a.velocity;
        return (1.0 - theta * (1.0 + e)) * h * b.normal.dot(approach) -
               (theta - 0.5) * (dv.dot(m * dv) + du.dot(k * du));
      });
    };
    each_run("moreau-jean", "theta = " + std::to_string(theta) + "\nrestitution = " + std::to_string(e) + "\n", check);
  }
}

/// With impulses on V_θ, the work of contact has a sign for θ(1+e) ≥ 1 if points approach, and that of friction always.
TEST(PublishedScheme, MoreauJeanLosesByFrictionWhereItsSlipIsThatOfTheta) {
  const auto check = [](CaseRun& run, const std::string& name) {
    const double h = run.scheme().step();
    double created = 0.0, slid = 0.0;
    expect_identity(run, name, [&](const StepEnd& a, const StepEnd& b) {
      Vector approach, slip;
      run.problem().contact.rows->normal_motion(a.velocity, approach);
      const Vector du = b.displacement - a.displacement, dv = b.velocity - a.velocity;
      run.problem().contact.rows->tangential_motion(du, slip);
      const double friction = -b.tangential.dot(slip);
      created = std::max(created, friction / b.size_of_energy_terms);
      slid = std::min(slid, friction / b.size_of_energy_terms);
      const double kinetic = run.problem().mass.quadratic_form(dv);
      return friction + 0.25 * h * b.normal.dot(approach) -
             0.25 * (kinetic + du.dot(run.problem().internal_force->tangent() * du));
    });
    EXPECT_LT(created, rounding) << name;
    EXPECT_LT(slid, -1e-9) << name << ": there is friction";
  };
  each_run("moreau-jean", "theta = 0.75\nslip = \"theta\"\n", check, "friction = 0.3\n");
}

/// Changes of the energy at half steps, E^{n+½} − E^{n−½}, against `identity(n−1, n, n+1)`.
void expect_half_step_identity(CaseRun& run, const std::string& name, double stiffness,
                               const std::function<double(const StepEnd&, const StepEnd&, const StepEnd&)>& identity) {
  const SemidiscreteProblem& problem = run.problem();
  const auto energy = [&](const StepEnd& a, const StepEnd& b) {
    const Vector v = (b.displacement - a.displacement) / run.scheme().step();
    const Vector du = b.displacement - a.displacement, mean = 0.5 * (a.displacement + b.displacement);
    Vector force;
    problem.internal_force->evaluate(du, force);
    return total_energy(problem, mean, v) + 0.5 * (stiffness - 0.25) * du.dot(force);
  };
  std::vector<StepEnd> last;
  double worst = 0.0, touched = 0.0;
  run.run([&] {
    last.emplace_back(run);
    if (last.size() < 3) return;
    const double change = energy(last[1], last[2]) - energy(last[0], last[1]);
    worst = std::max(worst, std::abs(change - identity(last[0], last[1], last[2])) / last[1].size_of_energy_terms);
    touched = std::max(touched, last[1].normal.maxCoeff());
    last.erase(last.begin());
  });
  EXPECT_LT(worst, rounding) << name;
  EXPECT_GT(touched, 0.0) << name << ": the body never touched the obstacle";
}

TEST(PublishedScheme, PaoliSchatzmanLosesForceTimesTheGapBefore) {
  for (const double e : {0.0, 0.5}) {
    const auto check = [e](CaseRun& run, const std::string& name) {
      double deepest = 0.0, created = 0.0;
      expect_half_step_identity(run, name, 0.25, [&](const StepEnd& a, const StepEnd& b, const StepEnd& c) {
        deepest = std::max(deepest, -c.gap.minCoeff());
        const double change = -0.5 * (1.0 + e) * b.normal.dot(a.gap);
        created = std::max(created, change / b.size_of_energy_terms);
        return change;
      });
      if (e > 0.0) return;
      EXPECT_LT(deepest, 1e-12) << name;
      EXPECT_LT(created, rounding) << name;
    };
    each_run("paoli-schatzman", "restitution = " + std::to_string(e) + "\n", check);
  }
}

TEST(PublishedScheme, PaoliSchatzmanIsSoWithExplicitStiffness) {
  for (const auto& body : thrown_bodies()) {
    CaseRun run(thrown_case(body, "lumped", time_of("paoli-schatzman") + "stiffness = \"explicit\"\n"));
    expect_half_step_identity(run, body.name, 0.0, [](const StepEnd& a, const StepEnd& b, const StepEnd&) {
      return -0.5 * b.normal.dot(a.gap);
    });
  }
}

TEST(PublishedScheme, TaylorFlanaganLandsOnTheObstacleAndLosesEnergy) {
  each_run("taylor-flanagan", "", [](CaseRun& run, const std::string& name) {
    double deepest = 0.0;
    expect_half_step_identity(run, name, 0.0, [&](const StepEnd& a, const StepEnd& b, const StepEnd& c) {
      deepest = std::max(deepest, -c.gap.minCoeff());
      return -0.5 * b.normal.dot(a.gap);
    });
    EXPECT_LT(deepest, 1e-12) << name;
  });
}

TEST(PublishedScheme, CdLagrangeChangesByTheImpulsesOnTheVelocitiesBefore) {
  for (const double e : {0.0, 0.6}) {
    const auto check = [e](CaseRun& run, const std::string& name) {
      const auto identity = [&](const StepEnd& a, const StepEnd& b, const StepEnd&) {
        Vector approach;
        run.problem().contact.rows->normal_motion(b.displacement - a.displacement, approach);
        return 0.5 * (1.0 - e) * b.normal.dot(approach);
      };
      expect_half_step_identity(run, name, 0.0, identity);
    };
    each_run("cd-lagrange", "restitution = " + std::to_string(e) + "\n", check);
  }
}

/// Displacement of a body that vibrates in free flight, with three step lengths: the order of the schemes, which no
/// identity of a single step shows.
TEST(PublishedScheme, IsOfSecondOrderWhereNothingTouches) {
  for (const std::string& scheme : scheme_names()) {
    for (const std::string& mass : masses_of(scheme)) {
      std::string text = thrown_case(one_sided_block(), mass, time_of(scheme));
      const auto replace = [&](const std::string& old, const std::string& now) {
        ASSERT_NE(text.find(old), std::string::npos) << old;
        text.replace(text.find(old), old.size(), now);
      };
      replace("point = [0.0, 0.0]", "point = [0.0, -10.0]");
      replace("velocity = [\"0.1-0.2*y\", \"-0.5+0.2*x\"]", "velocity = [\"0.3*x\", \"-0.5+0.1*(y-1)\"]");
      std::vector<Vector> ends;
      for (const char* const step : {"time.step=0.0004", "time.step=0.0002", "time.step=0.0001"}) {
        CaseRun run(text, {step, "time.end=0.16"});
        run.run([] {});
        ends.push_back(run.state().displacement);
      }
      const double order = std::log2((ends[0] - ends[1]).norm() / (ends[1] - ends[2]).norm());
      const double expected = scheme == "newmark" ? 1.0 : 2.0;  // γ = 0.6
      EXPECT_NEAR(order, expected, 0.1) << scheme << ' ' << mass;
    }
  }
}

}  // namespace ricochet::test_support::published_schemes_test
