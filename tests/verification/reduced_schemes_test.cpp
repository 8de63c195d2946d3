#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "ricochet/mass/mass.hpp"
#include "support/case_run.hpp"
#include "support/thrown_body.hpp"

// Schemes with massless contact nodes in equilibrium at the end of each step: their balances of energy, derived in
// docs/energy.md, from states alone. K_cc z = (K ΔU)_c, W_c = H K_cc⁻¹ Hᵀ.

namespace ricochet::test_support::reduced_schemes_test {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

std::string reduced_kane(const std::string& weight) {
  return "scheme = \"reduced-kane\"\nreaction_weight = \"" + weight + "\"\n";
}

/// Full stiffness K_cc of the contact nodes.
class Layer {
 public:
  explicit Layer(const SemidiscreteProblem& problem) : dofs_(problem.contact_dofs) {
    const SparseMatrix stiffness = problem.internal_force->tangent();
    rows_ = Matrix(stiffness)(dofs_, Eigen::all);
    block_.compute(Matrix(rows_(Eigen::all, dofs_)));
  }
  /// K_cc⁻¹ (K u)_c.
  [[nodiscard]] Vector place(const Vector& displacement) const { return block_.solve(rows_ * displacement); }
  /// zᵀK_cc z.
  [[nodiscard]] double form(const Vector& displacement) const { return place(displacement).dot(rows_ * displacement); }
  /// Fᵀ K_cc⁻¹ F of nodal forces.
  [[nodiscard]] double compliance(const Vector& left, const Vector& right) const {
    const Vector at_right = right(dofs_);
    return left(dofs_).dot(block_.solve(at_right));
  }

 private:
  std::vector<Index> dofs_;
  Matrix rows_;
  Eigen::LLT<Matrix> block_;
};

Vector nodal(const CaseRun& run, const Vector& normal, const Vector& tangential) {
  Vector force = Vector::Zero(run.problem().dof_count());
  run.problem().contact.rows->add_force(normal, tangential, force);
  return force;
}

std::vector<std::string> singular_masses() { return masses_of("reduced-kane"); }

std::vector<double> steps() { return {0.01, 0.1, 1.0}; }

/// Masses of bodies that have contact on all sides.
bool is_possible(const ThrownBody& body, const std::string& mass) {
  return body.name == "block" || mass == "equivalent";
}

std::vector<ThrownBody> bodies() {
  std::vector<ThrownBody> result = thrown_bodies();
  result.push_back(one_sided_block());
  return result;
}

std::vector<std::string> overrides(double step) {
  return {"time.step=" + std::to_string(step), "time.end=" + std::to_string(100 * step)};
}

TEST(ReducedKane, LosesEnergyAtEachPointInEveryStep) {
  for (const ThrownBody& body : bodies()) {
    for (const std::string& mass : singular_masses()) {
      if (!is_possible(body, mass)) continue;
      for (const double friction : {0.0, 0.3, 1.0}) {
        for (const double step : steps()) {
          CaseRun run(thrown_case(body, mass, reduced_kane("end"), "friction = " + std::to_string(friction) + "\n"),
                      overrides(step));
          const Layer layer(run.problem());
          const Index tangents = body.dimension - 1;
          StepEnd before(run);
          double worst = 0.0, created = 0.0, deepest = 0.0, touched = 0.0, size = before.size_of_energy_terms;
          run.run(
              [&] {
                const StepEnd after(run);
                size = std::max(size, after.size_of_energy_terms);
                const Vector change = after.displacement - before.displacement;
                const Vector slip = run.problem().contact.rows->tangential_trace * change;
                double work = 0.0;
                for (Index i = 0; i < after.gap.size(); ++i) {
                  const double contact = -after.normal[i] * before.gap[i];
                  double rubbing = 0.0;
                  if (friction > 0.0)
                    rubbing =
                        -after.tangential.segment(i * tangents, tangents).dot(slip.segment(i * tangents, tangents));
                  created = std::max({created, contact / size, rubbing / size});
                  work += contact + rubbing;
                }
                const double dissipation = 0.5 * layer.form(change);
                worst = std::max(worst, std::abs(after.energy - before.energy - work + dissipation) / size);
                deepest = std::max(deepest, -after.gap.minCoeff() / after.displacement.lpNorm<Eigen::Infinity>());
                touched = std::max(touched, after.normal.maxCoeff());
                before = after;
              },
              false);
          const std::string name =
              body.name + ", " + mass + ", F = " + std::to_string(friction) + ", step = " + std::to_string(step);
          EXPECT_LT(worst, 50.0 * epsilon) << name;
          EXPECT_LT(created, 20.0 * epsilon) << name;
          EXPECT_LT(deepest, 1e-13) << name;
          EXPECT_GT(touched, 0.0) << name;
        }
      }
    }
  }
}

/// It is named only where it has an effect.
TEST(ReducedKane, NamesTheSettingThatLosesLess) {
  const auto setting = [](const std::string& weight, double friction, const std::string& more) {
    CaseRun run(thrown_case(bodies().front(), "equivalent", reduced_kane(weight),
                            "friction = " + std::to_string(friction) + "\n"),
                {more});
    return run.scheme().traits_for(run.problem()).less_dissipative_setting;
  };
  const std::string any = "time.step=0.01", named = "time.reaction_weight = \"adaptive\"";
  EXPECT_EQ(setting("automatic", 0.3, any), named);
  EXPECT_EQ(setting("end", 0.0, any), named);
  EXPECT_EQ(setting("automatic", 0.0, any), "");
  EXPECT_EQ(setting("adaptive", 0.3, any), "");
  EXPECT_EQ(setting("end", 0.3, "material.0.damping={stiffness=0.001}"), "");  // at contact nodes, too
}

/// The account has three terms of the mean reaction; each is a loss.
TEST(ReducedKane, AdaptiveWeightCreatesNoEnergyAndLosesLess) {
  for (const ThrownBody& body : bodies()) {
    for (const double friction : {0.0, 0.3}) {
      for (const double step : {0.003, 0.01, 0.1, 1.0}) {
        const std::string name = body.name + ", F = " + std::to_string(friction) + ", step = " + std::to_string(step);
        double lost[2] = {0.0, 0.0};
        for (const bool adaptive : {false, true}) {
          CaseRun run(thrown_case(body, "equivalent", reduced_kane(adaptive ? "adaptive" : "end"),
                                  "friction = " + std::to_string(friction) + "\n"),
                      overrides(step));
          StepEnd before(run);
          Works works;
          double created = 0.0, residual = 0.0, size = before.size_of_energy_terms;
          run.run(
              [&] {
                const StepEnd after(run);
                size = std::max(size, after.size_of_energy_terms);
                EnergyAccount account = run.simulation().account();
                const Works now = account.works();
                created = std::max({created, (after.energy - before.energy) / size,
                                    (now.contact - works.contact) / size, (now.friction - works.friction) / size,
                                    -(now.numerical_dissipation - works.numerical_dissipation) / size});
                residual = std::max(residual, std::abs(account.residual(account.energies(run.state()))) / size);
                works = now;
                before = after;
              },
              false);
          EXPECT_LT(created, 1e-12) << name;
          EXPECT_LT(residual, 1e-11) << name;
          lost[adaptive ? 1 : 0] = -works.contact + works.numerical_dissipation;
        }
        if (step < 0.005) {
          EXPECT_LT(lost[1], 0.1 * lost[0]) << name;
        }
      }
    }
  }
}

TEST(MeanReaction, KeepsEnergyAndMomentaForEveryStep) {
  for (const ThrownBody& body : bodies()) {
    for (const std::string& mass : singular_masses()) {
      if (!is_possible(body, mass)) continue;
      for (const double step : {0.003, 0.01, 0.1, 1.0}) {
        CaseRun run(thrown_case(body, mass, "scheme = \"mean-reaction\"\n"), overrides(step));
        const StepEnd start(run);
        double worst = 0.0, deepest = 0.0, touched = 0.0, momentum = 0.0, size = start.size_of_energy_terms;
        Vector last, inertia;
        run.problem().mass.multiply(run.state().velocity, last);
        run.run(
            [&] {
              const StepEnd after(run);
              size = std::max(size, after.size_of_energy_terms);
              worst = std::max(worst, std::abs(after.energy - start.energy) / size);
              deepest = std::max(deepest, -after.gap.minCoeff() / after.displacement.lpNorm<Eigen::Infinity>());
              touched = std::max(touched, after.normal.maxCoeff());
              run.problem().mass.multiply(run.state().velocity, inertia);
              const Vector force = run.problem().loads.constant() + nodal(run, run.state().forces.acting_normal(),
                                                                          run.state().forces.acting_tangential());
              const Vector left = inertia - last - step * force;
              for (int k = 0; k < body.dimension; ++k) {
                const auto component = Eigen::seq(k, Eigen::last, body.dimension);
                momentum = std::max(momentum,
                                    std::abs(left(component).sum()) / (inertia.lpNorm<1>() + step * force.lpNorm<1>()));
              }
              last = inertia;
            },
            false);
        const std::string name = body.name + ", " + mass + ", step = " + std::to_string(step);
        EXPECT_LT(worst, 1e-12) << name;
        EXPECT_LT(deepest, 1e-13) << name;
        EXPECT_LT(momentum, 1e-13) << name;
        EXPECT_GT(touched, 0.0) << name;
      }
    }
  }
}

/// Varying loads on contact nodes also work along the path: this is no loss of the scheme.
TEST(MeanReaction, BooksTheWorkOfLoadsOnContactNodes) {
  for (const ThrownBody& body : bodies()) {
    for (const auto& [scheme, friction, step] :
         {std::tuple(std::string("scheme = \"mean-reaction\"\n"), 0.0, 0.01),
          std::tuple(reduced_kane("adaptive"), 0.0, 0.01), std::tuple(reduced_kane("adaptive"), 0.0, 0.1),
          std::tuple(reduced_kane("adaptive"), 0.3, 0.1), std::tuple(reduced_kane("adaptive"), 0.3, 1.0)}) {
      std::string text = thrown_case(body, "equivalent", scheme, "friction = " + std::to_string(friction) + "\n");
      const bool flat = body.dimension == 2;
      text.insert(text.find("[initial]"),
                  std::string("body_force = [\"sin(20*t)\", ") + (flat ? "" : "\"0\", ") + "\"3*cos(11*t)*x\"]\n");
      CaseRun run(text, overrides(step));
      double least = 0.0, most = 0.0, contact = 0.0, residual = 0.0, size = 0.0;
      Works before;
      run.run(
          [&] {
            EnergyAccount account = run.simulation().account();
            const Works now = account.works();
            const Energies energies = account.energies(run.state());
            size = std::max({size, energies.kinetic, energies.elastic, std::abs(now.load)});
            const double step = now.numerical_dissipation - before.numerical_dissipation;
            least = std::min(least, step);
            most = std::max(most, step);
            contact = std::max(contact, std::abs(now.contact));
            residual = std::max(residual, std::abs(account.residual(energies)));
            before = now;
          },
          false);
      // With friction the iterations for the mean reaction stop at 1e-10 of the reactions if rounding stalls them.
      EXPECT_GT(least, (friction > 0.0 ? -1e-11 : -1e-12) * size) << body.name << scheme << step;
      EXPECT_LT(residual, 1e-12 * size) << body.name << scheme;
      if (scheme.find("mean") == std::string::npos) continue;
      EXPECT_LT(most, 1e-13 * size) << body.name << scheme;
      EXPECT_LT(contact, 1e-12 * size) << body.name << scheme;
    }
  }
}

TEST(ReducedMidpoint, EnergyChangesWithTheStatusOnly) {
  for (const ThrownBody& body : bodies()) {
    CaseRun run(thrown_case(body, "equivalent", "scheme = \"reduced-midpoint\"\n"));
    const Layer layer(run.problem());
    StepEnd before(run);
    double worst = 0.0, deepest = 0.0, touched = 0.0;
    run.run(
        [&] {
          const StepEnd after(run);
          const Vector& middle = run.state().forces.acting_normal();
          const Vector none;
          const Vector difference = nodal(run, middle - 0.5 * (before.normal + after.normal), none);
          const Vector change = nodal(run, after.normal - before.normal, none);
          const double identity = middle.dot(after.gap - before.gap) - layer.compliance(difference, change);
          worst = std::max(worst, std::abs(after.energy - before.energy - identity) / after.size_of_energy_terms);
          deepest = std::max(deepest, -after.gap.minCoeff());
          touched = std::max(touched, after.normal.maxCoeff());
          before = after;
        },
        false);
    EXPECT_LT(worst, 50.0 * epsilon) << body.name;
    EXPECT_LT(deepest, 1e-12) << body.name;
    EXPECT_GT(touched, 0.0) << body.name;
  }
}

/// A block of few cells on a plane tilted so that friction is at `part` of its limit.
std::string block_on_slope(double part, double step, long count, const std::string& motion) {
  const std::string mesh = mesh_geometry(
      "little-block",
      "Rectangle(1)={0,0,0,1,0.5}; Transfinite Curve{1,3}=5; Transfinite Curve{2,4}=4; Transfinite Surface{1}; "
      "Recombine Surface{1}; Physical Surface(\"body\")={1}; Physical Curve(\"bottom\")={1};",
      1.0, 1);
  return "[mesh]\nfile = \"" + mesh +
         "\"\n[[material]]\ngroup = \"body\"\ndensity = 1.0\nyoung = 1000.0\npoisson = 0.3\ndamping = { stiffness = "
         "0.01 "
         "}\n[obstacle.floor]\ntype = \"plane\"\npoint = [0.0, 0.0]\nnormal = [0.0, 1.0]\n" +
         motion + "[[contact]]\ngroup = \"bottom\"\nobstacle = \"floor\"\nfriction = 0.5\n[load]\ngravity = [" +
         std::to_string(0.5 * part) + ", -1.0]\n[initial]\ndisplacement = \"static\"\n[mass]\ntype = \"equivalent\"\n" +
         "[time]\nscheme = \"reduced-kane\"\nstep = " + std::to_string(step) +
         "\nend = " + std::to_string(step * double(count)) + "\n";
}

TEST(ReducedKane, SticksAtNearlyTheLimitWithoutCreep) {
  // On a plane at rest, and on one that moves along with the block.
  for (const std::string motion : {"", "velocity = [0.125, 0.0]\n"}) {
    for (const double step : {0.002, 0.1, 1.0}) {
      const long count = 20000;
      std::string text = block_on_slope(0.99, step, count, motion);
      if (!motion.empty()) text.replace(text.find("displacement = \"static\""), 23, "velocity = [0.125, 0.0]");
      CaseRun run(text);
      const double travel = motion.empty() ? 0.0 : 0.125;
      Vector settled;
      double creep = 0.0;
      run.run(
          [&] {
            const State& state = run.state();
            Vector place;
            state.forces.rows->tangential_motion(state.displacement, place);
            place.array() -= travel * state.time * state.forces.rows->tangents[0](0, 0);
            if (state.step == count / 10) settled = place;
            if (state.step > count / 10) creep = std::max(creep, (place - settled).lpNorm<Eigen::Infinity>());
          },
          false);
      const double size = 1e-3 + travel * run.state().time;
      EXPECT_LT(creep, 2e-15 * std::max(1.0, size)) << motion << step;
      for (const ContactStatus status : run.state().contact_status) EXPECT_EQ(status, ContactStatus::stick);
    }
  }
}

}  // namespace ricochet::test_support::reduced_schemes_test
