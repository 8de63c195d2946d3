#include "ricochet/contact/mortar/body_contact.hpp"
#include "ricochet/contact/construction/make_contact_boundary.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "support/two_bodies.hpp"

/// @file Contact rows between two bodies with non-matching meshes: a uniform pressure passes, rows sum to zero, mean
/// gap vectors are along the normals.
namespace ricochet::test_support::body_contact_test {

const FreeComponent all_free = [](Index, int) { return true; };

struct Pairing {
  CellShape lower, upper;
  int degree;
  bool upper_carries;

  [[nodiscard]] std::string label(const std::string& multipliers) const {
    return name(lower) + name(upper) + std::to_string(degree) + multipliers + (upper_carries ? "upper" : "lower");
  }
  /// Returns the upper body with half the width, beginning at `offset` of the lower one.
  [[nodiscard]] StackedBoxes narrow_on_wide(double offset) const {
    const int d = dimension(lower);
    StackedBoxes stack{lower, upper, {4, 3}, {3, 2}};
    if (d == 3) stack.lower_counts = {4, 4, 1}, stack.upper_counts = {3, 2, 1};
    stack.upper_map = [d, offset](const Vector& x) {
      Vector y = offset * Vector::Ones(d) + 0.5 * x;
      y[d - 1] = 1.0 + x[d - 1];
      return y;
    };
    stack.both = skew_motion(d);
    return stack;
  }
};

std::vector<Pairing> all_pairings() {
  std::vector<Pairing> result;
  for (const auto& shapes : {std::vector{CellShape::triangle, CellShape::quadrilateral},
                             std::vector{CellShape::tetrahedron, CellShape::hexahedron}}) {
    for (const CellShape lower : shapes) {
      for (const CellShape upper : shapes) {
        for (const int degree : {1, 2}) {
          for (const bool upper_carries : {true, false}) result.push_back({lower, upper, degree, upper_carries});
        }
      }
    }
  }
  return result;
}

std::string last_axis(int d, const char* end) { return std::string(d == 2 ? "y" : "z") + end; }

ContactPair pair_of(const MeshedBody& test, bool upper_carries, const std::string& multipliers) {
  const int d = test.mesh.dimension;
  ContactPair pair;
  pair.group = "lower." + last_axis(d, "1");
  pair.opposite_group = "upper." + last_axis(d, "0");
  if (upper_carries) std::swap(pair.group, pair.opposite_group);
  pair.facets = test.mesh.group(pair.group, d - 1).members;
  pair.opposite_facets = test.mesh.group(pair.opposite_group, d - 1).members;
  pair.multipliers = multipliers;
  return pair;
}

/// Integrals ∫φ_j over facets.
Vector integrals(const MeshedBody& test, const std::vector<Index>& facets) {
  Vector result = Vector::Zero(test.space.node_count());
  const FacetIntegration integration(test.body);
  FacetQuadrature quadrature;
  for (const Index facet : facets) {
    integration.evaluate(facet, quadrature);
    const Vector own = *quadrature.displacement * quadrature.measure;
    for (Index k = 0; k < own.size(); ++k) result[quadrature.nodes[k]] += own[k];
  }
  return result;
}

/// Nodal forces of a uniform pressure 1 on both sides: Σ D_i c_ij at own nodes, −Σ D_i m_ik at opposite ones.
Vector forces_of_pressure(const ContactBoundary& boundary) { return boundary.trace.transpose() * boundary.weights; }

double tolerance_of(const MeshedBody& test) {
  const bool simplices = std::ranges::all_of(
      test.mesh.facets, [](const CellBlock& block) { return block.shape != CellShape::quadrilateral; });
  return simplices ? 1e-13 : 1e-9;
}

TEST(BodyContact, PassesAUniformPressureBetweenMeshesThatDoNotMatch) {
  for (const Pairing& p : all_pairings()) {
    const int d = dimension(p.lower);
    StackedBoxes stack{p.lower, p.upper, {5, 3}, {7, 2}};
    if (d == 3) stack.lower_counts = {3, 2, 2}, stack.upper_counts = {2, 4, 1};
    stack.both = skew_motion(d);
    const auto test = make_meshed_body(make_stack(stack), p.degree);
    for (const std::string& multipliers : multiplier_space_names()) {
      if (multipliers == "nodal") continue;
      SCOPED_TRACE(p.label(multipliers));
      const ContactPair pair = pair_of(*test, p.upper_carries, multipliers);
      std::vector<PairingSummary> facings;
      const ContactBoundary boundary = make_contact_boundary(test->body, {pair}, all_free, nullptr, &facings);
      const Vector expected = integrals(*test, pair.facets) - integrals(*test, pair.opposite_facets);
      const Vector found = forces_of_pressure(boundary);
      const double largest = expected.lpNorm<Eigen::Infinity>();
      EXPECT_LT((found - expected).lpNorm<Eigen::Infinity>(), tolerance_of(*test) * largest);
      EXPECT_EQ(facings[0].uncovered, 0);
      EXPECT_NEAR(facings[0].covered, facings[0].area, 1e-9);
      // Rows sum to zero; the gap is that between the planes, which touch.
      const Vector sums = boundary.trace * Vector::Ones(test->space.node_count());
      EXPECT_LT(sums.lpNorm<Eigen::Infinity>(), 1e-13);
      EXPECT_LT(boundary.initial_gap.lpNorm<Eigen::Infinity>(), 1e-14);
      EXPECT_TRUE((boundary.net.array() == 0.0).all());
      EXPECT_GT(boundary.weights.minCoeff(), 0.0);
      // The pressure on both sides, recovered from uniform reactions.
      const Vector pressure = boundary.pressure_recovery * boundary.weights;
      EXPECT_LT((pressure.array() - 1.0).abs().maxCoeff(), 1e-12);
      EXPECT_EQ(pressure.size(), Index(facet_nodes(test->space, pair.facets).size() +
                                       facet_nodes(test->space, pair.opposite_facets).size()));
      EXPECT_LT(boundary.node_initial_gap.lpNorm<Eigen::Infinity>(), 1e-13);
    }
  }
}

/// A narrow body on a wide one whose mesh has edges at its ends: the covered part can be integrated.
TEST(BodyContact, PassesAUniformPressureWhereOnlyAPartIsCovered) {
  for (const Pairing& p : all_pairings()) {
    const int d = dimension(p.lower);
    StackedBoxes stack = p.narrow_on_wide(0.25);
    stack.distortion = 0.0;
    const PointMap turn = stack.both;
    const auto test = make_meshed_body(make_stack(stack), p.degree);
    for (const std::string& multipliers : multiplier_space_names()) {
      if (multipliers == "nodal") continue;
      SCOPED_TRACE(p.label(multipliers));
      const ContactPair pair = pair_of(*test, p.upper_carries, multipliers);
      const ContactBoundary boundary = make_contact_boundary(test->body, {pair}, all_free);
      const auto& wide = p.upper_carries ? pair.opposite_facets : pair.facets;
      const auto& narrow = p.upper_carries ? pair.facets : pair.opposite_facets;
      std::vector<Index> inside;
      const Vector low = turn(Vector::Zero(d));
      for (const Index facet : wide) {
        const IndexInBlocks place = locate_in_blocks(test->mesh.facets, facet);
        const CellBlock& block = test->mesh.facets[place.block];
        Vector centre = Vector::Zero(d);
        for (int k = 0; k < block.nodes_per_cell; ++k)
          centre += test->mesh.nodes.col(block.cell(place.local)[k]) / block.nodes_per_cell;
        bool is_inside = true;
        for (int k = 0; k < d - 1; ++k) {
          const double at = (turn(Vector::Unit(d, k)) - low).dot(centre - low);
          is_inside = is_inside && at > 0.25 && at < 0.75;
        }
        if (is_inside) inside.push_back(facet);
      }
      const double sign = p.upper_carries ? 1.0 : -1.0;
      const Vector expected = sign * (integrals(*test, narrow) - integrals(*test, inside));
      const Vector found = forces_of_pressure(boundary);
      EXPECT_LT((found - expected).lpNorm<Eigen::Infinity>(), tolerance_of(*test) * expected.lpNorm<Eigen::Infinity>());
      EXPECT_GT(boundary.weights.minCoeff(), 0.0);
      EXPECT_NEAR(boundary.weights.sum(), d == 2 ? 0.5 : 0.25, 1e-12);
    }
  }
}

/// The narrow body ends within facets of the wide one. Multipliers sum to 1 wherever there is cover, so the forces on
/// the narrow side are those of a uniform pressure, and those on the wide side have its resultant and moment.
TEST(BodyContact, PassesAUniformPressureWhereFacetsAreCoveredInPart) {
  for (const Pairing& p : all_pairings()) {
    const StackedBoxes stack = p.narrow_on_wide(0.31);
    const auto test = make_meshed_body(make_stack(stack), p.degree);
    for (const std::string& multipliers : multiplier_space_names()) {
      if (multipliers == "nodal") continue;
      SCOPED_TRACE(p.label(multipliers));
      const ContactPair pair = pair_of(*test, p.upper_carries, multipliers);
      const ContactBoundary boundary = make_contact_boundary(test->body, {pair}, all_free);
      EXPECT_GT(boundary.weights.minCoeff(), 0.0);
      const double tolerance = tolerance_of(*test);
      const Vector narrow = integrals(*test, p.upper_carries ? pair.facets : pair.opposite_facets);
      const Vector force = (p.upper_carries ? 1.0 : -1.0) * forces_of_pressure(boundary);
      Vector on_narrow = force, on_wide = force;
      for (Index node = 0; node < force.size(); ++node) (narrow[node] != 0.0 ? on_wide : on_narrow)[node] = 0.0;
      EXPECT_LT((on_narrow - narrow).lpNorm<Eigen::Infinity>(), tolerance * narrow.lpNorm<Eigen::Infinity>());
      EXPECT_NEAR(on_wide.sum(), -narrow.sum(), tolerance);
      EXPECT_LT((test->space.nodes * (on_wide + narrow)).lpNorm<Eigen::Infinity>(), 10.0 * tolerance);
    }
  }
}

/// Curved, tilted, separated: the mean gap vector of each point is along its normal, so that forces along it have no
/// moment.
TEST(BodyContact, HasMeanGapVectorsAlongTheNormals) {
  for (const Pairing& p : all_pairings()) {
    const int d = dimension(p.lower);
    for (const int geometry : {1, 2}) {
      if (p.degree < geometry) continue;
      StackedBoxes stack{p.lower, p.upper, {5, 3}, {7, 2}};
      if (d == 3) stack.lower_counts = {3, 2, 2}, stack.upper_counts = {2, 4, 1};
      stack.geometry_degree = geometry;
      stack.lower_map = [d](const Vector& x) {
        Vector y = x;
        y[d - 1] += x[d - 1] * (0.3 * std::pow(x[0] - 0.4, 2) - 0.05 * x[0] * (d == 3 ? x[1] : 1.0));
        return y;
      };
      stack.upper_map = [d](const Vector& x) {
        Vector y = x;
        y[0] += 0.13;
        y[d - 1] += 1.2 - (1.0 - x[d - 1]) * 0.2 * std::pow(x[0] - 0.6, 2);
        return y;
      };
      stack.both = skew_motion(d);
      const auto test = make_meshed_body(make_stack(stack), p.degree);
      for (const std::string& multipliers : multiplier_space_names()) {
        SCOPED_TRACE(p.label(multipliers));
        const ContactBoundary boundary =
            make_contact_boundary(test->body, {pair_of(*test, p.upper_carries, multipliers)}, all_free);
        ASSERT_GT(boundary.size(), 3);
        for (Index i = 0; i < boundary.size(); ++i) {
          const Vector normal = boundary.rows->normals.col(i);
          EXPECT_NEAR(normal.norm(), 1.0, 1e-14);
          EXPECT_LT((boundary.arm(i, test->space.nodes) - boundary.initial_gap[i] * normal).norm(), 2e-14);
          EXPECT_GT(boundary.initial_gap[i], 0.05);
        }
        const Vector sums = boundary.trace * Vector::Ones(test->space.node_count());
        EXPECT_LT(sums.lpNorm<Eigen::Infinity>(), 1e-13);
      }
    }
  }
}

}  // namespace ricochet::test_support::body_contact_test
