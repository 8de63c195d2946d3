#include <gtest/gtest.h>

#include "ricochet/problem/finite_elasticity.hpp"
#include "support/bent_body.hpp"

/// @file Viscoelastic branches on all cells: energy, forces, dissipation.
namespace ricochet::test_support::branches_test {

class BranchesOfKind : public ::testing::TestWithParam<BodyKind> {
 protected:
  static constexpr double step = 0.7;

  void SetUp() override {
    body_ = make_bent_body(kind().element, kind().plane);
    Material& material = body_->body.materials[0];
    material.law = make_material_law("neo-hookean", {{"lambda", 1.3}, {"mu", 0.8}});
    material.relaxation = {{0.5, 0.3}, {2.0, 4.0}};
    force_ = std::make_unique<FiniteElasticity>(body_->body, node_graph(body_->space));
    force_->relax(some_displacement(0.05, 1), internal_);
  }
  static const BodyKind& kind() { return GetParam(); }
  static int dimension() { return kind().element.dimension(); }
  [[nodiscard]] Vector some_displacement(double size, unsigned seed) const {
    return random_displacement(*body_, size, seed);
  }
  [[nodiscard]] Vector turned(const Vector& displacement, const Matrix& rotation) const {
    return test_support::turned(*body_, displacement, rotation);
  }

  std::unique_ptr<MeshedBody> body_;
  std::unique_ptr<FiniteElasticity> force_;
  Vector internal_;
};

TEST_P(BranchesOfKind, ThePotentialOfTheStartIsTheStoredEnergyWithoutTimeToRelax) {
  const Vector u = some_displacement(0.05, 2), middle = some_displacement(0.05, 6), end = some_displacement(0.05, 7);
  const Vector increment = end - middle;
  EXPECT_NEAR(force_->start_energy({middle, increment, u, end, internal_, 1e-12}, u),
              force_->branch_energy(u, internal_), 1e-10);
}

TEST_P(BranchesOfKind, TheWorkOfAStepIsStoredAndDissipated) {
  const Vector start = some_displacement(0.05, 2), end = some_displacement(0.05, 4);
  const Vector middle = 0.5 * (start + end), increment = end - start;
  const Vector direction = some_displacement(1.0, 3);
  for (const double h : {1e-6, 0.1, 1.0, 1e4}) {
    const BranchStep over{middle, increment, start, end, internal_, h};
    Vector force = Vector::Zero(end.size()), next;
    force_->add_mean_force(over, force);
    const double dissipated = force_->advance_internal(over, next), before = force_->branch_energy(start, internal_);
    EXPECT_GE(dissipated, 0.0);
    EXPECT_NEAR(force.dot(increment), force_->branch_energy(end, next) - before + dissipated, 1e-13 * before) << h;
    // The force at the end is the derivative of the energy with the internal strains there, a polynomial of degree 4:
    // extrapolated differences have no error but rounding.
    Vector at_end = Vector::Zero(end.size());
    force_->add_end_force(over, at_end);
    const auto difference = [&](double small) {
      return (force_->branch_energy(end + small * direction, next) -
              force_->branch_energy(end - small * direction, next)) /
             (2.0 * small);
    };
    EXPECT_NEAR(at_end.dot(direction), (4.0 * difference(0.01) - difference(0.02)) / 3.0, 1e-10 * before);
  }
}

TEST_P(BranchesOfKind, NothingChangesWhereTheMotionIsTurned) {
  // The displacement space contains rotations.
  if (kind().plane == PlaneState::axisymmetric || !kind().element.contains_affine()) return;
  const Matrix rotation = some_rotation(dimension());
  const Vector start = some_displacement(0.05, 2), end = some_displacement(0.05, 4);
  EXPECT_NEAR(force_->branch_energy(turned(start, rotation), internal_), force_->branch_energy(start, internal_),
              1e-12 * force_->branch_energy(start, internal_));
  const auto advance = [&](const Vector& from, const Vector& to, Vector& next, Vector& force) {
    const Vector middle = 0.5 * (from + to), increment = to - from;
    const BranchStep over{middle, increment, from, to, internal_, step};
    force.setZero(to.size());
    force_->add_mean_force(over, force);
    return force_->advance_internal(over, next);
  };
  Vector next, other, force, turned_force;
  const double dissipated = advance(start, end, next, force);
  EXPECT_NEAR(advance(turned(start, rotation), turned(end, rotation), other, turned_force), dissipated,
              1e-12 * dissipated);
  EXPECT_LT((next - other).lpNorm<Eigen::Infinity>(), 1e-13);
  const Points expected = rotation * force.reshaped(dimension(), body_->space.node_count());
  EXPECT_LT((turned_force - Vector(expected.reshaped())).norm(), 1e-12 * force.norm());
  // A rigid motion of any size from a stress-free state causes no stress and no dissipation.
  force_->relax(start, internal_);
  EXPECT_LT(advance(start, turned(start, rotation), next, force), 1e-26);
  EXPECT_LT(force.lpNorm<Eigen::Infinity>(), 1e-13);
}

TEST_P(BranchesOfKind, TheTangentHasTheStiffnessOfAStep) {
  const Vector u = some_displacement(1e-6, 2), direction = some_displacement(1e-6, 3);
  const SparseMatrix with = force_->step_tangent(Vector(), step), without = force_->tangent(Vector());
  internal_.setZero();
  const auto mean_force = [&](const Vector& end) {
    const Vector middle = 0.5 * end;
    Vector force = Vector::Zero(end.size());
    force_->add_mean_force({middle, end, Vector::Zero(end.size()), end, internal_, step}, force);
    return force;
  };
  const Vector expected = mean_force(u + direction) - mean_force(u - direction);
  EXPECT_LT(((with - without) * direction - expected).norm(), 1e-4 * expected.norm());
}

TEST_P(BranchesOfKind, CellStressHasThem) {
  const Vector u = some_displacement(0.05, 5);
  std::vector<double> stress, energy, alone, energy_alone;
  const CellStress of_cells(body_->body);
  of_cells.evaluate(u, stress, energy, internal_);
  of_cells.evaluate(u, alone, energy_alone);
  const Vector volumes = cell_volumes(body_->body);
  double more = 0.0;
  for (std::size_t i = 0; i < energy.size(); ++i) more += volumes[Index(i)] * (energy[i] - energy_alone[i]);
  EXPECT_NEAR(more, force_->branch_energy(u, internal_), 1e-12 * more);
  EXPECT_NE(stress, alone);
}

INSTANTIATE_TEST_SUITE_P(All, BranchesOfKind, ::testing::ValuesIn(all_body_kinds()),
                         [](const auto& info) { return info.param.label(); });

}  // namespace ricochet::test_support::branches_test
