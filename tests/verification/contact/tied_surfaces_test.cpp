#include "ricochet/contact/mortar/tied_surfaces.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/fem/mesh_measures.hpp"
#include "support/two_bodies.hpp"

/// @file Surfaces tied with non-matching meshes: linear displacements pass, rotations cause no strain.
namespace ricochet::test_support::tied_surfaces_test {

struct TiedStack {
  std::unique_ptr<MeshedBody> test;
  TiedSurface surface;
  TiedNodes tied;
  double off_the_geometry = 0.0;
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
  result.off_the_geometry = move_tied_nodes(result.tied, result.test->mesh, result.test->space);
  return result;
}

/// Nodal displacements of a linear function, or of a small rotation.
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
            stack.both = skew_motion(d);
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
    EXPECT_LT(stack.surface.farthest_in_heights, 1e-8);
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

/// The last node of the upper side overhangs except for a part of its facet. A condition of its own would integrate
/// over this part alone, and P would have entries of the size 1/part.
TEST(TiedSurfaces, LeaveNodesFreeThatOverhang) {
  for (const double part : {0.5, 0.1, 0.01, 1e-3, 1e-5}) {
    for (const int degree : {1, 2}) {
      StackedBoxes stack{CellShape::quadrilateral, CellShape::quadrilateral, {5, 3}, {4, 2}};
      stack.distortion = 0.0;
      stack.upper_map = [part](const Vector& x) {
        return Vector(Eigen::Vector2d(x[0] * 4.0 / (3.0 + part), 1.0 + x[1]));
      };
      const TiedStack tied = tie(stack, degree, true);
      // For degree 2 the middle of the last facet overhangs, too, if less than half of it is covered.
      EXPECT_EQ(tied.surface.facing.uncovered, degree == 2 && part < 0.5 ? 2 : 1) << part;
      double largest = 0.0;
      for (const TiedNodes::Tie& tie : tied.tied.ties()) {
        double sum = 0.0;
        for (const auto& [node, weight] : tie.weights) sum += std::abs(weight);
        largest = std::max(largest, sum);
      }
      EXPECT_LT(largest, 4.0) << part << ' ' << degree;
      Vector exact = linear_field(tied.test->space, Matrix::Random(2, 2)), found = exact;
      tied.tied.complete(found, 2);
      EXPECT_LT((found - exact).lpNorm<Eigen::Infinity>(), 1e-8);
    }
  }
}

/// With degree 2 on straight edges, middle nodes leave the edges where the surface is curved: the space does not
/// contain rotations any more, and the caller is informed.
TEST(TiedSurfaces, TellWhereTurnsHaveStrain) {
  for (const int geometry_degree : {1, 2}) {
    for (const int degree : {1, 2}) {
      for (const double bulge : {0.0, 0.1}) {
        StackedBoxes stack{CellShape::triangle, CellShape::quadrilateral, {5, 3}, {7, 2}};
        stack.geometry_degree = geometry_degree;
        const auto rise = [bulge](const Vector& x) { return bulge * std::pow(x[0] - 0.4, 2); };
        stack.lower_map = [rise](const Vector& x) { return Vector(Eigen::Vector2d(x[0], x[1] * (1.0 + rise(x)))); };
        stack.upper_map = [rise](const Vector& x) {
          return Vector(Eigen::Vector2d(x[0], 1.0 + x[1] + (1.0 - x[1]) * rise(x)));
        };
        const TiedStack tied = tie(stack, degree, true);
        const bool strains = bulge > 0.0 && degree > geometry_degree;
        EXPECT_EQ(tied.off_the_geometry > 1e-6, strains) << geometry_degree << degree << bulge;
      }
    }
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

}  // namespace ricochet::test_support::tied_surfaces_test
