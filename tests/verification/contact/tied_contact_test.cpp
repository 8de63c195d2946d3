#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/mesh/merge_parts.hpp"
#include "ricochet/simulation/history/momentum_account.hpp"
#include "ricochet/solver/step_solver.hpp"
#include "support/case_run.hpp"
#include "support/two_bodies.hpp"

/// @file Bodies of tied halves in contact: the seam ends on the contact boundary, so some of its nodes are tied.
namespace ricochet::test_support::tied_contact_test {

/// Two halves, tied, thrown at a plane with friction.
std::string halves_case(int d, const std::string& time, const std::string& mass, const std::string& multipliers) {
  StackedBoxes stack{d == 2 ? CellShape::triangle : CellShape::hexahedron,
                     d == 2 ? CellShape::quadrilateral : CellShape::hexahedron};
  stack.lower_counts = d == 2 ? std::vector{5, 4} : std::vector{3, 2, 4};
  stack.upper_counts = d == 2 ? std::vector{4, 4} : std::vector{2, 3, 4};
  if (d == 2) {
    // Side by side: the seam ends on the plane, so that nodes of the contact boundary are tied.
    const auto side = [](double shift) {
      return [shift](const Vector& x) -> Vector { return Eigen::Vector2d(shift + x[1], 1.0 - x[0]); };
    };
    stack.lower_map = side(0.0);
    stack.upper_map = side(1.0);
  }
  Mesh mesh = make_stack(stack);
  const std::string path = write_mesh(fmt::format("halves{}.msh", d), mesh);
  const std::string contact = d == 2 ? "group = [\"lower.x1\", \"upper.x1\"]" : "group = \"lower.z0\"";
  const std::string seam =
      d == 2 ? "group = \"lower.y1\"\nagainst = \"upper.y0\"" : "group = \"lower.z1\"\nagainst = \"upper.z0\"";
  return fmt::format(
             "[mesh]\nfile = \"{}\"\n[[material]]\ngroup = \"all\"\ndensity = 1.0\nlambda = 30.0\nmu = 20.0\n"
             "[obstacle.floor]\ntype = \"plane\"\npoint = {}\nnormal = {}\n[[contact]]\n{}\nobstacle = \"floor\"\n"
             "friction = 0.3\nmultipliers = \"{}\"\n[[contact]]\n{}\ntied = true\n[mass]\ntype = \"{}\"\n",
             path, d == 2 ? "[0, -0.02]" : "[0, 0, -0.02]", d == 2 ? "[0, 1]" : "[0, 0, 1]", contact, multipliers, seam,
             mass) +
         (d == 2 ? "[initial]\nvelocity = [\"0.1-0.2*y\", \"-0.5+0.2*x\"]\n"
                 : "[initial]\nvelocity = [\"0.1-0.2*z\", \"0.1\", \"-0.5+0.2*x\"]\n") +
         "[time]\n" + time + "end = 0.8\n";
}

TEST(TiedHalves, AccountsCloseUnderEveryKindOfScheme) {
  struct Method {
    const char *time, *mass;
  };
  for (const int d : {2, 3}) {
    for (const Method& method :
         {Method{"scheme = \"reduced-kane\"\nstep = 0.01\n", "equivalent"},
          Method{"scheme = \"reduced-kane\"\nstep = 0.01\n", "equivalent-cellwise"},
          Method{"scheme = \"newmark\"\npreset = \"trapezoidal\"\nstep = 0.01\n", "equivalent-compact"},
          Method{"scheme = \"contact-stabilized\"\nstep = 0.01\n", "consistent"},
          Method{"scheme = \"kane\"\nstep = 0.01\n", "lumped"},
          Method{"scheme = \"nitsche\"\nstep = 0.01\n", "consistent"},
          Method{"scheme = \"cd-lagrange\"\nstep = 0.0015\n", "lumped"},
          Method{"scheme = \"semi-explicit\"\nstep = 0.001\n", "equivalent-lumped"}}) {
      for (const char* multipliers : {"nodal", "p1"}) {
        SCOPED_TRACE(std::string(method.time) + method.mass + multipliers + std::to_string(d));
        std::vector<std::string> settings;
        if (std::string(method.time).find("nitsche") != std::string::npos) settings = {"contact.0.friction=0"};
        const auto run = std::make_unique<CaseRun>(halves_case(d, method.time, method.mass, multipliers), settings);
        MomentumAccount momentum(run->problem(), run->scheme(), run->state());
        const auto total = [&] {
          Vector values;
          run->problem().mass.multiply(run->state().velocity, values);
          Eigen::Vector3d sum = Eigen::Vector3d::Zero();
          for (Index dof = 0; dof < values.size(); ++dof) sum[dof % d] += values[dof];
          return sum;
        };
        const Eigen::Vector3d start = total();
        double worst = 0.0, largest = 0.0, touched = 0.0, seam = 0.0;
        run->run(
            [&] {
              momentum.enter_step(run->state());
              const Energies now = run->simulation().account().energies(run->state());
              largest = std::max({largest, now.kinetic, now.elastic});
              worst = std::max(worst, std::abs(run->simulation().account().residual(now)));
              touched = std::max(touched, run->state().forces.normal_reaction.maxCoeff());
              Vector completed = run->state().displacement;
              run->problem().tied->complete(completed, d);
              seam = std::max(seam, (completed - run->state().displacement).lpNorm<Eigen::Infinity>());
            },
            false);
        EXPECT_GT(touched, 0.0);
        EXPECT_LT(worst, 1e-12 * largest);
        EXPECT_EQ(seam, 0.0);
        if (std::string(method.time).find("cd-lagrange") == std::string::npos &&
            std::string(method.time).find("semi") == std::string::npos) {
          EXPECT_LT((total() - start - momentum.impulse().force).norm(), 1e-12 * start.norm());
        }
      }
    }
  }
}

TEST(TiedHalves, AreSolvedAlikeWithAndWithoutAFactor) {
  for (const int d : {2, 3}) {
    const std::string text = halves_case(d, "step = 0.01\n", "equivalent", "p1");
    CaseRun direct(text, {"solver.method=direct", "contact.0.friction=0"}),
        iterative(text, {"solver.method=iterative", "solver.tolerance=1e-13", "contact.0.friction=0"});
    double difference = 0.0, moved = 0.0;
    direct.run([&] {
      if (direct.state().step > 0) iterative.simulation().advance();
      difference = std::max(difference,
                            (direct.state().displacement - iterative.state().displacement).lpNorm<Eigen::Infinity>());
      moved = std::max(moved, direct.state().displacement.lpNorm<Eigen::Infinity>());
    });
    EXPECT_LT(difference, 1e-8 * moved);
  }
}

/// The reactions of a uniform pressure 1 are D_i: the reported pressure is 1 at every node, on the whole area.
void expect_uniform_pressure(const ContactBoundary& contact, double area) {
  EXPECT_NEAR(contact.weights.sum(), area, 1e-12 * area);
  Vector pressure;
  contact.recover_pressure(contact.weights, pressure);
  for (Index i = 0; i < pressure.size(); ++i)
    EXPECT_NEAR(pressure[i], 1.0, 1e-10) << "node " << contact.nodes[std::size_t(i)];
}

TEST(TiedHalves, HaveAUniformPressureAcrossTheSeam) {
  for (const char* multipliers : {"nodal", "p1", "dual", "p0"}) {
    SCOPED_TRACE(multipliers);
    for (const int degree : {1, 2}) {
      const CaseRun run(halves_case(2, "step = 0.01\n", "equivalent", multipliers),
                        {"contact.0.unstable_multipliers=allow", fmt::format("mesh.degree={}", degree)});
      expect_uniform_pressure(run.problem().contact, 2.0);
    }
  }
}

/// The halves in contact with a third body, on either side of the contact.
TEST(TiedHalves, TouchAnotherBody) {
  const auto block = [](const PointMap& map, std::vector<int> counts) {
    return make_box_mesh({CellShape::quadrilateral, std::move(counts), 1, 0.0, map});
  };
  const auto at = [](double x, double y, double width) -> PointMap {
    return [=](const Vector& p) { return Vector(Eigen::Vector2d(x + width * p[0], y + p[1])); };
  };
  const std::string mesh =
      write_mesh("halves_on_block.msh", merge_parts({{"left", block(at(0.0, 1.02, 1.0), {4, 5})},
                                                     {"right", block(at(1.0, 1.02, 1.0), {3, 3})},
                                                     {"below", block(at(0.0, 0.0, 2.0), {9, 4})}}));
  for (const char* multipliers : {"nodal", "p1", "dual"}) {
    for (const char* side : {"group", "against"}) {
      SCOPED_TRACE(std::string(multipliers) + side);
      CaseRun run(fmt::format(
          "[mesh]\nfile = \"{}\"\n[[material]]\ngroup = \"all\"\ndensity = 1.0\nlambda = 30.0\nmu = 20.0\n"
          "[[contact]]\ngroup = [\"left.y0\", \"right.y0\"]\nagainst = \"below.y1\"\nmultipliers = \"{}\"\n"
          "multipliers_on = \"{}\"\nfriction = 0.3\n[[contact]]\ngroup = \"left.x1\"\nagainst = \"right.x0\"\n"
          "tied = true\n[[motion]]\ngroup = [\"left.body\", \"right.body\"]\nvelocity = [0.1, -0.5]\n[time]\n"
          "step = 0.01\nend = 0.8\n",
          mesh, multipliers, side));
      const ContactBoundary& contact = run.problem().contact;
      expect_uniform_pressure(contact, 2.0);
      double worst = 0.0, largest = 0.0, touched = 0.0;
      run.run([&] {
        const Energies now = run.simulation().account().energies(run.state());
        largest = std::max({largest, now.kinetic, now.elastic});
        worst = std::max(worst, std::abs(run.simulation().account().residual(now)));
        touched = std::max(touched, run.state().forces.normal_reaction.maxCoeff());
      });
      EXPECT_GT(touched, 0.0);
      EXPECT_LT(worst, 1e-12 * largest);
    }
  }
}

}  // namespace ricochet::test_support::tied_contact_test
