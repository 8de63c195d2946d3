#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>

#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "support/box_mesh.hpp"

/// @file Patch tests: an affine displacement is reproduced, its stress follows the law and is in equilibrium.
namespace ricochet::test_support::patch_test {

struct PatchCase {
  ElementKind kind;
  PlaneState plane = PlaneState::strain;
  bool bent = false;  ///< the sides are curved too, instead of plane

  [[nodiscard]] std::string label() const {
    const std::string law = kind.dimension() == 3 ? "solid" : plane == PlaneState::strain ? "strain" : "stress";
    return kind.label() + "_" + law + (bent ? "_bent" : "_box");
  }
};

std::vector<PatchCase> patch_cases(const std::vector<bool>& bent_or_not) {
  std::vector<PatchCase> cases;
  for (const ElementKind& kind : all_element_kinds()) {
    for (const bool bent : bent_or_not) {
      cases.push_back({kind, PlaneState::strain, bent});
      if (kind.dimension() == 2) cases.push_back({kind, PlaneState::stress, bent});
    }
  }
  return cases;
}

/// Displacement gradient, with all components of strain and a rotation.
Matrix gradient(int dimension) {
  Matrix h(3, 3);
  h << 0.31, -0.12, 0.07, 0.45, -0.23, 0.11, -0.19, 0.05, 0.28;
  return h.topLeftCorner(dimension, dimension);
}

Vector shift(int dimension) { return Vector::LinSpaced(dimension, 0.4, -0.9); }

/// The law written out independently: in plane stress from E and ν, not through the condensed λ of the library.
Matrix stress_of(const Matrix& h, PlaneState plane) {
  const Material material = test_material();
  const Matrix strain = 0.5 * (h + h.transpose());
  const Index d = h.rows();
  if (d == 2 && plane == PlaneState::stress) {
    const double nu = material.lambda() / (2.0 * (material.lambda() + material.mu()));
    const double young = 2.0 * material.mu() * (1.0 + nu);
    return young / (1.0 - nu * nu) * ((1.0 - nu) * strain + nu * strain.trace() * Matrix::Identity(2, 2));
  }
  return material.lambda() * strain.trace() * Matrix::Identity(d, d) + 2.0 * material.mu() * strain;
}

class PatchTest : public testing::TestWithParam<PatchCase> {
 protected:
  /// Curved cells, unless the displacement cannot be affine on them (then second-order nodes on straight cells).
  std::unique_ptr<MeshedBody> make_body() const {
    const PatchCase& given = GetParam();
    const int d = given.kind.dimension();
    PointMap map = given.bent ? bend_map() : swirl_map(0.08);
    if (!given.kind.contains_affine()) {
      map = affine_map(Matrix::Identity(d, d) + 0.3 * gradient(d), Vector::Zero(d));
      if (!given.bent) map = {};
    }
    const std::vector<int> counts = d == 2 ? std::vector<int>{4, 3} : std::vector<int>{3, 2, 2};
    return make_meshed_body(make_checked_box_mesh({given.kind.shape, counts, given.kind.geometry_degree, 0.15, map}),
                            given.kind.displacement_degree, given.plane);
  }
};

class BoxPatchTest : public PatchTest {};

/// Numbers of the dofs that are (not) on the boundary, −1 for others.
std::vector<int> number_dofs(const MeshedBody& test, bool on_boundary, int& count) {
  const int d = test.mesh.dimension;
  std::vector<char> held(static_cast<std::size_t>(test.space.node_count()), 0);
  for (const Index node : facet_nodes(test.space, test.mesh.group("boundary", d - 1).members)) {
    held[std::size_t(node)] = 1;
  }
  std::vector<int> number(static_cast<std::size_t>(test.space.dof_count()), -1);
  count = 0;
  for (std::size_t dof = 0; dof < number.size(); ++dof) {
    if ((held[dof / std::size_t(d)] != 0) == on_boundary) number[dof] = count++;
  }
  return number;
}

TEST_P(PatchTest, AffineDisplacementOnTheBoundaryGivesItInside) {
  const auto test = make_body();
  const int d = test->mesh.dimension;
  const SparseMatrix stiffness = assemble_stiffness(test->body, node_graph(test->space));
  const Vector exact = interpolate(test->space, affine_map(gradient(d), shift(d)));
  int inner_count = 0, held_count = 0;
  const std::vector<int> inner = number_dofs(*test, false, inner_count);
  const std::vector<int> held = number_dofs(*test, true, held_count);
  ASSERT_GE(inner_count, d);
  Vector inner_exact(inner_count), held_exact(held_count);
  for (std::size_t dof = 0; dof < inner.size(); ++dof) {
    if (inner[dof] >= 0) inner_exact[inner[dof]] = exact[Index(dof)];
    if (held[dof] >= 0) held_exact[held[dof]] = exact[Index(dof)];
  }
  const SparseMatrix k_ii = extract(stiffness, inner, inner_count, inner, inner_count);
  const SparseMatrix k_ih = extract(stiffness, inner, inner_count, held, held_count);
  const Eigen::SimplicialLDLT<SparseMatrix> factor(k_ii);
  ASSERT_EQ(factor.info(), Eigen::Success);
  const Vector found = factor.solve(-(k_ih * held_exact));
  EXPECT_LE((found - inner_exact).lpNorm<Eigen::Infinity>(), 1e-13 * exact.lpNorm<Eigen::Infinity>());
}

TEST_P(PatchTest, UniformStressHasNoForceInside) {
  const auto test = make_body();
  const int d = test->mesh.dimension;
  const SparseMatrix stiffness = assemble_stiffness(test->body, node_graph(test->space));
  const Vector exact = interpolate(test->space, affine_map(gradient(d), shift(d)));
  const Vector force = stiffness * exact;
  const double size = force.lpNorm<Eigen::Infinity>();
  int count = 0;
  const std::vector<int> inner = number_dofs(*test, false, count);
  double largest = 0.0;
  for (std::size_t dof = 0; dof < inner.size(); ++dof) {
    if (inner[dof] >= 0) largest = std::max(largest, std::abs(force[Index(dof)]));
  }
  EXPECT_GT(size, 1e-3);
  EXPECT_LE(largest, 2e-14 * size * std::sqrt(double(stiffness.nonZeros() / stiffness.cols())));
}

/// The energy of the affine displacement is ½ σ:ε times the volume: checks the law and the integration of curved cells.
TEST_P(PatchTest, EnergyIsThatOfTheUniformStress) {
  const auto test = make_body();
  const int d = test->mesh.dimension;
  const SparseMatrix stiffness = assemble_stiffness(test->body, node_graph(test->space));
  const Vector exact = interpolate(test->space, affine_map(gradient(d), shift(d)));
  const Matrix stress = stress_of(gradient(d), GetParam().plane);
  const double volume = integrate(*test, 6, [](const Vector&) { return 1.0; });
  const double energy = 0.5 * stress.cwiseProduct(gradient(d)).sum() * volume;
  EXPECT_NEAR(0.5 * exact.dot(stiffness * exact), energy, 1e-12 * energy);
}

/// On a box, whose sides have constant normals, K u is the load of the tractions σ n on its sides.
TEST_P(BoxPatchTest, InternalForceBalancesTheTractions) {
  const auto test = make_body();
  const int d = test->mesh.dimension;
  const SparseMatrix stiffness = assemble_stiffness(test->body, node_graph(test->space));
  const Vector force = stiffness * interpolate(test->space, affine_map(gradient(d), shift(d)));
  const Matrix stress = stress_of(gradient(d), GetParam().plane);
  Vector load = Vector::Zero(test->space.dof_count());
  for (int axis = 0; axis < d; ++axis) {
    for (const int end : {0, 1}) {
      const Vector traction = (end == 1 ? 1.0 : -1.0) * stress.col(axis);
      add_facet_load(
          test->body, test->mesh.group(std::string(1, "xyz"[axis]) + (end == 1 ? "1" : "0"), d - 1).members,
          [&](const Vector&, Vector& density) { density = traction; }, load);
    }
  }
  EXPECT_LE((force - load).lpNorm<Eigen::Infinity>(), 1e-13 * force.lpNorm<Eigen::Infinity>());
}

INSTANTIATE_TEST_SUITE_P(Elements, PatchTest, testing::ValuesIn(patch_cases({false, true})),
                         [](const auto& info) { return info.param.label(); });
INSTANTIATE_TEST_SUITE_P(Elements, BoxPatchTest, testing::ValuesIn(patch_cases({false})),
                         [](const auto& info) { return info.param.label(); });

}  // namespace ricochet::test_support::patch_test
