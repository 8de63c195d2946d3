#include "ricochet/fem/elastic_cells.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "ricochet/fem/point_law.hpp"
#include "ricochet/problem/finite_elasticity.hpp"
#include "support/bent_body.hpp"
#include "support/errors.hpp"

/// @file Energy, force and tangent of bodies with any material law, on all cells.
namespace ricochet::test_support::elastic_cells_test {

struct Kind {
  ElementKind element;
  std::string law;
  bool mean_dilatation = false;
  PlaneState plane = PlaneState::strain;
};

Parameters parameters_of(const std::string& law) {
  if (law == "mooney-rivlin") return {{"c10", 0.3}, {"c01", 0.1}, {"bulk_modulus", 2.0}};
  return {{"lambda", 1.3}, {"mu", 0.8}};
}

std::vector<Kind> kinds() {
  std::vector<Kind> all;
  for (const ElementKind& element : all_element_kinds()) {
    for (const std::string law : {"linear", "saint-venant-kirchhoff", "neo-hookean", "mooney-rivlin"})
      all.push_back({element, law});
    for (const std::string law : {"neo-hookean", "mooney-rivlin"}) all.push_back({element, law, true});
    if (element.dimension() == 3) continue;
    all.push_back({element, "neo-hookean", false, PlaneState::stress});
    for (const bool mean : {false, true}) all.push_back({element, "neo-hookean", mean, PlaneState::axisymmetric});
  }
  return all;
}

class ElasticCellsOfKind : public ::testing::TestWithParam<Kind> {
 protected:
  void SetUp() override {
    body_ = make_bent_body(kind().element, kind().plane);
    body_->body.materials[0].law = make_material_law(kind().law, parameters_of(kind().law));
    body_->body.materials[0].mean_dilatation = kind().mean_dilatation;
    force_ = std::make_unique<FiniteElasticity>(body_->body, node_graph(body_->space));
  }
  static const Kind& kind() { return GetParam(); }
  static int dimension() { return kind().element.dimension(); }
  static bool has_quadratic_energy() { return kind().law == "linear" || kind().law == "saint-venant-kirchhoff"; }
  [[nodiscard]] Vector random_displacement(double size, unsigned seed) const {
    return test_support::random_displacement(*body_, size, seed);
  }
  [[nodiscard]] Vector turned(const Vector& displacement, const Matrix& rotation) const {
    return test_support::turned(*body_, displacement, rotation);
  }
  /// An axisymmetric body does not rotate in the plane, and forces along x are balanced around the axis.
  [[nodiscard]] static bool is_axisymmetric() { return kind().plane == PlaneState::axisymmetric; }

  std::unique_ptr<MeshedBody> body_;
  std::unique_ptr<FiniteElasticity> force_;
};

TEST_P(ElasticCellsOfKind, ForceIsTheDerivativeOfTheEnergyAndTangentThatOfTheForce) {
  constexpr double h = 1e-5;
  const Vector u = random_displacement(0.03, 1), along = random_displacement(1.0, 2);
  Vector force, before, after;
  force_->evaluate(u, force);
  const double slope = (force_->energy(u + h * along) - force_->energy(u - h * along)) / (2.0 * h);
  EXPECT_NEAR(slope, force.dot(along), 1e-7 * force.norm() * along.norm());
  force_->evaluate(u - h * along, before);
  force_->evaluate(u + h * along, after);
  const Vector wanted = (after - before) / (2.0 * h), found = force_->tangent(u) * along;
  EXPECT_LT((wanted - found).norm(), 1e-6 * wanted.norm());
  const SparseMatrix tangent = force_->tangent(u);
  EXPECT_EQ((tangent - SparseMatrix(tangent.transpose())).norm(), 0.0);
}

TEST_P(ElasticCellsOfKind, IsTheLinearBodyWhereDisplacementsAreSmall) {
  if (kind().mean_dilatation) return;
  const auto& law = *body_->body.materials[0].law;
  Body linear = body_->body;
  linear.materials[0].law = make_linear_elasticity(law.lambda(), law.mu());
  const SparseMatrix stiffness = assemble_stiffness(linear, node_graph(body_->space));
  EXPECT_LT((force_->tangent() - stiffness).norm(), 1e-14 * stiffness.norm());
  const Vector u = random_displacement(1e-9, 3);
  Vector force;
  force_->evaluate(u, force);
  EXPECT_LT((force - stiffness * u).norm(), 1e-7 * force.norm());
  EXPECT_NEAR(force_->energy(u), 0.5 * u.dot(stiffness * u), 1e-7 * force_->energy(u));
}

TEST_P(ElasticCellsOfKind, RotationsChangeNothing) {
  if (kind().law == "linear" || is_axisymmetric() || !kind().element.contains_affine()) return;
  const Vector u = random_displacement(0.03, 4);
  const Matrix rotation = some_rotation(dimension());
  const Vector other = turned(u, rotation);
  EXPECT_NEAR(force_->energy(other), force_->energy(u), 1e-13 * force_->energy(u));
  Vector force, turned_force;
  force_->evaluate(u, force);
  force_->evaluate(other, turned_force);
  const Matrix wanted = rotation * force.reshaped(dimension(), body_->space.node_count());
  EXPECT_LT((turned_force - Vector(wanted.reshaped())).norm(), 1e-12 * force.norm());
}

/// Path between two displacements, given by its middle and its increment.
struct Path {
  Path(const Vector& from, const Vector& to) : middle(0.5 * (from + to)), increment(to - from) {}
  Vector middle, increment;
};

/// Work of the path force less the change of the energy, relative to the energies.
double work_lacking(const FiniteElasticity& force, const Vector& from, const Vector& to, const PathRules& rules) {
  const Path path(from, to);
  Vector result;
  force.path_force(path.middle, path.increment, rules, result);
  const double start = force.energy(from), end = force.energy(to);
  return std::abs(result.dot(path.increment) - (end - start)) / (end + start);
}

TEST_P(ElasticCellsOfKind, ThePathForceDoesTheWorkOfTheEnergy) {
  const Vector from = random_displacement(0.02, 5), change = random_displacement(0.02, 6);
  const std::size_t cells = force_->path_rules().size();
  for (const PathRuleProperties& each : path_rule_table) {
    const PathRules rules(cells, each.rule);
    const double whole = work_lacking(*force_, from, from + change, rules);
    if (each.exact) {
      EXPECT_LT(whole, 1e-13);
      continue;
    }
    EXPECT_LT(whole, 1e-3);
    if (has_quadratic_energy()) {
      EXPECT_LT(whole, 1e-13);
      continue;
    }
    // The error of n points is of order 2n + 1 in the change.
    const double half = work_lacking(*force_, from + 0.25 * change, from + 0.75 * change, rules);
    EXPECT_NEAR(std::log2(whole / half), 2 * each.points + 1, 0.5);
  }
}

TEST_P(ElasticCellsOfKind, ThePathForceIsSelfEquilibrated) {
  if (kind().law == "linear") return;
  const Vector from = random_displacement(0.03, 5);
  const Path path(from, from + random_displacement(0.02, 6));
  const Index d = dimension();
  for (const PathRuleProperties& each : path_rule_table) {
    Vector force;
    force_->path_force(path.middle, path.increment, PathRules(force_->path_rules().size(), each.rule), force);
    const Points forces = force.reshaped(d, body_->space.node_count());
    const Points places = body_->space.nodes + path.middle.reshaped(d, body_->space.node_count());
    EXPECT_LT(std::abs(forces.row(1).sum()), 1e-13 * force.norm());
    if (is_axisymmetric()) continue;
    EXPECT_LT(forces.rowwise().sum().norm(), 1e-13 * force.norm());
    if (!kind().element.contains_affine()) continue;
    const Matrix moments = forces * places.transpose();
    EXPECT_LT((moments - moments.transpose()).norm(), 1e-12 * force.norm());
  }
}

TEST_P(ElasticCellsOfKind, ARigidMotionHasNoPathForce) {
  if (kind().law == "linear" || is_axisymmetric() || !kind().element.contains_affine()) return;
  const Vector rest = Vector::Zero(body_->space.dof_count());
  const Path path(rest, turned(rest, some_rotation(dimension())));
  Vector force;
  for (const PathRuleProperties& each : path_rule_table) {
    force_->path_force(path.middle, path.increment, PathRules(force_->path_rules().size(), each.rule), force);
    EXPECT_LT(force.lpNorm<Eigen::Infinity>(), 1e-13);
  }
}

/// A stretch about a state of rest, whose change of the strain is known, below and above each threshold: the rules are
/// those of the largest change so far.
TEST_P(ElasticCellsOfKind, PathRulesFollowTheChangeOfTheStrain) {
  if (kind().law == "linear" || is_axisymmetric() || !kind().element.contains_affine()) return;
  const Vector rest = Vector::Zero(body_->space.dof_count());
  Vector stretch = rest;
  for (Index node = 0; node < body_->space.node_count(); ++node)
    stretch[node * dimension()] = body_->space.nodes(0, node);
  const std::size_t cells = force_->path_rules().size();
  PathRules rules = force_->path_rules();
  const auto expect = [&](double change, bool raised, PathRule rule) {
    EXPECT_EQ(force_->raise_path_rules(rest, change * stretch, rules), raised) << change;
    EXPECT_EQ(rules, PathRules(cells, rule)) << change;
  };
  expect(0.9e-2, false, PathRule::two_points);
  expect(1.1e-2, true, PathRule::three_points);
  expect(4.5e-2, false, PathRule::three_points);
  expect(5.5e-2, true, PathRule::three_points_exact);
  expect(0.9e-1, false, PathRule::three_points_exact);
  expect(1.1e-1, true, PathRule::five_points_exact);
  expect(0.9e-2, false, PathRule::five_points_exact);
}

/// In homogeneous strain all cells have the stress of the law, with mean dilatation or without.
TEST_P(ElasticCellsOfKind, HomogeneousStrainHasTheStressOfTheLaw) {
  if (!kind().element.contains_affine() || kind().law == "linear" || is_axisymmetric()) return;
  const int d = dimension();
  Matrix gradient(d, d);
  gradient << (d == 2 ? (Matrix(2, 2) << 0.3, -0.2, 0.4, -0.1).finished()
                      : (Matrix(3, 3) << 0.3, -0.2, 0.1, 0.4, -0.1, 0.05, 0.2, -0.15, 0.25).finished());
  const Vector u = Vector((gradient * body_->space.nodes).reshaped());
  Tensor motion = Tensor::Zero();
  motion.topLeftCorner(d, d) = gradient;
  const PointLaw law(*body_->body.materials[0].law, kind().plane == PlaneState::stress);
  const Tensor strain = law.strain(motion);
  Tensor second, deformation = Tensor::Identity() + motion;
  if (d == 2) deformation(2, 2) = std::sqrt(1.0 + 2.0 * strain(2, 2));
  law.stress(strain, second);
  const Tensor cauchy = deformation * second * deformation.transpose() / deformation.determinant();
  std::vector<double> stress, energy;
  CellStress(body_->body).evaluate(u, stress, energy);
  for (std::size_t cell = 0; cell < energy.size(); ++cell) {
    EXPECT_NEAR(energy[cell], law.energy(strain), 1e-13);
    std::size_t at = tensor_components * cell;
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) EXPECT_NEAR(stress[at++], cauchy(i, j), 1e-13) << kind().law;
    }
  }
}

std::string name_of(const ::testing::TestParamInfo<Kind>& info) {
  std::string law = info.param.law;
  std::ranges::replace(law, '-', '_');
  return info.param.element.label() + "_" + law + (info.param.mean_dilatation ? "_mean" : "") +
         (info.param.plane == PlaneState::stress         ? "_plane_stress"
          : info.param.plane == PlaneState::axisymmetric ? "_axisymmetric"
                                                         : "");
}

INSTANTIATE_TEST_SUITE_P(, ElasticCellsOfKind, ::testing::ValuesIn(kinds()), name_of);

/// The message names the inverted cell.
TEST(FiniteElasticity, NamesTheCellThatIsTurnedInsideOut) {
  const auto body = make_meshed_body(make_box_mesh(box_of(CellShape::triangle, {2, 2})), 1);
  body->body.materials[0].law = make_material_law("neo-hookean", parameters_of("neo-hookean"));
  const FiniteElasticity elasticity(body->body, node_graph(body->space));
  Vector u = Vector::Zero(body->space.dof_count()), force;
  u[0] = 3.0;
  expect_error(ErrorKind::not_converged, {"is inverted"}, [&] { elasticity.evaluate(u, force); });
}

}  // namespace ricochet::test_support::elastic_cells_test
