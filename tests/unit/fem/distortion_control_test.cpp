#include "ricochet/fem/distortion_control.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "ricochet/fem/distortion_law.hpp"
#include "support/bent_body.hpp"

/// @file Control of distorted cells: differences of its energy, its work along paths of the strain, and its limits.
namespace ricochet::test_support {
namespace {

/// Strain of a stretch by j^(1/3) in all directions, and a shear.
Tensor strain_of(double volume) {
  Tensor deformation = std::cbrt(volume) * Tensor::Identity();
  deformation(0, 1) = 0.3;
  deformation(1, 2) = -0.2;
  return 0.5 * (deformation.transpose() * deformation - Tensor::Identity());
}

TEST(DistortionLaw, HasEnergyBelowItsVolumeRatioOnly) {
  const auto law = make_distortion_law(3.0);
  StressTangent tangent;
  Tensor stress;
  for (const double volume : {0.21, 0.5, 1.0, 7.0}) {
    law->stress(strain_of(volume), stress);
    law->tangent(strain_of(volume), tangent);
    EXPECT_EQ(law->energy(strain_of(volume)), 0.0);
    EXPECT_EQ(stress.norm(), 0.0);
    EXPECT_EQ(tangent.norm(), 0.0);
  }
  for (const double part : {0.9, 0.5, 0.1, 1e-3}) {
    const double wanted = 3.0 * std::pow(1.0 - part, 3) / part;
    EXPECT_NEAR(law->energy(strain_of(part * distortion_volume_ratio)), wanted, 1e-8 * wanted);
  }
}

TEST(DistortionLaw, HasTheStressAndTheTangentOfItsEnergy) {
  const auto law = make_distortion_law(3.0);
  Tensor direction;
  direction << 0.3, -0.2, 0.5, -0.2, 0.1, 0.4, 0.5, 0.4, -0.6;
  for (const double volume : {0.19, 0.1, 0.03}) {
    const Tensor strain = strain_of(volume);
    const double h = 1e-6 * volume;
    Tensor stress, after, before;
    StressTangent tangent;
    law->stress(strain, stress);
    law->tangent(strain, tangent);
    law->stress(strain + h * direction, after);
    law->stress(strain - h * direction, before);
    const double slope = (law->energy(strain + h * direction) - law->energy(strain - h * direction)) / (2.0 * h);
    EXPECT_NEAR((stress.array() * direction.array()).sum(), slope, 1e-7 * (std::abs(slope) + stress.norm()));
    Eigen::Matrix<double, 6, 1> components;
    components << direction.diagonal(), 2.0 * direction(0, 1), 2.0 * direction(1, 2), 2.0 * direction(2, 0);
    const Eigen::Matrix<double, 6, 1> product = tangent * components;
    const Tensor wanted = (after - before) / (2.0 * h);
    Eigen::Matrix<double, 6, 1> components_of;
    components_of << wanted.diagonal(), wanted(0, 1), wanted(1, 2), wanted(2, 0);
    EXPECT_LT((product - components_of).norm(), 1e-6 * wanted.norm()) << volume;
  }
}

class ControlledBody : public testing::TestWithParam<BodyKind> {
 protected:
  void SetUp() override {
    body_ = make_bent_body(GetParam().element, GetParam().plane);
    body_->body.materials[0].law = make_material_law("neo-hookean", {{"lambda", 1.3}, {"mu", 0.8}});
    graph_ = node_graph(body_->space);
    applies_ = DistortionControl::applies_to(body_->body);
    if (applies_) control_.emplace(body_->body, graph_, std::vector<int>());
  }
  /// Uniform squeezing along the first axis, and a random part.
  [[nodiscard]] Vector squeezed(double stretch, double size, unsigned seed) const {
    const PointMap field = [&](const Vector& x) { return Vector((stretch - 1.0) * x[0] * Vector::Unit(x.size(), 0)); };
    return interpolate(body_->space, field) + random_displacement(*body_, size, seed);
  }
  /// Volume ratio of a squeezed body without the random part: rings have the same stretch along their circumference.
  [[nodiscard]] double volume_of(double stretch) const {
    return GetParam().plane == PlaneState::axisymmetric ? stretch * stretch : stretch;
  }

  std::unique_ptr<MeshedBody> body_;
  NodeGraph graph_;
  bool applies_ = false;
  std::optional<DistortionControl> control_;
};

TEST_P(ControlledBody, IsOneWhoseNodesAreOutsideItsQuadraturePoints) {
  const ElementKind& element = GetParam().element;
  EXPECT_EQ(applies_, !is_simplex(element.shape) || element.geometry_degree == 2 || element.displacement_degree == 2);
}

TEST_P(ControlledBody, FindsTheSmallestVolume) {
  if (!applies_ || !GetParam().element.contains_affine()) return;
  for (const double stretch : {0.7, 0.1, -0.3}) {
    const CellVolume found = control_->smallest_volume(squeezed(stretch, 0.0, 1));
    EXPECT_NEAR(found.volume_ratio, volume_of(stretch), 1e-12);
    EXPECT_GE(found.cell, 0);
  }
  EXPECT_EQ(control_->smallest_volume(squeezed(1.5, 0.0, 1)).cell, -1);
}

TEST_P(ControlledBody, HasNoForceWhereVolumesAreLarge) {
  if (!applies_) return;
  const Vector still = random_displacement(*body_, 0.02, 1);
  Vector force = Vector::Zero(still.size());
  EXPECT_EQ(control_->energy(still), 0.0);
  EXPECT_EQ(control_->add_force(still, force).cell, -1);
  EXPECT_EQ(force.norm(), 0.0);
}

TEST_P(ControlledBody, DerivesForceAndTangentFromItsEnergy) {
  if (!applies_) return;
  const Vector at = squeezed(0.35, 0.002, 1), along = random_displacement(*body_, 1.0, 2);
  if (control_->energy(at) == 0.0) return;
  constexpr double h = 1e-6;
  Vector force = Vector::Zero(at.size()), after = force, before = force;
  ASSERT_EQ(control_->add_force(at, force).cell, -1);
  ASSERT_EQ(control_->add_force(at + h * along, after).cell, -1);
  ASSERT_EQ(control_->add_force(at - h * along, before).cell, -1);
  const double slope = (control_->energy(at + h * along) - control_->energy(at - h * along)) / (2.0 * h);
  EXPECT_NEAR(force.dot(along), slope, 1e-6 * force.norm() * along.norm());
  SparseMatrix tangent(at.size(), at.size());
  control_->add_tangent(at, tangent);
  EXPECT_LT((tangent * along - (after - before) / (2.0 * h)).norm(), 1e-5 * (tangent * along).norm());
}

/// Into the distortion and through it: the work along the path is the change of the energy.
TEST_P(ControlledBody, DoesTheWorkOfItsEnergyAlongAPath) {
  if (!applies_ || !GetParam().element.contains_affine()) return;
  const double least = GetParam().plane == PlaneState::axisymmetric ? 0.35 : 0.12;
  const Vector start = squeezed(2.0 * least, 0.002, 1), end = squeezed(least, 0.002, 2);
  const Vector middle = 0.5 * (start + end), increment = end - start;
  Vector force = Vector::Zero(start.size());
  ASSERT_EQ(control_->add_path_force(middle, increment, force).cell, -1);
  ASSERT_GT(control_->energy(end), 0.0);
  EXPECT_NEAR(force.dot(increment), control_->energy(end) - control_->energy(start), 1e-12 * control_->energy(end));
  SparseMatrix tangent(start.size(), start.size());
  const Vector along = random_displacement(*body_, 1.0, 3);
  control_->add_path_tangent(middle, increment, of_path_end, tangent);
  constexpr double h = 1e-6;
  Vector after = Vector::Zero(start.size()), before = after;
  const auto path_force = [&](double size, Vector& result) {
    return control_->add_path_force(middle + of_path_end.middle * size * along,
                                    increment + of_path_end.increment * size * along, result);
  };
  ASSERT_EQ(path_force(h, after).cell, -1);
  ASSERT_EQ(path_force(-h, before).cell, -1);
  EXPECT_LT((tangent * along - (after - before) / (2.0 * h)).norm(), 1e-5 * (tangent * along).norm());
}

INSTANTIATE_TEST_SUITE_P(Bodies, ControlledBody, testing::ValuesIn(all_body_kinds()),
                         [](const auto& info) { return info.param.label(); });

}  // namespace
}  // namespace ricochet::test_support
