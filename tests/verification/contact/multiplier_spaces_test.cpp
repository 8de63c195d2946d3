#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "ricochet/contact/construction/make_contact_boundary.hpp"
#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "support/box_mesh.hpp"

/// @file The multiplier spaces: partition of unity, biorthogonality on curved facets, mean gaps, areas, pressures.
namespace ricochet::test_support::multiplier_spaces_test {

struct SpaceCase {
  ElementKind kind;
  std::string multipliers;
  bool bent = false;

  [[nodiscard]] std::string label() const { return multipliers + (bent ? ", bent" : ", flat"); }
};

std::vector<SpaceCase> space_cases(const ElementKind& kind) {
  std::vector<SpaceCase> cases;
  for (const std::string& name : multiplier_space_names()) {
    for (const bool bent : {false, true}) cases.push_back({kind, name, bent});
  }
  return cases;
}

const FreeComponent all_free = [](Index, int) { return true; };

std::unique_ptr<Obstacle> tilted_plane(int dimension) {
  const Vector point = Vector::Constant(dimension, -0.3);
  const Vector normal = Vector::LinSpaced(dimension, 0.2, 1.0);
  return make_plane(point, normal);
}

/// A function of position without symmetries.
double wave(const Vector& x, int component) {
  double phase = 0.7 * component;
  for (Index k = 0; k < x.size(); ++k) phase += (1.3 + double(k)) * x[k];
  return std::sin(phase);
}

class SpaceTest : public testing::TestWithParam<ElementKind> {
 protected:
  void build(const SpaceCase& given) {
    const int d = given.kind.dimension();
    const std::vector<int> counts = d == 2 ? std::vector<int>{4, 3} : std::vector<int>{3, 2, 2};
    test_ = make_meshed_body(make_checked_box_mesh({given.kind.shape, counts, given.kind.geometry_degree, 0.15,
                                                    given.bent ? bend_map() : PointMap{}}),
                             given.kind.displacement_degree);
    obstacle_ = tilted_plane(d);
    // Two sides that meet in an edge, of one patch.
    patch_ = {&test_->body, {{0, side("y0")}, {1, side("x1")}}, {}};
    space_ = make_multiplier_space(given.multipliers, patch_);
    boundary_ = make_contact_boundary(
        test_->body, {pair("y0", side("y0"), given.multipliers), pair("x1", side("x1"), given.multipliers)}, all_free);
  }
  [[nodiscard]] std::vector<Index> side(const std::string& name) const {
    return test_->mesh.group(name, test_->mesh.dimension - 1).members;
  }
  [[nodiscard]] ContactPair pair(const std::string& name, const std::vector<Index>& facets,
                                 const std::string& multipliers) const {
    return {name, facets, "plane", obstacle_.get(), {0.3, 0.0}, multipliers};
  }
  /// Integral over the patch of a function of the facet's quadrature, which returns values per point.
  [[nodiscard]] double integral(const std::function<Vector(const FacetQuadrature&)>& values) const {
    const FacetIntegration integration(test_->body);
    FacetQuadrature quadrature;
    double sum = 0.0;
    for (const ContactPatch::Part& part : patch_.parts) {
      for (const Index facet : part.facets) {
        integration.evaluate(facet, quadrature);
        sum += quadrature.measure.dot(values(quadrature));
      }
    }
    return sum;
  }

  std::unique_ptr<MeshedBody> test_;
  std::unique_ptr<Obstacle> obstacle_;
  ContactPatch patch_;
  std::unique_ptr<MultiplierSpace> space_;
  ContactBoundary boundary_;
};

TEST_P(SpaceTest, TraceOfAUniformDisplacementIsItself) {
  for (const SpaceCase& given : space_cases(GetParam())) {
    SCOPED_TRACE(given.label());
    build(given);
    const Vector ones = Vector::Ones(test_->space.node_count());
    EXPECT_LE((boundary_.trace * ones - Vector::Ones(boundary_.size())).lpNorm<Eigen::Infinity>(), 1e-14);
    const int d = test_->mesh.dimension;
    const Vector shift = Vector::LinSpaced(d, 0.4, -0.9);
    const Vector displacement =
        ones.replicate(1, d).transpose().reshaped().cwiseProduct(shift.replicate(test_->space.node_count(), 1));
    const Vector gap = boundary_.rows->gap_operator * displacement;
    const Vector slip = boundary_.rows->tangential_trace * displacement;
    for (Index i = 0; i < boundary_.size(); ++i) {
      EXPECT_NEAR(gap[i], boundary_.rows->normals.col(i).dot(shift), 1e-14);
      const Vector expected = boundary_.rows->tangents[std::size_t(i)].transpose() * shift;
      EXPECT_LE((slip.segment(i * (d - 1), d - 1) - expected).lpNorm<Eigen::Infinity>(), 1e-14);
    }
  }
}

TEST_P(SpaceTest, WeightsSumToTheAreaAndAreThoseOfTheFunctions) {
  for (const SpaceCase& given : space_cases(GetParam())) {
    SCOPED_TRACE(given.label());
    build(given);
    const double area = integral([](const FacetQuadrature& q) { return Vector::Ones(q.measure.size()); });
    EXPECT_NEAR(boundary_.weights.sum(), area, 1e-13 * area);
    if (!space_->has_functions()) continue;
    EXPECT_GT(boundary_.weights.minCoeff(), 1e-3 * boundary_.weights.maxCoeff());
    // Σψ = 1 everywhere: a uniform pressure is in the space.
    const double deviation = integral([&](const FacetQuadrature& q) {
      FacetMultipliers functions;
      space_->evaluate(q, functions);
      return Vector((functions.values.colwise().sum().transpose().array() - 1.0).abs());
    });
    EXPECT_LE(deviation, 1e-13 * area);
  }
}

/// c_ij = (1/D_i) ∫ψ_i φ_j with the functions integrated here: for dual multipliers this is their biorthogonality to
/// the (transformed) basis, on curved facets too.
TEST_P(SpaceTest, TraceIsThatOfTheFunctions) {
  for (const SpaceCase& given : space_cases(GetParam())) {
    SCOPED_TRACE(given.label());
    build(given);
    if (!space_->has_functions()) continue;
    const bool facets = given.multipliers == "p0";
    const std::vector<Multiplier> stated = space_->multipliers();
    const std::vector<Multiplier> integrated =
        integrate_multipliers(*space_, facets ? MultiplierAnchor::facet : MultiplierAnchor::node);
    ASSERT_EQ(stated.size(), integrated.size());
    for (std::size_t i = 0; i < stated.size(); ++i) {
      EXPECT_EQ(stated[i].node, integrated[i].node);
      EXPECT_NEAR(stated[i].weight, integrated[i].weight, 1e-13 * stated[i].weight);
      Vector difference = Vector::Zero(test_->space.node_count());
      for (const auto& [node, value] : stated[i].trace) difference[node] += value;
      for (const auto& [node, value] : integrated[i].trace) difference[node] -= value;
      EXPECT_LE(difference.lpNorm<Eigen::Infinity>(), 1e-12) << i;
    }
  }
}

/// The gap of a point is the mean of the gap weighted with its multiplier, at any displacement.
TEST_P(SpaceTest, GapsAreMeansOfTheGap) {
  for (const SpaceCase& given : space_cases(GetParam())) {
    SCOPED_TRACE(given.label());
    build(given);
    const int d = test_->mesh.dimension;
    const Vector displacement = interpolate(test_->space, [&](const Vector& x) {
      Vector u(d);
      for (int k = 0; k < d; ++k) u[k] = wave(x, k);
      return u;
    });
    const Vector gap = boundary_.initial_gap + boundary_.rows->gap_operator * displacement;
    if (!space_->has_functions()) {
      for (Index i = 0; i < gap.size(); ++i) {
        const Index node = boundary_.nodes[std::size_t(i)];
        EXPECT_NEAR(gap[i], obstacle_->gap(test_->space.nodes.col(node) + displacement.segment(node * d, d)), 1e-14);
      }
      continue;
    }
    // Both sides summed over the points with arbitrary weights.
    const auto arbitrary = [](double anchor) { return std::cos(1.7 * anchor); };
    double found = 0.0;
    std::vector<Multiplier> multipliers = space_->multipliers();
    const double expected = integral([&](const FacetQuadrature& q) {
      FacetMultipliers functions;
      space_->evaluate(q, functions);
      Vector values = Vector::Zero(q.measure.size());
      for (Index point = 0; point < values.size(); ++point) {
        Vector x = q.positions.col(point);
        for (Index j = 0; j < q.node_count(); ++j) {
          x += (*q.displacement)(j, point) * displacement.segment(q.nodes[j] * d, d);
        }
        for (std::size_t a = 0; a < functions.anchors.size(); ++a) {
          values[point] +=
              arbitrary(double(functions.anchors[a])) * functions.values(Index(a), point) * obstacle_->gap(x);
        }
      }
      return values;
    });
    std::ranges::stable_sort(multipliers, [](const Multiplier& a, const Multiplier& b) {
      const auto key = [](const Multiplier& m) { return m.node >= 0 ? m.node : m.trace.front().first; };
      return std::pair(key(a), a.pair) < std::pair(key(b), b.pair);
    });
    for (Index i = 0; i < gap.size(); ++i) {
      const Multiplier& multiplier = multipliers[std::size_t(i)];
      const Index anchor = multiplier.node >= 0 ? multiplier.node : multiplier.facet;
      found += arbitrary(double(anchor)) * boundary_.weights[i] * gap[i];
    }
    const double size = integral([](const FacetQuadrature& q) { return Vector::Ones(q.measure.size()); });
    EXPECT_NEAR(found, expected, 1e-12 * size);
  }
}

TEST_P(SpaceTest, UniformPressureIsRecoveredAtEveryNode) {
  for (const SpaceCase& given : space_cases(GetParam())) {
    SCOPED_TRACE(given.label());
    build(given);
    const Vector pressure = boundary_.pressure_recovery * boundary_.weights;
    ASSERT_EQ(pressure.size(), Index(boundary_.nodes.size()));
    EXPECT_EQ(boundary_.unique_nodes().size(), boundary_.nodes.size());
    std::vector<Index> expected = side("y0");
    const std::vector<Index> other = side("x1");
    expected.insert(expected.end(), other.begin(), other.end());
    EXPECT_EQ(boundary_.nodes, facet_nodes(test_->space, expected));
    EXPECT_GE(Matrix(boundary_.pressure_recovery).minCoeff(), 0.0) << "no pull from a push";
    EXPECT_LE((pressure - Vector::Ones(pressure.size())).lpNorm<Eigen::Infinity>(), 1e-13);
  }
}

/// Reactions of a uniform pressure give its consistent nodal forces: Σ_i D_i c_ij = ∫φ_j.
TEST_P(SpaceTest, UniformPressureIsTransmittedExactly) {
  for (const SpaceCase& given : space_cases(GetParam())) {
    SCOPED_TRACE(given.label());
    build(given);
    const Vector forces = boundary_.trace.transpose() * boundary_.weights;
    const FacetIntegration integration(test_->body);
    FacetQuadrature quadrature;
    Vector expected = Vector::Zero(forces.size());
    for (const ContactPatch::Part& part : patch_.parts) {
      for (const Index facet : part.facets) {
        integration.evaluate(facet, quadrature);
        const Vector own = *quadrature.displacement * quadrature.measure;
        for (Index j = 0; j < own.size(); ++j) expected[quadrature.nodes[j]] += own[j];
      }
    }
    EXPECT_LE((forces - expected).lpNorm<Eigen::Infinity>(), 1e-13 * expected.lpNorm<Eigen::Infinity>());
  }
}

INSTANTIATE_TEST_SUITE_P(Elements, SpaceTest, testing::ValuesIn(all_element_kinds()),
                         [](const auto& info) { return info.param.label(); });

/// For degree 1 the dual basis gives the displacements of the nodes.
TEST(DualMultipliers, OfDegreeOneAreNodalForces) {
  for (const CellShape shape : all_cell_shapes()) {
    for (const int geometry : {1, 2}) {
      const int d = dimension(shape);
      const auto test =
          make_meshed_body(make_box_mesh({shape, std::vector<int>(std::size_t(d), 3), geometry, 0.15, bend_map()}), 1);
      const auto obstacle = tilted_plane(d);
      const auto build = [&](const std::string& multipliers) {
        const std::vector<Index> facets = test->mesh.group("boundary", d - 1).members;
        return make_contact_boundary(test->body, {{"boundary", facets, "plane", obstacle.get(), {}, multipliers}},
                                     all_free);
      };
      const ContactBoundary nodal = build("nodal");
      const ContactBoundary dual = build("dual");
      EXPECT_EQ(Matrix(nodal.rows->gap_operator), Matrix(dual.rows->gap_operator));
      EXPECT_EQ(Matrix(nodal.rows->tangential_trace), Matrix(dual.rows->tangential_trace));
      EXPECT_EQ(nodal.nodes, dual.nodes);
      EXPECT_LE((nodal.weights - dual.weights).norm(), 1e-14 * nodal.weights.norm());
      const Matrix recovery = nodal.pressure_recovery;
      EXPECT_LE((recovery - Matrix(dual.pressure_recovery)).norm(), 1e-13 * recovery.norm());
      // The gap of a curved facet is its mean instead of a nodal value, unless the nodes carry the geometry.
      const double difference = (nodal.initial_gap - dual.initial_gap).lpNorm<Eigen::Infinity>();
      EXPECT_EQ(difference == 0.0, geometry == 1);
    }
  }
}

/// A six-node triangle beside a nine-node quadrilateral, both curved: the edge between them is transformed in both.
TEST(DualMultipliers, AreBiorthogonalAcrossATriangleAndAQuadrilateral) {
  Mesh mesh;
  mesh.dimension = 3;
  mesh.degree = 2;
  mesh.nodes.resize(3, 12);
  mesh.nodes << 0, 1, 0, 1, 0.5, 0.05, 1.1, 0.5, 0.5, 1.8, 1.45, 1.4,  //
      0, 0, 1, 1, -0.1, 0.5, 0.5, 1.05, 0.5, 0.6, 0.85, 0.25,          //
      0, 0.1, 0, 0, 0.1, -0.05, 0.1, 0, 0.1, 0.2, 0.2, 0.2;
  mesh.node_tags.assign(12, 1);
  mesh.facets.push_back({CellShape::quadrilateral, 9, {0, 1, 2, 3, 4, 5, 6, 7, 8}, {1}});
  mesh.facets.push_back({CellShape::triangle, 6, {1, 9, 3, 10, 6, 11}, {2}});
  const DisplacementSpace space = make_displacement_space(mesh, 2);
  const Body body{&mesh, &space, PlaneState::strain, {}, {}};
  const ContactPatch patch{&body, {{0, {0, 1}}}, {}};
  const auto dual = make_multiplier_space("dual", patch);
  const std::vector<Multiplier> given = dual->multipliers();
  const std::vector<Multiplier> integrated = integrate_multipliers(*dual, MultiplierAnchor::node);
  ASSERT_EQ(given.size(), 12U);
  for (std::size_t i = 0; i < given.size(); ++i) {
    const bool transformed = given[i].node == 6 || given[i].node >= 10;
    EXPECT_EQ(given[i].trace.size(), transformed ? 3U : 1U);
    EXPECT_GT(given[i].weight, 0.0);
    EXPECT_NEAR(given[i].weight, integrated[i].weight, 1e-14);
    Vector difference = Vector::Zero(12);
    for (const auto& [node, value] : given[i].trace) difference[node] += value;
    for (const auto& [node, value] : integrated[i].trace) difference[node] -= value;
    EXPECT_LE(difference.lpNorm<Eigen::Infinity>(), 1e-13);
  }
}

/// Without the change of basis the weight of a vertex vanishes.
TEST(DualMultipliers, HavePositiveWeightsWhereNodalForcesHaveNone) {
  const auto test = make_meshed_body(make_box_mesh({CellShape::tetrahedron, {3, 3, 3}, 1, 0.0, {}}), 2);
  const auto obstacle = tilted_plane(3);
  const auto build = [&](const std::string& multipliers) {
    const std::vector<Index> facets = test->mesh.group("z0", 2).members;
    return make_contact_boundary(test->body, {{"z0", facets, "plane", obstacle.get(), {}, multipliers}}, all_free);
  };
  EXPECT_LE(build("nodal").weights.minCoeff(), 1e-16);
  // A corner vertex of one triangle of area A = 1/18 has (2/5 of a sixth of each of two edges' A/3) = 2A/15.
  EXPECT_NEAR(build("dual").weights.minCoeff(), 2.0 / 15.0 / 18.0, 1e-15);
}

}  // namespace ricochet::test_support::multiplier_spaces_test
