#include "ricochet/fem/stress.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <span>

#include "ricochet/fem/nodal_recovery.hpp"
#include "support/box_mesh.hpp"

/// @file Stress of cells, its recovery at the nodes, and strain energy.
namespace ricochet::test_support::stress_test {

struct StressCase {
  ElementKind kind;
  PlaneState plane = PlaneState::strain;
};

std::unique_ptr<MeshedBody> curved_body(const StressCase& test, int count = 3) {
  BoxMesh box;
  box.shape = test.kind.shape;
  box.counts.assign(std::size_t(test.kind.dimension()), count);
  box.geometry_degree = test.kind.geometry_degree;
  if (test.kind.contains_affine()) box.map = swirl_map(0.05);
  return make_meshed_body(make_box_mesh(box), test.kind.displacement_degree, test.plane);
}

std::vector<StressCase> stress_cases() {
  std::vector<StressCase> cases;
  for (const ElementKind& kind : all_element_kinds()) {
    cases.push_back({kind, PlaneState::strain});
    if (kind.dimension() == 2) cases.push_back({kind, PlaneState::stress});
  }
  return cases;
}

class StressTest : public testing::TestWithParam<StressCase> {};

/// Hooke's law in terms of E and ν; in the plane with ε_zz, or σ_zz, kept at zero.
TEST_P(StressTest, OfAnAffineDisplacement) {
  const int d = GetParam().kind.dimension();
  const auto body = curved_body(GetParam());
  Matrix h(3, 3);
  h << 0.31, -0.12, 0.07, 0.45, -0.23, 0.11, -0.19, 0.05, 0.28;
  const Matrix gradient = h.topLeftCorner(d, d);
  const Vector displacement = interpolate(body->space, affine_map(gradient, Vector::LinSpaced(d, 0.4, -0.9)));
  const Material material = test_material();
  const double nu = material.poisson(), young = material.young();
  Eigen::Matrix3d strain = Eigen::Matrix3d::Zero();
  strain.topLeftCorner(d, d) = 0.5 * (gradient + gradient.transpose());
  if (GetParam().plane == PlaneState::stress) strain(2, 2) = -nu / (1.0 - nu) * strain.trace();
  const Eigen::Matrix3d stress =
      young / (1.0 + nu) * (strain + nu / (1.0 - 2.0 * nu) * strain.trace() * Eigen::Matrix3d::Identity());
  const double energy = 0.5 * (stress.array() * strain.array()).sum();
  const double size = stress.cwiseAbs().maxCoeff();

  std::vector<double> found, density;
  CellStress(body->body).evaluate(displacement, found, density);
  ASSERT_EQ(Index(density.size()), body->mesh.cell_count());
  const Eigen::Matrix3d deviator = stress - stress.trace() / 3.0 * Eigen::Matrix3d::Identity();
  for (std::size_t cell = 0; cell < density.size(); ++cell) {
    const double* s = found.data() + 6 * cell;
    const double expected[] = {stress(0, 0), stress(0, 1), stress(0, 2), stress(1, 1), stress(1, 2), stress(2, 2)};
    for (int k = 0; k < 6; ++k) ASSERT_NEAR(s[k], expected[k], 1e-12 * size) << k;
    ASSERT_NEAR(density[cell], energy, 1e-12 * energy);
    ASSERT_NEAR(von_mises_stress(s), std::sqrt(1.5) * deviator.norm(), 1e-12 * size);
    const std::array<double, 3> principal = principal_stresses(s);
    ASSERT_GE(principal[0], principal[1]);
    ASSERT_GE(principal[1], principal[2]);
    ASSERT_NEAR(principal[0] + principal[1] + principal[2], stress.trace(), 1e-12 * size);
    ASSERT_NEAR(principal[0] * principal[1] * principal[2], stress.determinant(), 1e-12 * size * size * size);
  }
}

/// Σ density × volume = ½UᵀKU for any displacement.
TEST_P(StressTest, EnergyDensitiesAddUpToTheStrainEnergy) {
  const auto body = curved_body(GetParam());
  const SparseMatrix stiffness = assemble_stiffness(body->body, node_graph(body->space));
  std::srand(5);
  const Vector displacement = Vector::Random(body->space.dof_count());
  std::vector<double> stress, density;
  CellStress(body->body).evaluate(displacement, stress, density);
  const Vector volumes = cell_volumes(body->body);
  const double sum = volumes.dot(Eigen::Map<const Vector>(density.data(), volumes.size()));
  const double energy = 0.5 * displacement.dot(stiffness * displacement);
  EXPECT_NEAR(sum, energy, 1e-13 * energy);
  Vector von_mises(body->mesh.cell_count());
  for (Index i = 0; i < von_mises.size(); ++i) von_mises[i] = von_mises_stress(stress.data() + 6 * i);
  const LargestOfCells largest = CellStress(body->body).largest_von_mises(displacement);
  EXPECT_EQ(largest.value, von_mises.maxCoeff());
  EXPECT_EQ(von_mises[largest.cell], largest.value);
}

/// A linear function sampled at the cell centres is recovered at every node, corners included.
TEST_P(StressTest, RecoveryIsExactForLinearFunctions) {
  const auto body = curved_body(GetParam());
  const int d = GetParam().kind.dimension();
  const Vector slope = Vector::LinSpaced(d, 1.3, -0.7);
  const NodalRecovery recovery = make_nodal_recovery(body->body);
  Vector samples(body->mesh.cell_count());
  Index cell = 0;
  for (const CellBlock& block : body->space.cells) {
    for (Index i = 0; i < block.size(); ++i, ++cell) {
      Vector centre = Vector::Zero(d);
      for (int k = 0; k < block.nodes_per_cell; ++k) centre += body->space.nodes.col(block.cell(i)[k]);
      samples[cell] = 0.4 + slope.dot(centre) / block.nodes_per_cell;
    }
  }
  const Vector found = recovery.weights * samples;
  ASSERT_EQ(found.size(), body->space.node_count());
  for (Index row = 0; row < found.size(); ++row) {
    const Index node = recovery.row_node[std::size_t(row)];
    EXPECT_NEAR(found[row], 0.4 + slope.dot(body->space.nodes.col(node)), 1e-11);
  }
}

/// Returns the largest relative excess of the value of a cell over those of all its nodes.
double worst_hidden_cell(const MeshedBody& body, const std::vector<double>& cells, const std::vector<double>& nodes) {
  double worst = 0.0;
  each_cell(body.space.cells, [&](Index cell, std::span<const Index> of_cell) {
    double largest = 0.0;
    for (const Index node : of_cell)
      largest = std::max(largest, von_mises_stress(nodes.data() + 6 * body.space.number[std::size_t(node)]));
    const double own = von_mises_stress(cells.data() + 6 * cell);
    worst = std::max(worst, (own - largest) / own);
  });
  return worst;
}

/// Von Mises' stress is convex (Jensen's inequality): no field stays below that of its mean all over a cell. A fit
/// alone violates this at a peak. The tensors are those of cells or of the fit, so principal stresses agree with them.
TEST_P(StressTest, NodesHideNoCell) {
  const auto body = curved_body(GetParam());
  std::srand(7);
  const Vector displacement = Vector::Random(body->space.dof_count());
  std::vector<double> cells, density, nodes, fitted(std::size_t(6 * body->space.node_count()));
  CellStress(body->body).evaluate(displacement, cells, density);
  NodalStress nodal(body->body);
  nodal.evaluate(cells, nodes);
  EXPECT_LE(worst_hidden_cell(*body, cells, nodes), 1e-14);
  const NodalRecovery recovery = make_nodal_recovery(body->body);
  const Matrix fit = recovery.weights * Eigen::Map<const Matrix>(cells.data(), 6, body->mesh.cell_count()).transpose();
  for (Index node = 0; node < fit.rows(); ++node) {
    const Index row = body->space.number[std::size_t(node)];
    Eigen::Map<Vector>(fitted.data() + 6 * row, 6) = fit.row(node).transpose();
  }
  EXPECT_GT(worst_hidden_cell(*body, cells, fitted), 0.05);
  Index kept = 0;
  for (std::size_t k = 0; k < nodes.size(); k += 6) {
    const bool is_fit =
        (Eigen::Map<const Vector>(nodes.data() + k, 6) - Eigen::Map<const Vector>(fitted.data() + k, 6)).norm() <=
        1e-12 * von_mises_stress(nodes.data() + k);
    kept += is_fit ? 1 : 0;
    EXPECT_GE(von_mises_stress(nodes.data() + k), (1.0 - 1e-12) * von_mises_stress(fitted.data() + k));
  }
  EXPECT_GT(kept, 0);
}

INSTANTIATE_TEST_SUITE_P(Elements, StressTest, testing::ValuesIn(stress_cases()), [](const auto& info) {
  return info.param.kind.label() + (info.param.plane == PlaneState::stress ? "_plane_stress" : "");
});

/// On a regular mesh the recovered stress is of (nearly) second order inside the body and of first on its boundary, so
/// of order 3/2 in the mean; the stress of cells is of first order.
TEST(NodalRecovery, IsOfHigherOrder) {
  const PointMap field = [](const Vector& x) {
    Vector u(2);
    u << x[0] * x[0] - x[0] * x[1], std::sin(2.0 * x[0]) * x[1];
    return u;
  };
  const Material material = test_material();
  const auto exact = [&](const Vector& x) {  // σ_xx of plane strain
    const double xx = 2.0 * x[0] - x[1], yy = std::sin(2.0 * x[0]);
    return material.lambda() * (xx + yy) + 2.0 * material.mu() * xx;
  };
  std::vector<double> inside, nodal, own;
  for (const int count : {8, 16, 32}) {
    BoxMesh box;
    box.counts = {count, count};
    box.distortion = 0.0;
    const auto body = make_meshed_body(make_box_mesh(box), 1);
    std::vector<double> stress, density;
    CellStress(body->body).evaluate(interpolate(body->space, field), stress, density);
    const Matrix components = Eigen::Map<const Matrix>(stress.data(), 6, body->mesh.cell_count());
    const Vector recovered = make_nodal_recovery(body->body).weights * Vector(components.row(0).transpose());
    double inside_error = 0.0, nodal_error = 0.0, own_error = 0.0;
    for (Index node = 0; node < recovered.size(); ++node) {
      const Vector x = body->space.nodes.col(node);
      const double square = std::pow(recovered[node] - exact(x), 2);
      nodal_error += square;
      // Only if cells surround the node on all sides.
      if (x.minCoeff() > 0.01 && x.maxCoeff() < 0.99) inside_error += square;
    }
    const CellBlock& cells = body->space.cells.front();
    for (Index cell = 0; cell < cells.size(); ++cell)
      own_error += std::pow(components(0, cell) - exact(body->space.nodes.col(cells.cell(cell)[0])), 2);
    inside.push_back(std::sqrt(inside_error / double(recovered.size())));
    nodal.push_back(std::sqrt(nodal_error / double(recovered.size())));
    own.push_back(std::sqrt(own_error / double(cells.size())));
  }
  for (std::size_t i = 1; i < nodal.size(); ++i) {
    EXPECT_GT(std::log2(inside[i - 1] / inside[i]), 1.75);
    EXPECT_GT(std::log2(nodal[i - 1] / nodal[i]), 1.35);
    EXPECT_LT(std::log2(own[i - 1] / own[i]), 1.2);
  }
}

/// Two materials side by side under the same strain do not affect each other. The nodes between them have the larger
/// stress: the mean would belong to neither.
TEST(NodalRecovery, KeepsMaterialsApart) {
  BoxMesh box;
  box.counts = {6, 4};
  box.distortion = 0.0;
  auto body = make_meshed_body(make_box_mesh(box), 1);
  body->body.materials.push_back(body->body.materials.front());
  const CellBlock& cells = body->space.cells.front();
  Vector samples(cells.size());
  for (Index cell = 0; cell < cells.size(); ++cell) {
    double x = 0.0;
    for (int k = 0; k < 3; ++k) x += body->space.nodes(0, cells.cell(cell)[k]) / 3.0;
    const int material = x < 0.5 ? 0 : 1;
    body->body.cell_material[std::size_t(cell)] = material;
    samples[cell] = material == 0 ? 1.0 : 5.0;
  }
  const NodalRecovery recovery = make_nodal_recovery(body->body);
  const Vector found = recovery.weights * samples;
  EXPECT_EQ(found.size(), body->space.node_count() + 5);
  std::vector<double> nodes, tension(std::size_t(6 * cells.size()));
  for (Index cell = 0; cell < cells.size(); ++cell) tension[std::size_t(6 * cell)] = samples[cell];
  NodalStress(body->body).evaluate(tension, nodes);
  Index last = -1;
  for (Index row = 0; row < found.size(); ++row) {
    const Index node = recovery.row_node[std::size_t(row)];
    const double x = body->space.nodes(0, node);
    const bool is_between = std::abs(x - 0.5) < 0.01;
    EXPECT_NEAR(found[row], is_between ? (node == last ? 5.0 : 1.0) : x < 0.5 ? 1.0 : 5.0, 1e-12) << x;
    last = node;
    const auto number = std::size_t(body->space.number[std::size_t(node)]);
    EXPECT_NEAR(nodes[6 * number], x < 0.49 ? 1.0 : 5.0, 1e-12) << x;
  }
}

/// Closed forms: uniaxial, hydrostatic, shear, with a double eigenvalue.
TEST(Stress, OfKnownStates) {
  const double uniaxial[] = {3.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  EXPECT_DOUBLE_EQ(von_mises_stress(uniaxial), 3.0);
  EXPECT_EQ(principal_stresses(uniaxial), (std::array<double, 3>{3.0, 0.0, 0.0}));
  const double pressure[] = {-2.0, 0.0, 0.0, -2.0, 0.0, -2.0};
  EXPECT_EQ(von_mises_stress(pressure), 0.0);
  for (const double each : principal_stresses(pressure)) EXPECT_DOUBLE_EQ(each, -2.0);
  const double shear[] = {0.0, 0.0, 4.0, 0.0, 0.0, 0.0};
  EXPECT_DOUBLE_EQ(von_mises_stress(shear), 4.0 * std::sqrt(3.0));
  const std::array<double, 3> principal = principal_stresses(shear);
  EXPECT_NEAR(principal[0], 4.0, 1e-14);
  EXPECT_NEAR(principal[1], 0.0, 1e-14);
  EXPECT_NEAR(principal[2], -4.0, 1e-14);
  const double none[6] = {};
  EXPECT_EQ(von_mises_stress(none), 0.0);
  EXPECT_EQ(principal_stresses(none), (std::array<double, 3>{0.0, 0.0, 0.0}));
}

}  // namespace ricochet::test_support::stress_test
