#include "ricochet/contact/construction/make_contact_boundary.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <set>

#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "support/box_mesh.hpp"
#include "support/errors.hpp"
#include "support/paths.hpp"

/// @file The contact boundary: supports on it, several groups and obstacles, friction, units, and refused cases.
namespace ricochet::test_support::contact_boundary_test {

const FreeComponent all_free = [](Index, int) { return true; };

std::unique_ptr<Obstacle> plane(const Vector& normal) {
  return make_plane(Vector::Constant(normal.size(), -0.5), normal);
}

std::unique_ptr<MeshedBody> box(CellShape shape, int degree, double scale = 1.0) {
  const int d = dimension(shape);
  const PointMap map = affine_map(scale * Matrix::Identity(d, d), Vector::Zero(d));
  return make_meshed_body(make_box_mesh({shape, std::vector<int>(std::size_t(d), 3), 1, 0.15, map}), degree);
}

ContactPair pair_of(const MeshedBody& test, const std::string& group, const Obstacle& obstacle,
                    const std::string& multipliers, FrictionLaw friction = {}) {
  return {group, test.mesh.group(group, test.mesh.dimension - 1).members, "plane", &obstacle, friction, multipliers};
}

std::string message_of(const MeshedBody& test, const std::vector<ContactPair>& pairs) {
  return test_support::message_of([&] { (void)make_contact_boundary(test.body, pairs, all_free); });
}

/// Holds a component of all nodes with x = 0.
FreeComponent held_at_x0(const MeshedBody& test, const std::vector<int>& components) {
  const Points& nodes = test.space.nodes;
  return [&nodes, components](Index node, int component) {
    return nodes(0, node) > 0.0 || std::ranges::find(components, component) == components.end();
  };
}

TEST(ContactBoundary, LeavesOutMultipliersThatSupportsHoldAlongTheNormal) {
  for (const CellShape shape : all_cell_shapes()) {
    for (const int degree : {1, 2}) {
      const auto test = box(shape, degree);
      const int d = test->mesh.dimension;
      const auto obstacle = plane(Vector::Unit(d, d - 1));
      const std::string side = d == 2 ? "y0" : "z0";
      const std::vector<Index> nodes = facet_nodes(test->space, test->mesh.group(side, d - 1).members);
      const auto is_held = [&](Index node) { return test->space.nodes(0, node) == 0.0; };
      const Index held = std::ranges::count_if(nodes, is_held);
      for (const std::string& multipliers : multiplier_space_names()) {
        SCOPED_TRACE(name(shape) + std::to_string(degree) + multipliers);
        Index reported = -1;
        const std::vector<ContactPair> pairs{pair_of(*test, side, *obstacle, multipliers)};
        const ContactBoundary free = make_contact_boundary(test->body, pairs, all_free, &reported);
        EXPECT_EQ(reported, 0);
        const ContactBoundary boundary =
            make_contact_boundary(test->body, pairs, held_at_x0(*test, {d - 1}), &reported);
        EXPECT_EQ(reported, held);
        // p1 has multipliers at vertices only; no facet is entirely held.
        const Index left_out = multipliers == "p0" ? 0 : multipliers == "p1" ? (d == 2 ? 1 : 4) : held;
        EXPECT_EQ(boundary.size(), free.size() - left_out);
        // The remaining multipliers are independent of the supports: W has full rank on the free nodes.
        Matrix trace = boundary.trace;
        for (const Index node : nodes) {
          if (is_held(node)) trace.col(node).setZero();
        }
        if (!instability(multipliers, facet_shape(shape, 0), degree).empty()) continue;
        EXPECT_EQ((trace * trace.transpose()).llt().info(), Eigen::Success);
        EXPECT_GT((trace * trace.transpose()).ldlt().vectorD().minCoeff(), 1e-4);
      }
    }
  }
}

TEST(ContactBoundary, LeavesOutFacetsAllOfWhoseNodesAreHeld) {
  const auto test = box(CellShape::quadrilateral, 1);
  const auto obstacle = plane(Vector::Unit(2, 1));
  const FreeComponent is_free = [&](Index node, int k) { return k == 0 || test->space.nodes(0, node) > 0.5; };
  const ContactBoundary boundary = make_contact_boundary(test->body, {pair_of(*test, "y0", *obstacle, "p0")}, is_free);
  EXPECT_EQ(boundary.size(), 2);         // of three facets
  EXPECT_EQ(boundary.nodes.size(), 3U);  // excludes the end that only the held facet has
}

TEST(ContactBoundary, HasNoFrictionWhereSupportsLeaveNoIndependentSlipIn2D) {
  const auto test = box(CellShape::triangle, 1);
  const auto obstacle = plane(Eigen::Vector2d(0.6, 0.8));
  for (const int held : {0, 1}) {
    const ContactBoundary boundary =
        make_contact_boundary(test->body, {pair_of(*test, "y0", *obstacle, "nodal")}, held_at_x0(*test, {held}));
    ASSERT_EQ(boundary.size(), 4);
    for (Index i = 0; i < boundary.size(); ++i) {
      const bool at_support = test->space.nodes(0, boundary.nodes[std::size_t(i)]) == 0.0;
      EXPECT_EQ(boundary.rows->tangential_trace.row(i).nonZeros(), at_support ? 0 : 2);
      EXPECT_EQ(boundary.rows->gap_operator.row(i).nonZeros(), 2);
    }
  }
}

TEST(ContactBoundary, KeepsTheSlipThatOneHeldComponentLeavesIn3D) {
  const auto test = box(CellShape::hexahedron, 1);
  const Vector normal = Eigen::Vector3d(0.3, -0.4, 1.2).normalized();
  const auto obstacle = plane(normal);
  for (const std::vector<int>& held : {std::vector<int>{0}, {1}, {2}, {0, 1}, {1, 2}}) {
    const ContactBoundary boundary =
        make_contact_boundary(test->body, {pair_of(*test, "z0", *obstacle, "dual")}, held_at_x0(*test, held));
    ASSERT_EQ(boundary.size(), 16);
    for (Index i = 0; i < boundary.size(); ++i) {
      Matrix frame(3, 3);
      frame << boundary.rows->normals.col(i), boundary.rows->tangents[std::size_t(i)];
      EXPECT_LE((frame.transpose() * frame - Matrix::Identity(3, 3)).norm(), 1e-15 * 8);
      const bool at_support = test->space.nodes(0, boundary.nodes[std::size_t(i)]) == 0.0;
      const bool one = at_support && held.size() == 1;
      const double along_held_axis = one ? frame(held.front(), 1) : 0.0;
      EXPECT_EQ(along_held_axis, 0.0);
      EXPECT_EQ(boundary.rows->tangential_trace.row(2 * i).nonZeros(), !at_support || one ? 3 : 0);
      EXPECT_EQ(boundary.rows->tangential_trace.row(2 * i + 1).nonZeros(), at_support ? 0 : 3);
    }
  }
}

/// For any supports on a side that bounds the contact boundary, H = [G; B_T] has full rank on the free dofs, so that
/// the condensed operator is positive definite.
TEST(ContactBoundary, HasIndependentConditionsWhateverIsHeld) {
  for (const CellShape shape : all_cell_shapes()) {
    for (const int degree : {1, 2}) {
      const auto test = box(shape, degree);
      const int d = test->mesh.dimension;
      const auto obstacle = plane(d == 2 ? Vector(Eigen::Vector2d(0.6, 0.8)) : Vector(Eigen::Vector3d(0.3, -0.4, 1.2)));
      for (const std::string& multipliers : multiplier_space_names()) {
        if (!instability(multipliers, facet_shape(shape, 0), degree).empty()) continue;
        for (int mask = 0; mask < (1 << d); ++mask) {
          SCOPED_TRACE(name(shape) + std::to_string(degree) + multipliers + " held " + std::to_string(mask));
          std::vector<int> held;
          for (int k = 0; k < d; ++k) {
            if ((mask >> k & 1) != 0) held.push_back(k);
          }
          const FreeComponent is_free = held_at_x0(*test, held);
          const ContactBoundary boundary = make_contact_boundary(
              test->body, {pair_of(*test, d == 2 ? "y0" : "z0", *obstacle, multipliers)}, is_free);
          Matrix rows(boundary.size() * d, test->space.dof_count());
          rows << Matrix(boundary.rows->gap_operator), Matrix(boundary.rows->tangential_trace);
          for (Index dof = 0; dof < rows.cols(); ++dof) {
            if (!is_free(dof / d, int(dof % d))) rows.col(dof).setZero();
          }
          std::vector<Index> used;
          for (Index row = 0; row < rows.rows(); ++row) {
            if (row < boundary.size() || boundary.rows->tangential_trace.row(row - boundary.size()).nonZeros() > 0) {
              used.push_back(row);
            }
          }
          const Matrix conditions = rows(used, Eigen::all);
          const Eigen::SelfAdjointEigenSolver<Matrix> eigen(conditions * conditions.transpose(),
                                                            Eigen::EigenvaluesOnly);
          EXPECT_GT(eigen.eigenvalues()[0], 1e-3 * eigen.eigenvalues().tail(1)[0]);
        }
      }
    }
  }
}

TEST(ContactBoundary, GivesAFacetTheFrictionOfItsFreestNode) {
  const auto test = box(CellShape::quadrilateral, 2);
  const auto obstacle = plane(Vector::Unit(2, 1));
  const ContactBoundary boundary =
      make_contact_boundary(test->body, {pair_of(*test, "y0", *obstacle, "p0")}, held_at_x0(*test, {0}));
  for (Index i = 0; i < boundary.size(); ++i) EXPECT_EQ(boundary.rows->tangential_trace.row(i).nonZeros(), 6);
}

TEST(ContactBoundary, JoinsGroupsThatShareAnObstacle) {
  for (const std::string& multipliers : multiplier_space_names()) {
    SCOPED_TRACE(multipliers);
    const auto test = box(CellShape::quadrilateral, 2);
    const auto floor = plane(Vector::Unit(2, 1));
    const auto wall = plane(Vector::Unit(2, 0));
    const ContactBoundary boundary =
        make_contact_boundary(test->body,
                              {pair_of(*test, "y0", *floor, multipliers), pair_of(*test, "x0", *wall, multipliers),
                               pair_of(*test, "x1", *floor, multipliers)},
                              all_free);
    // Each corner once per obstacle: (0,0) twice.
    EXPECT_EQ(boundary.nodes.size(), 7U + 7U + 7U - 1U);
    EXPECT_EQ(boundary.unique_nodes().size(), 7U + 7U + 7U - 2U);
    EXPECT_TRUE(std::ranges::is_sorted(boundary.nodes));
    EXPECT_NEAR(boundary.weights.sum(), 3.0, 1e-14);
    const std::set<int> used(boundary.pair.begin(), boundary.pair.end());
    EXPECT_EQ(used, (std::set<int>{0, 1, 2}));
    const Vector pressure = boundary.pressure_recovery * boundary.weights;
    EXPECT_LE((pressure.array() - 1.0).abs().maxCoeff(), 1e-13);
    for (std::size_t k = 0; k < boundary.nodes.size(); ++k) {
      const auto row = Index(k);
      const int axis = boundary.node_pair[k] == 1 ? 0 : 1;
      EXPECT_EQ(Vector(boundary.node_normals.col(row)), Vector(Vector::Unit(2, axis)));
      EXPECT_EQ(boundary.node_initial_gap[row], test->space.nodes(axis, boundary.nodes[k]) + 0.5);
    }
  }
}

TEST(ContactBoundary, TakesFrictionPerFacetOrPerNode) {
  const auto test = box(CellShape::quadrilateral, 2);
  const auto floor = plane(Vector::Unit(2, 1));
  const auto with = [&](const std::string& multipliers) {
    return std::vector<ContactPair>{pair_of(*test, "y0", *floor, multipliers, {0.3, 0.0}),
                                    pair_of(*test, "x1", *floor, multipliers, {0.0, 7.0})};
  };
  for (const std::string multipliers : {"nodal", "p1", "dual"}) {
    EXPECT_TRUE(has(message_of(*test, with(multipliers)), "share a node against obstacle \"plane\" with different"));
  }
  const ContactBoundary boundary = make_contact_boundary(test->body, with("p0"), all_free);
  ASSERT_EQ(boundary.size(), 6);
  EXPECT_TRUE(boundary.has_friction());
  for (Index i = 0; i < boundary.size(); ++i) {
    const bool tresca = boundary.pair[std::size_t(i)] == 1;
    EXPECT_EQ(boundary.friction_coefficient[i], tresca ? 0.0 : 0.3);
    EXPECT_EQ(boundary.friction_bound[i], tresca ? 7.0 * boundary.weights[i] : 0.0);
  }
}

TEST(ContactBoundary, RefusesWhatIsNotDetermined) {
  const auto test = box(CellShape::quadrilateral, 1);
  const auto floor = plane(Vector::Unit(2, 1));
  const auto other = plane(Eigen::Vector2d(0.0, 2.0));
  const auto wall = plane(Vector::Unit(2, 0));
  const auto ceiling = plane(-Vector::Unit(2, 1));
  for (const std::string& multipliers : multiplier_space_names()) {
    EXPECT_EQ(message_of(*test, {pair_of(*test, "y0", *floor, multipliers), pair_of(*test, "x0", *wall, multipliers)}),
              "");
    // Dependent conditions still determine one motion; friction on two coinciding planes does not.
    EXPECT_EQ(
        message_of(*test, {pair_of(*test, "y0", *floor, multipliers), pair_of(*test, "x0", *other, multipliers),
                           pair_of(*test, "y0", *wall, multipliers), pair_of(*test, "y0", *ceiling, multipliers)}),
        "");
    const auto rubbing = [&](const FrictionLaw& one, const FrictionLaw& two) {
      return message_of(
          *test, {pair_of(*test, "y0", *floor, multipliers, one), pair_of(*test, "x0", *other, multipliers, two)});
    };
    EXPECT_TRUE(has(rubbing({0.3, 0.0}, {0.2, 0.0}), "are the same surface at the node at ("));
    EXPECT_TRUE(has(rubbing({0.3, 0.0}, {}), "different friction or motion"));
    EXPECT_EQ(rubbing({0.3, 0.0}, {0.3, 0.0}), "");
  }
  EXPECT_TRUE(has(message_of(*test, {pair_of(*test, "y0", *floor, "p1"), pair_of(*test, "x0", *floor, "dual")}),
                  "different multipliers"));
  EXPECT_EQ(message_of(*test, {pair_of(*test, "y0", *floor, "p1"), pair_of(*test, "x0", *wall, "dual")}), "");
  const std::string unknown = message_of(*test, {pair_of(*test, "y0", *floor, "p3")});
  EXPECT_TRUE(has(unknown, "unknown multipliers \"p3\"; known: "));
}

/// Contact points and entries of a row of the trace on a flat side of 8 squares or 8 × 8: prints and checks the table
/// of docs/multipliers.md.
TEST(ContactBoundary, HasTheSizesOfThePage) {
  std::ifstream page(source_path("docs/multipliers.md"));
  const std::string text{std::istreambuf_iterator<char>(page), std::istreambuf_iterator<char>()};
  for (const CellShape shape : {CellShape::quadrilateral, CellShape::tetrahedron, CellShape::hexahedron}) {
    for (const int degree : {1, 2}) {
      const int d = dimension(shape);
      std::vector<int> counts(static_cast<std::size_t>(d), 8);
      counts.back() = 1;
      const auto test = make_meshed_body(make_box_mesh({shape, counts, 1, 0.1, {}}), degree);
      const auto floor = plane(Vector::Unit(d, d - 1));
      std::string row = "| " + name(facet_shape(shape, 0)) + "s, degree " + std::to_string(degree) + " |";
      for (const std::string& multipliers : multiplier_space_names()) {
        const ContactBoundary boundary =
            make_contact_boundary(test->body, {pair_of(*test, d == 2 ? "y0" : "z0", *floor, multipliers)}, all_free);
        char entry[64];
        std::snprintf(entry, sizeof entry, " %d × %.1f |", int(boundary.size()),
                      double(boundary.trace.nonZeros()) / double(boundary.size()));
        row += entry;
      }
      std::printf("%s\n", row.c_str());
      EXPECT_TRUE(has(text, row + "\n")) << "docs/multipliers.md has no row " << row;
    }
  }
}

/// A length unit that differs by a power of two gives the same bits.
TEST(ContactBoundary, HasNoUnit) {
  for (const CellShape shape : all_cell_shapes()) {
    const int d = dimension(shape);
    const double scale = 1024.0;
    const auto one = box(shape, 2);
    const auto other = box(shape, 2, scale);
    const Vector normal = Vector::LinSpaced(d, 0.2, 1.0);
    const auto small = make_plane(Vector::Constant(d, -0.5), normal);
    const auto large = make_plane(Vector::Constant(d, -0.5 * scale), normal);
    for (const std::string& multipliers : multiplier_space_names()) {
      SCOPED_TRACE(name(shape) + multipliers);
      const ContactBoundary a =
          make_contact_boundary(one->body, {pair_of(*one, "boundary", *small, multipliers, {0.0, 1.0})}, all_free);
      const ContactBoundary b =
          make_contact_boundary(other->body, {pair_of(*other, "boundary", *large, multipliers, {0.0, 1.0})}, all_free);
      const double area = std::pow(scale, d - 1);
      EXPECT_EQ(Matrix(a.rows->gap_operator), Matrix(b.rows->gap_operator));
      EXPECT_EQ(Matrix(a.rows->tangential_trace), Matrix(b.rows->tangential_trace));
      EXPECT_EQ(a.initial_gap * scale, b.initial_gap);
      EXPECT_EQ(a.rows->gap_rounding * scale, b.rows->gap_rounding);
      EXPECT_EQ(a.weights * area, b.weights);
      EXPECT_EQ(a.friction_bound * area, b.friction_bound);
      EXPECT_EQ(Matrix(a.pressure_recovery), Matrix(area * b.pressure_recovery));
    }
  }
}

}  // namespace ricochet::test_support::contact_boundary_test
