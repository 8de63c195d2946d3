#include <gtest/gtest.h>

#include <Eigen/SparseCholesky>
#include <cmath>
#include <numbers>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/error.hpp"
#include "ricochet/fem/cell_masses.hpp"
#include "ricochet/fem/facet_integration.hpp"
#include "ricochet/fem/green_strain.hpp"
#include "ricochet/fem/mesh_measures.hpp"
#include "ricochet/fem/nodal_recovery.hpp"
#include "ricochet/fem/stress.hpp"
#include "ricochet/linear_algebra/sparse_matrix.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/problem/rigid_motion.hpp"
#include "support/box_mesh.hpp"
#include "support/mass_moments.hpp"

/// @file Elements of axisymmetric bodies: patch tests, measures, masses, and Lamé's closed forms.
namespace ricochet::test_support::elements_test {

constexpr double pi = std::numbers::pi;

struct PatchCase {
  ElementKind kind;
  bool at_axis = true;  ///< the body is a full cylinder, or a hollow one
  bool curved = false;

  [[nodiscard]] std::string label() const {
    return kind.label() + (at_axis ? "_full" : "_hollow") + (curved ? "_curved" : "_straight");
  }
};

std::vector<PatchCase> patch_cases() {
  std::vector<PatchCase> cases;
  for (const ElementKind& kind : all_element_kinds()) {
    if (kind.dimension() != 2) continue;
    for (const bool at_axis : {true, false}) {
      cases.push_back({kind, at_axis, false});
      if (kind.contains_affine()) cases.push_back({kind, at_axis, true});
    }
  }
  return cases;
}

/// u = (a r, b z + c): the stress is uniform, σ_rr = σ_θθ.
constexpr double a = 0.31, b = -0.23, c = 0.4;
Vector stretched(const Vector& x) { return Eigen::Vector2d(a * x[0], b * x[1] + c); }
double radial_stress() {
  const Material material = test_material();
  return material.lambda() * (2.0 * a + b) + 2.0 * material.mu() * a;
}
double axial_stress() {
  const Material material = test_material();
  return material.lambda() * (2.0 * a + b) + 2.0 * material.mu() * b;
}

class AxisymmetricPatch : public testing::TestWithParam<PatchCase> {
 protected:
  /// A cylinder of height 1 between the radii 0 and 1, or 0.5 and 1.5; its sides are not moved by the distortion.
  [[nodiscard]] std::unique_ptr<MeshedBody> make_body(const std::vector<int>& counts = {4, 3}) const {
    const PatchCase& given = GetParam();
    const double inner = given.at_axis ? 0.0 : 0.5;
    const PointMap curve = swirl_map(0.06);
    const PointMap map = [=](const Vector& x) -> Vector {
      return (given.curved ? curve(x) : x) + Vector(Eigen::Vector2d(inner, 0.0));
    };
    return make_meshed_body(make_checked_box_mesh({given.kind.shape, counts, given.kind.geometry_degree, 0.15, map}),
                            given.kind.displacement_degree, PlaneState::axisymmetric);
  }
  [[nodiscard]] double inner() const { return GetParam().at_axis ? 0.0 : 0.5; }
  [[nodiscard]] double outer() const { return inner() + 1.0; }
  [[nodiscard]] double volume() const { return pi * (outer() * outer() - inner() * inner()); }
};

/// K u equals the load of the tractions on the sides at every node, which is zero on the axis.
TEST_P(AxisymmetricPatch, InternalForceBalancesTheTractions) {
  const auto test = make_body();
  const SparseMatrix stiffness = assemble_stiffness(test->body, node_graph(test->space));
  const Vector force = stiffness * interpolate(test->space, stretched);
  Vector load = Vector::Zero(test->space.dof_count());
  const auto press = [&](const std::string& side, const Eigen::Vector2d& traction) {
    add_facet_load(
        test->body, test->mesh.group(side, 1).members, [&](const Vector&, Vector& density) { density = traction; },
        load);
  };
  press("x1", {radial_stress(), 0.0});
  press("x0", {-radial_stress(), 0.0});
  press("y1", {0.0, axial_stress()});
  press("y0", {0.0, -axial_stress()});
  EXPECT_LE((force - load).lpNorm<Eigen::Infinity>(), 1e-13 * force.lpNorm<Eigen::Infinity>());
}

TEST_P(AxisymmetricPatch, StressIsUniform) {
  const auto test = make_body();
  std::vector<double> stress, density;
  const CellStress of_cells(test->body);
  of_cells.evaluate(interpolate(test->space, stretched), stress, density);
  const double size = std::abs(radial_stress()) + std::abs(axial_stress());
  const double energy = 0.5 * (2.0 * radial_stress() * a + axial_stress() * b);
  const double mises = std::abs(radial_stress() - axial_stress());
  for (std::size_t cell = 0; cell < density.size(); ++cell) {
    const double expected[] = {radial_stress(), 0.0, 0.0, axial_stress(), 0.0, radial_stress()};
    for (std::size_t k = 0; k < 6; ++k) ASSERT_NEAR(stress[6 * cell + k], expected[k], 1e-12 * size) << k;
    ASSERT_NEAR(density[cell], energy, 1e-12 * size);
    ASSERT_NEAR(von_mises_stress(stress.data() + 6 * cell), mises, 1e-12 * size);
  }
  EXPECT_NEAR(of_cells.largest_von_mises(interpolate(test->space, stretched)).value, mises, 1e-12 * size);
  EXPECT_NEAR(largest_green_strain(test->body, interpolate(test->space, stretched)), a + 0.5 * a * a, 1e-12);
}

/// Σ density × volume = ½UᵀKU for any displacement.
TEST_P(AxisymmetricPatch, EnergyDensitiesAddUpToTheStrainEnergy) {
  const auto test = make_body();
  const SparseMatrix stiffness = assemble_stiffness(test->body, node_graph(test->space));
  std::srand(5);
  const Vector displacement = Vector::Random(test->space.dof_count());
  std::vector<double> stress, density;
  CellStress(test->body).evaluate(displacement, stress, density);
  const Vector volumes = cell_volumes(test->body);
  const double energy = 0.5 * displacement.dot(stiffness * displacement);
  EXPECT_NEAR(volumes.dot(Eigen::Map<const Vector>(density.data(), volumes.size())), energy, 1e-13 * energy);
  EXPECT_NEAR(volumes.sum(), volume(), 1e-13 * volume());
}

/// The stress of u = (rz, …) of degree 2 is linear, and recovered exactly at the nodes.
TEST_P(AxisymmetricPatch, RecoveryIsExactForLinearStresses) {
  if (GetParam().kind.displacement_degree == 1 || GetParam().curved) return;  // not contained in the space
  const auto test = make_body({5, 5});
  const Vector displacement = interpolate(test->space, [](const Vector& x) -> Vector {
    return Eigen::Vector2d(x[0] * (0.2 + 0.5 * x[1]), 0.7 * x[1] * x[1]);
  });
  std::vector<double> stress, density;
  CellStress(test->body).evaluate(displacement, stress, density);
  const Matrix components = Eigen::Map<const Matrix>(stress.data(), 6, test->mesh.cell_count());
  const Vector hoop = make_nodal_recovery(test->body).weights * Vector(components.row(5).transpose());
  const Material material = test_material();
  for (Index node = 0; node < hoop.size(); ++node) {
    const double y = test->space.nodes(1, node), around = 0.2 + 0.5 * y, along = 1.4 * y;
    EXPECT_NEAR(hoop[node], material.lambda() * (2.0 * around + along) + 2.0 * material.mu() * around, 1e-11);
  }
}

/// The symmetric matrix has a single motion without energy: the translation along the axis.
TEST_P(AxisymmetricPatch, OnlyTheTranslationAlongTheAxisIsRigid) {
  const auto test = make_body();
  const SparseMatrix stiffness = assemble_stiffness(test->body, node_graph(test->space));
  const Vector values = symmetric_eigenvalues(Matrix(stiffness));
  EXPECT_LE(std::abs(values[0]), 1e-13 * values[values.size() - 1]);
  EXPECT_GE(values[1], 1e-6 * values[values.size() - 1]);
  // Only this translation is subtracted from displacements before products.
  const RigidMotion rigid(test->space.nodes, stiffness);
  const Vector moved = interpolate(test->space, [](const Vector& x) -> Vector {
    return stretched(x) + Vector(Eigen::Vector2d(0.2 - 3.0 * x[1], 1e6 + 3.0 * x[0]));
  });
  Vector deformation;
  rigid.remove(moved, deformation);
  const Vector lifted = moved - deformation;
  for (Index node = 0; node < test->space.node_count(); ++node) {
    EXPECT_EQ(lifted[2 * node], 0.0);
    EXPECT_NEAR(lifted[2 * node + 1], lifted[1], 1e-9);
  }
}

TEST_P(AxisymmetricPatch, MassesAndLoadsAreThoseOfTheRings) {
  const auto test = make_body();
  const SparseMatrix mass = assemble_scalar_mass(test->body, node_graph(test->space));
  const double rho = test_material().density, r1 = outer(), r0 = inner();
  const Matrix moments = mass_moments(mass, test->space.nodes);  // products with 1, r, z
  const double first = 2.0 * pi / 3.0 * (r1 * r1 * r1 - r0 * r0 * r0);
  const double second = 0.5 * pi * (std::pow(r1, 4) - std::pow(r0, 4));
  Matrix expected(3, 3);
  expected << volume(), first, 0.5 * volume(), first, second, 0.5 * first, 0.5 * volume(), 0.5 * first, volume() / 3.0;
  EXPECT_LE((moments - rho * expected).cwiseAbs().maxCoeff(), 1e-13 * rho * expected.maxCoeff());
  double sum = 0.0;
  CellMasses(test->body).for_each([&](const std::vector<Index>&, const Matrix& own) { sum += own.sum(); });
  EXPECT_NEAR(sum, rho * volume(), 1e-13 * sum);
  Vector load = Vector::Zero(test->space.dof_count());
  add_body_load(
      test->body, [](const Vector& x, Vector& force) { force << x[0], 3.0; }, load);
  Vector total = Vector::Zero(2);
  for (Index node = 0; node < test->space.node_count(); ++node) total += load.segment(2 * node, 2);
  EXPECT_NEAR(total[0], first, 1e-13 * first);
  EXPECT_NEAR(total[1], 3.0 * volume(), 1e-12);
}

TEST_P(AxisymmetricPatch, GroupsMeasureWhatTheirRingsDo) {
  const auto test = make_body();
  const auto size = [&](const std::string& name, int dimension) {
    return measure_group(test->mesh, test->mesh.group(name, dimension), true).size;
  };
  EXPECT_NEAR(size("body", 2), volume(), 1e-13 * volume());
  EXPECT_NEAR(size("x1", 1), 2.0 * pi * outer(), 1e-12);
  EXPECT_NEAR(size("x0", 1), 2.0 * pi * inner(), 1e-12);
  EXPECT_NEAR(size("y1", 1), volume(), 1e-12);
  const FacetIntegration integration(test->body);
  FacetQuadrature quadrature;
  double area = 0.0;
  for (const Index facet : test->mesh.group("y1", 1).members) {
    integration.evaluate(facet, quadrature);
    area += quadrature.measure.sum();
  }
  EXPECT_NEAR(area, volume(), 1e-12);
}

/// Mass, first and second moments with the density 2πrρ are preserved, so a translation along the axis and u = (a r, b
/// z + c) have their exact kinetic energy.
TEST_P(AxisymmetricPatch, EquivalentMassesKeepTheirMoments) {
  const auto test = make_body({7, 7});
  const SparseMatrix consistent = assemble_scalar_mass(test->body, node_graph(test->space));
  const CellMasses cells(test->body);
  const MassInput input{&consistent, &test->space.nodes, facet_nodes(test->space, test->mesh.group("y0", 1).members),
                        &consistent, &cells};
  const double rho = test_material().density, r1 = outer(), r0 = inner();
  const double exact =
      0.5 * rho * pi *
      (0.5 * a * a * (std::pow(r1, 4) - std::pow(r0, 4)) + (r1 * r1 - r0 * r0) * (b * b / 3.0 + b * c + c * c));
  const Vector velocity = interpolate(test->space, stretched);
  for (const char* type : {"equivalent-nodewise", "equivalent-cellwise", "equivalent-compact", "equivalent-nearest",
                           "equivalent-lumped"}) {
    SparseMatrix mass;
    try {
      mass = build_mass(type, input);
    } catch (const Error&) {
      EXPECT_EQ(std::string(type), "equivalent-nearest");  // indefinite on coarse meshes
      continue;
    }
    for (const Index node : input.contact_nodes) EXPECT_EQ(mass.col(node).nonZeros(), 0) << type;
    const Matrix wanted = mass_moments(consistent, test->space.nodes), found = mass_moments(mass, test->space.nodes);
    EXPECT_LE((found - wanted).cwiseAbs().maxCoeff(), 1e-12 * wanted.cwiseAbs().maxCoeff()) << type;
    const SparseMatrix both = expand_to_components(mass, 2);
    EXPECT_NEAR(0.5 * velocity.dot(both * velocity), exact, 1e-12 * exact) << type;
    const Vector lift = interpolate(test->space, [](const Vector&) -> Vector { return Eigen::Vector2d(0.0, 1.0); });
    EXPECT_NEAR(0.5 * lift.dot(both * lift), 0.5 * rho * volume(), 1e-12 * rho * volume()) << type;
  }
}

INSTANTIATE_TEST_SUITE_P(Elements, AxisymmetricPatch, testing::ValuesIn(patch_cases()),
                         [](const auto& info) { return info.param.label(); });

/// Equilibrium under a load; dofs with `is_held` are zero.
Vector equilibrium(const MeshedBody& test, const Vector& load, const std::function<bool(const Vector&, int)>& is_held) {
  std::vector<int> number(static_cast<std::size_t>(test.space.dof_count()), -1);
  int count = 0;
  for (std::size_t dof = 0; dof < number.size(); ++dof) {
    const auto node = Index(dof / 2);
    if (!is_held(test.space.nodes.col(node), int(dof % 2))) number[dof] = count++;
  }
  const SparseMatrix inner =
      extract(assemble_stiffness(test.body, node_graph(test.space)), number, count, number, count);
  Vector right(count);
  for (std::size_t dof = 0; dof < number.size(); ++dof) {
    if (number[dof] >= 0) right[number[dof]] = load[Index(dof)];
  }
  const Eigen::SimplicialLDLT<SparseMatrix> factor(inner);
  const Vector found = factor.solve(right);
  Vector result = Vector::Zero(test.space.dof_count());
  for (std::size_t dof = 0; dof < number.size(); ++dof) {
    if (number[dof] >= 0) result[Index(dof)] = found[number[dof]];
  }
  return result;
}

/// Errors of the displacement at the nodes and of the hoop stress in the cells, as root mean squares over the rings: on
/// the axis itself values converge by up to half an order more slowly.
struct LameErrors {
  double displacement = 0.0, hoop = 0.0;
};

using Field = std::function<Vector(const Vector&)>;

LameErrors errors_of(const MeshedBody& test, const Vector& displacement, const Field& exact,
                     const std::function<double(const Vector&)>& hoop) {
  LameErrors result;
  double size = 0.0, stress_size = 0.0;
  for (Index node = 0; node < test.space.node_count(); ++node) {
    const Vector at = exact(test.space.nodes.col(node));
    const double radius = test.space.nodes(0, node);
    result.displacement += radius * (displacement.segment(2 * node, 2) - at).squaredNorm();
    size += radius * at.squaredNorm();
  }
  std::vector<double> stress, density;
  CellStress(test.body).evaluate(displacement, stress, density);
  const CellBlock& cells = test.mesh.cells.front();
  for (Index cell = 0; cell < cells.size(); ++cell) {
    Vector centre = Vector::Zero(2);
    const int vertices = vertex_count(cells.shape);
    for (int k = 0; k < vertices; ++k) centre += test.mesh.nodes.col(cells.cell(cell)[k]) / vertices;
    const double found = stress[std::size_t(6 * cell + 5)];
    result.hoop += centre[0] * std::pow(found - hoop(centre), 2);
    stress_size += centre[0] * std::pow(hoop(centre), 2);
  }
  return {std::sqrt(result.displacement / size), std::sqrt(result.hoop / stress_size)};
}

struct LameCase {
  CellShape shape;
  int degree;
};

class Lame : public testing::TestWithParam<LameCase> {
 protected:
  static double order(double coarse, double fine) { return std::log2(coarse / fine); }
  void expect_orders(const std::vector<LameErrors>& errors, double least) const {
    const int degree = GetParam().degree;
    for (std::size_t i = 1; i < errors.size(); ++i) {
      EXPECT_GT(order(errors[i - 1].displacement, errors[i].displacement), degree + 1 - 0.25);
      EXPECT_GT(order(errors[i - 1].hoop, errors[i].hoop), least);
    }
    std::printf("degree %d: displacement %.2e, hoop stress %.2e\n", degree, errors.back().displacement,
                errors.back().hoop);
  }
};

/// A tube, 1 < r < 2, under internal pressure, held axially at both ends: u_r = A r + B/r.
TEST_P(Lame, TubeUnderPressure) {
  const double inner = 1.0, outer = 2.0, pressure = 0.7;
  const Material material = test_material();
  const double ratio = pressure * inner * inner / (outer * outer - inner * inner);
  const double first = ratio / (2.0 * (material.lambda() + material.mu()));
  const double second = ratio * outer * outer / (2.0 * material.mu());
  std::vector<LameErrors> errors;
  for (const int count : {4, 8, 16}) {
    const PointMap map = [&](const Vector& x) -> Vector { return Eigen::Vector2d(inner + x[0], 0.5 * x[1]); };
    const auto test = make_meshed_body(make_box_mesh({GetParam().shape, {2 * count, count}, 1, 0.0, map}),
                                       GetParam().degree, PlaneState::axisymmetric);
    Vector load = Vector::Zero(test->space.dof_count());
    add_facet_load(
        test->body, test->mesh.group("x0", 1).members, [&](const Vector&, Vector& f) { f << pressure, 0.0; }, load);
    const Vector found =
        equilibrium(*test, load, [](const Vector& x, int k) { return k == 1 && (x[1] < 1e-9 || x[1] > 0.5 - 1e-9); });
    errors.push_back(errors_of(
        *test, found, [&](const Vector& x) -> Vector { return Eigen::Vector2d(first * x[0] + second / x[0], 0.0); },
        [&](const Vector& x) { return ratio * (1.0 + outer * outer / (x[0] * x[0])); }));
  }
  expect_orders(errors, GetParam().degree - 0.15);
}

/// A hollow ball, 1 < R < 2, under internal pressure: u_R = A R + B/R². Its section reaches the axis.
TEST_P(Lame, HollowBallUnderPressure) {
  const double inner = 1.0, outer = 2.0, pressure = 0.7;
  const Material material = test_material();
  const double ratio = pressure * std::pow(inner, 3) / (std::pow(outer, 3) - std::pow(inner, 3));
  const double first = ratio / (3.0 * material.lambda() + 2.0 * material.mu());
  const double second = ratio * std::pow(outer, 3) / (4.0 * material.mu());
  std::vector<LameErrors> errors;
  for (const int count : {4, 8, 16}) {
    // From the lower pole on the axis (x₁ = 0) to the equator; the first coordinate points outwards.
    const PointMap map = [&](const Vector& x) -> Vector {
      const double angle = 0.5 * pi * x[1], radius = inner + x[0];
      return radius * Vector(Eigen::Vector2d(x[1] == 0.0 ? 0.0 : std::sin(angle), -std::cos(angle)));
    };
    const auto test =
        make_meshed_body(make_box_mesh({GetParam().shape, {count, 2 * count}, GetParam().degree, 0.0, map}),
                         GetParam().degree, PlaneState::axisymmetric);
    Vector load = Vector::Zero(test->space.dof_count());
    add_facet_load(
        test->body, test->mesh.group("x0", 1).members,
        [&](const Vector& x, Vector& f) { f = pressure * x.normalized(); }, load);
    const Vector found =
        equilibrium(*test, load, [](const Vector& x, int k) { return k == 0 ? x[0] == 0.0 : std::abs(x[1]) < 1e-9; });
    errors.push_back(errors_of(
        *test, found, [&](const Vector& x) -> Vector { return (first + second / std::pow(x.norm(), 3)) * x; },
        [&](const Vector& x) { return ratio * (1.0 + 0.5 * std::pow(outer / x.norm(), 3)); }));
  }
  expect_orders(errors, GetParam().degree - 0.15);
}

INSTANTIATE_TEST_SUITE_P(Elements, Lame,
                         testing::Values(LameCase{CellShape::triangle, 1}, LameCase{CellShape::triangle, 2},
                                         LameCase{CellShape::quadrilateral, 1}, LameCase{CellShape::quadrilateral, 2}),
                         [](const auto& info) {
                           return std::string(info.param.shape == CellShape::triangle ? "triangle" : "quadrilateral") +
                                  std::to_string(info.param.degree);
                         });

}  // namespace ricochet::test_support::elements_test
