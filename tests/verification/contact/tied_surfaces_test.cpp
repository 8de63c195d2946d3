#include "ricochet/contact/tied_surfaces.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/fem/mesh_measures.hpp"
#include "ricochet/simulation/momentum_account.hpp"
#include "ricochet/solver/step_solver.hpp"
#include "support/case_run.hpp"
#include "support/two_bodies.hpp"

/// @file Surfaces tied on meshes that do not match: linear displacements pass, turns have no strain, accounts close.
namespace ricochet::test_support {
namespace {

PointMap turn_of(int d) {
  Matrix turn = Matrix::Identity(d, d);
  if (d == 2) turn = Eigen::Rotation2Dd(0.4).toRotationMatrix();
  if (d == 3) turn = Eigen::AngleAxisd(0.5, Eigen::Vector3d(1.0, 2.0, 3.0).normalized()).toRotationMatrix();
  return affine_map(turn, Vector::LinSpaced(d, 0.3, -0.7));
}

struct TiedStack {
  std::unique_ptr<MeshedBody> test;
  TiedSurface surface;
  TiedNodes tied;
};

TiedStack tie(const StackedBoxes& stack, int degree, bool upper_follows) {
  TiedStack result{make_meshed_body(make_stack(stack), degree), {}, {}};
  const int d = result.test->mesh.dimension;
  const std::string axis = d == 2 ? "y" : "z";
  ContactPair pair;
  pair.group = upper_follows ? "upper." + axis + "0" : "lower." + axis + "1";
  pair.opposite_group = upper_follows ? "lower." + axis + "1" : "upper." + axis + "0";
  pair.facets = result.test->mesh.group(pair.group, d - 1).members;
  pair.opposite_facets = result.test->mesh.group(pair.opposite_group, d - 1).members;
  pair.tied = true;
  result.surface = tie_surfaces(result.test->body, pair);
  result.tied = TiedNodes(result.surface.ties, result.test->space.node_count());
  move_tied_nodes(result.tied, result.test->mesh, result.test->space);
  return result;
}

/// Displacements of the nodes by a linear function, or by a small turn.
Vector linear_field(const DisplacementSpace& space, const Matrix& gradient) {
  const Points values = gradient * space.nodes;
  return values.reshaped();
}

Matrix small_turn(int d) {
  Matrix turn = Matrix::Zero(d, d);
  turn(0, 1) = -1.0;
  turn(1, 0) = 1.0;
  if (d == 3) {
    turn(1, 2) = 0.3;
    turn(2, 1) = -0.3;
    turn(0, 2) = 0.7;
    turn(2, 0) = -0.7;
  }
  return turn;
}

template <class Check>
void for_each_stack(bool curved, const Check& check) {
  for (const auto& shapes : {std::vector{CellShape::triangle, CellShape::quadrilateral},
                             std::vector{CellShape::tetrahedron, CellShape::hexahedron}}) {
    for (const CellShape lower : shapes) {
      for (const CellShape upper : shapes) {
        for (const int degree : {1, 2}) {
          for (const bool upper_follows : {true, false}) {
            const int d = dimension(lower);
            StackedBoxes stack{lower, upper, {5, 3}, {7, 2}};
            if (d == 3) stack.lower_counts = {3, 2, 2}, stack.upper_counts = {2, 4, 2};
            stack.geometry_degree = curved ? degree : 1;
            if (curved) {
              const auto rise = [](const Vector& x) { return 0.1 * std::pow(x[0] - 0.4, 2); };
              stack.lower_map = [rise, d](const Vector& x) {
                Vector y = x;
                y[d - 1] += x[d - 1] * rise(x);
                return y;
              };
              stack.upper_map = [rise, d](const Vector& x) {
                Vector y = x;
                y[d - 1] += 1.0 + (1.0 - x[d - 1]) * rise(x);
                return y;
              };
            }
            stack.both = turn_of(d);
            SCOPED_TRACE(name(lower) + name(upper) + std::to_string(degree) + (upper_follows ? "upper" : "lower"));
            check(tie(stack, degree, upper_follows));
          }
        }
      }
    }
  }
}

double stiffness_scale(const SparseMatrix& stiffness) {
  return SparseMatrix(stiffness.cwiseAbs()).diagonal().maxCoeff();
}

TEST(TiedSurfaces, PassLinearDisplacementsBetweenMeshesThatDoNotMatch) {
  for_each_stack(false, [](const TiedStack& stack) {
    const DisplacementSpace& space = stack.test->space;
    const int d = space.dimension;
    ASSERT_FALSE(stack.tied.empty());
    EXPECT_LT(stack.surface.farthest, 1e-8);
    Matrix gradient = Matrix::Random(d, d);
    const Vector exact = linear_field(space, gradient);
    Vector found = exact;
    stack.tied.complete(found, d);
    EXPECT_LT((found - exact).lpNorm<Eigen::Infinity>(), 1e-8);
    // A uniform stress is in equilibrium with its tractions on the outer sides, at every node.
    const SparseMatrix stiffness = stack.tied.condense(assemble_stiffness(stack.test->body, node_graph(space)), d);
    const Matrix strain = 0.5 * (gradient + gradient.transpose());
    const Material material = test_material();
    const Matrix stress = material.lambda() * strain.trace() * Matrix::Identity(d, d) + 2.0 * material.mu() * strain;
    Vector load = Vector::Zero(space.dof_count());
    for (const Group& group : stack.test->mesh.groups) {
      const char axis = d == 2 ? 'y' : 'z';
      const bool is_interface = group.name == std::string("lower.") + axis + "1" ||
                                group.name == std::string("upper.") + axis + "0" || group.name.ends_with("boundary");
      if (group.dimension != d - 1 || is_interface) continue;
      const Vector normal = measure_group(stack.test->mesh, group).mean_normal.head(d);
      add_facet_load(
          stack.test->body, group.members, [&](const Vector&, Vector& force) { force = stress * normal; }, load);
    }
    stack.tied.condense_load(load, d);
    EXPECT_LT((stiffness * exact - load).lpNorm<Eigen::Infinity>(), 1e-8 * stiffness_scale(stiffness));
  });
}

TEST(TiedSurfaces, HaveNoStrainInTurnsAlsoWhereTheyAreCurved) {
  for (const bool curved : {false, true}) {
    for_each_stack(curved, [](const TiedStack& stack) {
      const DisplacementSpace& space = stack.test->space;
      const int d = space.dimension;
      const SparseMatrix stiffness = stack.tied.condense(assemble_stiffness(stack.test->body, node_graph(space)), d);
      const Vector turn = linear_field(space, small_turn(d));
      EXPECT_LT((stiffness * turn).lpNorm<Eigen::Infinity>(), 1e-12 * stiffness_scale(stiffness));
      // The mass keeps its total, its centre and its inertia.
      const SparseMatrix before = assemble_scalar_mass(stack.test->body, node_graph(space));
      const SparseMatrix after = stack.tied.condense(before, 1);
      const Points moments = space.nodes * (before - after) * space.nodes.transpose();
      EXPECT_NEAR(after.sum(), before.sum(), 1e-13 * before.sum());
      EXPECT_LT(moments.cwiseAbs().maxCoeff(), 1e-12);
      for (const TiedNodes::Tie& tie : stack.tied.ties()) EXPECT_EQ(Vector(after.col(tie.node)).norm(), 0.0);
    });
  }
}

TEST(TiedSurfaces, OfMatchingMeshesHaveNodesThatFollowOneNode) {
  StackedBoxes stack{CellShape::quadrilateral, CellShape::quadrilateral, {4, 3}, {4, 2}};
  stack.distortion = 0.0;
  for (const int degree : {1, 2}) {
    const TiedStack tied = tie(stack, degree, true);
    EXPECT_EQ(tied.tied.ties().size(), degree == 1 ? 5U : 9U);
    for (const TiedNodes::Tie& tie : tied.tied.ties()) {
      int ones = 0;
      for (const auto& [node, weight] : tie.weights) {
        if (std::abs(weight) < 1e-12) continue;
        EXPECT_NEAR(weight, 1.0, 1e-12);
        ++ones;
      }
      EXPECT_EQ(ones, 1);
    }
  }
}

TEST(TiedSurfaces, RefuseNodesThatFollowEachOther) {
  EXPECT_THROW(TiedNodes({{0, {{1, 1.0}}}, {1, {{0, 1.0}}}}, 3), Error);
  const TiedNodes chain({{0, {{1, 0.5}, {2, 0.5}}}, {1, {{2, 1.0}}}}, 3);
  ASSERT_EQ(chain.ties()[0].weights.size(), 1U);
  EXPECT_EQ(chain.ties()[0].weights[0], (std::pair<Index, double>{2, 1.0}));
}

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

TEST(TiedSurfaces, AccountsCloseUnderEveryKindOfScheme) {
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
          Method{"scheme = \"cd-lagrange\"\nstep = 0.0015\n", "lumped"},
          Method{"scheme = \"semi-explicit\"\nstep = 0.001\n", "equivalent-lumped"}}) {
      for (const char* multipliers : {"nodal", "p1"}) {
        SCOPED_TRACE(std::string(method.time) + method.mass + multipliers + std::to_string(d));
        const auto run = std::make_unique<CaseRun>(halves_case(d, method.time, method.mass, multipliers));
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

TEST(TiedSurfaces, AreSolvedAlikeWithAndWithoutAFactor) {
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

}  // namespace
}  // namespace ricochet::test_support
