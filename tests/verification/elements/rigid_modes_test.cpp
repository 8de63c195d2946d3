#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "ricochet/fem/cell_rotations.hpp"
#include "support/box_mesh.hpp"

/// @file Rigid motions: the null space of the stiffness, symmetry of the operators, the measured rotation.
namespace ricochet::test_support::rigid_modes_test {

class RigidModes : public testing::TestWithParam<ElementKind> {
 protected:
  /// A bent body, with curved cells if these can rotate rigidly, else with straight cells.
  std::unique_ptr<MeshedBody> make_body(double size = 1.0) const {
    const ElementKind& kind = GetParam();
    const int d = kind.dimension();
    const PointMap shape = kind.contains_affine() ? bend_map() : affine_map(Matrix::Identity(d, d), Vector::Zero(d));
    const PointMap map = [shape, size](const Vector& x) -> Vector { return size * shape(x); };
    const std::vector<int> counts = d == 2 ? std::vector<int>{4, 3} : std::vector<int>{2, 2, 2};
    return make_meshed_body(make_checked_box_mesh({kind.shape, counts, kind.geometry_degree, 0.15, map}),
                            kind.displacement_degree);
  }
};

/// Translations and infinitesimal rotations at all nodes, one per column, of length one.
Matrix rigid_modes(const DisplacementSpace& space) {
  const int d = space.dimension;
  Matrix modes(space.dof_count(), d == 2 ? 3 : 6);
  for (int axis = 0; axis < d; ++axis) {
    modes.col(axis) = interpolate(space, [=](const Vector&) -> Vector { return Vector::Unit(d, axis); });
  }
  Index column = d;
  for (int a = 0; a < d; ++a) {
    for (int b = a + 1; b < d; ++b, ++column) {
      modes.col(column) = interpolate(space, [=](const Vector& x) -> Vector {
        Vector u = Vector::Zero(d);
        u[a] = -x[b];
        u[b] = x[a];
        return u;
      });
    }
  }
  return modes.colwise().normalized();
}

TEST_P(RigidModes, AreTheNullSpaceOfTheStiffness) {
  const auto test = make_body();
  const Matrix stiffness = assemble_stiffness(test->body, node_graph(test->space));
  const Matrix modes = rigid_modes(test->space);
  const Eigen::SelfAdjointEigenSolver<Matrix> eigen(stiffness, Eigen::EigenvaluesOnly);
  const Vector& values = eigen.eigenvalues();
  const double largest = values[values.size() - 1];
  EXPECT_LE((stiffness * modes).lpNorm<Eigen::Infinity>(), 1e-14 * largest);
  const Index zeros = modes.cols();
  EXPECT_LE(values.head(zeros).cwiseAbs().maxCoeff(), 1e-14 * largest);
  EXPECT_GE(values[zeros], 1e-4 * largest) << "a spurious mode without energy";
}

TEST_P(RigidModes, OperatorsAreSymmetricBitForBit) {
  const auto test = make_body();
  const NodeGraph graph = node_graph(test->space);
  const Matrix stiffness = assemble_stiffness(test->body, graph);
  const Matrix mass = assemble_scalar_mass(test->body, graph);
  EXPECT_TRUE(stiffness == stiffness.transpose());
  EXPECT_TRUE(mass == mass.transpose());
  const Matrix expanded = expand_to_components(assemble_scalar_mass(test->body, graph), test->mesh.dimension);
  for (Index i = 0; i < mass.rows(); ++i) {
    for (Index j = 0; j < mass.cols(); ++j) {
      for (int a = 0; a < test->mesh.dimension; ++a) {
        for (int b = 0; b < test->mesh.dimension; ++b) {
          ASSERT_EQ(expanded(i * test->mesh.dimension + a, j * test->mesh.dimension + b), a == b ? mass(i, j) : 0.0);
        }
      }
    }
  }
}

/// K scales with length to the power d−2 and M with d: for a power of two, bit for bit.
TEST_P(RigidModes, OperatorsScaleBitForBit) {
  const auto one = make_body();
  const auto small = make_body(0.0078125);
  const int d = one->mesh.dimension;
  const NodeGraph graph = node_graph(one->space);
  const Matrix stiffness = assemble_stiffness(one->body, graph);
  const Matrix mass = assemble_scalar_mass(one->body, graph);
  EXPECT_TRUE(Matrix(assemble_stiffness(small->body, graph)) == stiffness * std::pow(0.0078125, d - 2));
  EXPECT_TRUE(Matrix(assemble_scalar_mass(small->body, graph)) == mass * std::pow(0.0078125, d));
}

Matrix rotation(int dimension, double angle) {
  if (dimension == 2) return Eigen::Rotation2Dd(angle).toRotationMatrix();
  return Eigen::AngleAxisd(angle, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
}

TEST_P(RigidModes, AnyRotationBelowHalfATurnIsMeasured) {
  const auto test = make_body();
  const int d = test->mesh.dimension;
  const CellRotations gauge(test->body);
  for (const double angle : {1e-6, 0.1, -0.7, 1.6, -2.5, 3.1, 3.1415}) {
    const Matrix h = rotation(d, angle) - Matrix::Identity(d, d);
    const double measured = gauge.largest(interpolate(test->space, affine_map(h, Vector::Ones(d))));
    EXPECT_NEAR(measured, std::abs(angle), 1e-13);
  }
  const Matrix stretch = Vector::LinSpaced(d, 0.4, -0.3).asDiagonal();
  EXPECT_LE(gauge.largest(interpolate(test->space, affine_map(stretch, Vector::Zero(d)))), 1e-14);
}

/// One node rotates only its own cells: the gauge returns the largest rotation of a cell, not an average.
TEST_P(RigidModes, ARotatingCellIsDetected) {
  const auto test = make_body();
  const int d = test->mesh.dimension;
  const CellRotations gauge(test->body);
  const Matrix h = rotation(d, 0.4) - Matrix::Identity(d, d);
  const Vector turned = interpolate(test->space, affine_map(h, Vector::Zero(d)));
  const CellBlock& block = test->space.cells[0];
  for (const Index cell : {Index{0}, block.size() / 2, block.size() - 1}) {
    Vector displacement = Vector::Zero(turned.size());
    for (int k = 0; k < block.nodes_per_cell; ++k) {
      displacement.segment(block.cell(cell)[k] * d, d) = turned.segment(block.cell(cell)[k] * d, d);
    }
    EXPECT_GE(gauge.largest(displacement), 0.4 - 1e-13);
  }
}

/// Linear displacements on curved cells contain no rotation: there a rotation has an energy, which must vanish with h².
/// (On curved meshes use degree 2 if rotation matters.)
TEST(RigidModesOfLinearDisplacementOnCurvedCells, HaveAnEnergyOfSecondOrder) {
  for (const CellShape shape : all_cell_shapes()) {
    const int d = dimension(shape);
    std::vector<double> energies;
    std::printf("%-16s rotation energy / shear modulus, unit angle:", name(shape).c_str());
    for (const int count : d == 2 ? std::vector<int>{4, 8, 16, 32} : std::vector<int>{2, 4, 8}) {
      const auto test = make_meshed_body(
          make_checked_box_mesh({shape, std::vector<int>(std::size_t(d), count), 2, 0.0, bend_map()}), 1);
      Matrix spin = Matrix::Zero(d, d);
      spin(0, 1) = -1.0;
      spin(1, 0) = 1.0;
      const Vector u = interpolate(test->space, affine_map(spin, Vector::Zero(d)));
      const SparseMatrix stiffness = assemble_stiffness(test->body, node_graph(test->space));
      EXPECT_LE((stiffness * interpolate(test->space, [d](const Vector&) -> Vector { return Vector::Ones(d); }))
                    .lpNorm<Eigen::Infinity>(),
                1e-14 * stiffness.coeffs().maxCoeff());
      energies.push_back(0.5 * u.dot(stiffness * u) / test_material().mu());
      std::printf("  %.2e", energies.back());
    }
    const std::size_t n = energies.size();
    const double order = std::log2(energies[n - 2] / energies[n - 1]);
    std::printf("  order %.2f\n", order);
    EXPECT_GE(order, 1.75) << name(shape);
  }
}

INSTANTIATE_TEST_SUITE_P(Elements, RigidModes, testing::ValuesIn(all_element_kinds()),
                         [](const auto& info) { return info.param.label(); });

}  // namespace ricochet::test_support::rigid_modes_test
