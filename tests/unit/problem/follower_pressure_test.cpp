#include "ricochet/problem/follower_pressure.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "support/bent_body.hpp"

/// @file Forces of a pressure that follows the surface, on facets of all kinds.
namespace ricochet::test_support {
namespace {

class Pressed : public testing::TestWithParam<BodyKind> {
 protected:
  void SetUp() override { body_ = make_bent_body(element(), GetParam().plane); }
  static const ElementKind& element() { return GetParam().element; }
  static int dimension() { return element().dimension(); }
  static bool is_axisymmetric() { return GetParam().plane == PlaneState::axisymmetric; }

  [[nodiscard]] const std::vector<Index>& side(const std::string& name) const {
    return body_->mesh.group(name, dimension() - 1).members;
  }
  [[nodiscard]] FollowerPressure pressure(const std::string& group, const Expression& value) const {
    FollowerPressure result(body_->body);
    result.add(side(group), value);
    return result;
  }
  [[nodiscard]] Vector force(const FollowerPressure& pressure, const Vector& u, double time = 0.0) const {
    Vector result = Vector::Zero(body_->space.dof_count());
    pressure.add_force(u, time, result);
    return result;
  }
  [[nodiscard]] Vector random(double size, unsigned seed) const { return random_displacement(*body_, size, seed); }
  /// Volume of the deformed body, summed over its cells.
  [[nodiscard]] double volume(const Vector& u) const { return dimension() == 2 ? volume_of<2>(u) : volume_of<3>(u); }

  std::unique_ptr<MeshedBody> body_;

 private:
  template <int d>
  [[nodiscard]] double volume_of(const Vector& u) const {
    constexpr int exact = 12;
    double sum = 0.0;
    for (std::size_t b = 0; b < body_->mesh.cells.size(); ++b) {
      const CellBlock &cells = body_->mesh.cells[b], &space = body_->space.cells[b];
      const BlockIntegration rule(cells.shape, body_->mesh.degree, body_->space.degree, exact);
      for (Index cell = 0; cell < cells.size(); ++cell) {
        for (Index q = 0; q < rule.rule.weights.size(); ++q) {
          const auto number = std::size_t(q);
          auto map = jacobian<d>(body_->mesh.nodes, cells.cell(cell), rule.geometry.gradients[number]);
          double radius = rule.radius(body_->mesh.nodes, cells.cell(cell), q);
          for (Index k = 0; k < space.nodes_per_cell; ++k) {
            const auto own = u.segment<d>(space.cell(cell)[k] * d);
            map += own * rule.displacement.gradients[number].row(k);
            radius += own[0] * rule.displacement.values(k, q);
          }
          const double ring = is_axisymmetric() ? 2.0 * std::numbers::pi * radius : 1.0;
          sum += rule.rule.weights[q] * map.determinant() * ring;
        }
      }
    }
    return sum;
  }
};

/// The virtual work of p on the whole boundary is −p times the change of volume, a cubic polynomial.
TEST_P(Pressed, AllRoundItDoesTheWorkOfTheVolume) {
  const Vector u = random(0.04, 1), along = random(1.0, 2);
  const auto change = [&](double h) { return volume(u + h * along) - volume(u - h * along); };
  const double slope = (8.0 * change(0.5) - change(1.0)) / 6.0;
  const Vector load = force(pressure("boundary", Expression(0.7)), u);
  EXPECT_NEAR(load.dot(along), -0.7 * slope, 1e-12 * load.norm() * along.norm());
}

TEST_P(Pressed, AllRoundItHasNeitherResultantNorMoment) {
  const Vector u = random(0.04, 1);
  const int d = dimension();
  const Matrix forces = force(pressure("boundary", Expression(0.7)), u).reshaped(d, body_->space.node_count());
  const Matrix places = body_->space.nodes + u.reshaped(d, body_->space.node_count());
  const Vector resultant = forces.rowwise().sum();
  EXPECT_NEAR(resultant[d - 1], 0.0, 1e-13);
  if (is_axisymmetric()) return;
  EXPECT_LT(resultant.norm(), 1e-13);
  if (!element().contains_affine()) return;
  const Matrix moments = places * forces.transpose();
  EXPECT_LT((moments - moments.transpose()).norm(), 1e-13);
}

/// If F is homogeneous, the force on a flat side of area A is −p A cof(F) N.
TEST_P(Pressed, OnAFlatSideItIsThatOfNanson) {
  if (element().geometry_degree == 2 || is_axisymmetric()) return;
  const int d = dimension();
  Matrix gradient(3, 3);
  gradient << 0.3, 0.7, -0.2, -0.4, 0.5, 0.1, 0.2, -0.3, 0.6;
  const Matrix h = gradient.topLeftCorner(d, d);
  const Vector u = interpolate(body_->space, [&](const Vector& x) { return Vector(h * x); });
  const Matrix f = Matrix::Identity(d, d) + h;
  const Matrix cofactor = f.determinant() * f.inverse().transpose();
  for (int axis = 0; axis < d; ++axis) {
    for (const bool far : {false, true}) {
      const std::string name = std::string(1, "xyz"[axis]) + (far ? "1" : "0");
      const Matrix forces = force(pressure(name, Expression(0.7)), u).reshaped(d, body_->space.node_count());
      const Vector normal = (far ? 1.0 : -1.0) * Vector::Unit(d, axis);
      EXPECT_LT((forces.rowwise().sum() + 0.7 * cofactor * normal).norm(), 1e-14) << name;
    }
  }
}

/// Forces are quadratic functions of the displacement, so differences are exact.
TEST_P(Pressed, StiffnessIsTheSymmetricPartOfTheDerivative) {
  const Vector u = random(0.04, 1), v = random(1.0, 2), w = random(1.0, 3);
  for (const std::string group : {"boundary", "x1"}) {
    const FollowerPressure all = pressure(group, Expression(group == "x1" ? "0.7+0.2*y" : "0.7"));
    const auto slope = [&](const Vector& along) {
      return Vector(0.5 * (force(all, u + along) - force(all, u - along)));
    };
    const Vector along_v = slope(v), along_w = slope(w);
    const SparseMatrix stiffness = all.stiffness(u);
    const double size = along_v.norm() * w.norm();
    EXPECT_NEAR(w.dot(stiffness * v), -0.5 * (w.dot(along_v) + v.dot(along_w)), 1e-13 * size) << group;
    EXPECT_EQ((stiffness - SparseMatrix(stiffness.transpose())).norm(), 0.0);
    if (group == "x1") continue;
    EXPECT_LT((stiffness * v + along_v).norm(), 1e-13 * along_v.norm());  // there are no edges
  }
}

TEST_P(Pressed, TheStiffnessOfTheMeanIsTheWholeDerivative) {
  const Vector u = random(0.04, 1), along = random(1.0, 2);
  const FollowerPressure pressed = pressure("x1", Expression("0.7+0.2*y+0.3*t"));
  const auto mean = [&](const Vector& at) {
    Vector force = Vector::Zero(at.size());
    pressed.add_mean_force(at, 0.5, 2.0, force);
    return force;
  };
  const Vector slope = 0.5 * (mean(u + along) - mean(u - along));
  EXPECT_LT((pressed.mean_stiffness(u, 0.5, 2.0) * along + slope).norm(), 1e-13 * slope.norm());
}

TEST_P(Pressed, TimeAndParts) {
  const Vector u = random(0.04, 1);
  const FollowerPressure rising = pressure("x1", Expression("2+3*t+x")), still = pressure("x1", Expression("2+x"));
  const FollowerPressure one = pressure("x1", Expression(1.0));
  const Vector unit = force(one, u);
  EXPECT_LT((force(rising, u, 2.0) - force(still, u) - 6.0 * unit).norm(), 1e-13);
  Vector mean = Vector::Zero(u.size()), part = mean;
  rising.add_mean_force(u, 1.0, 3.0, mean);
  EXPECT_LT((mean - force(rising, u, 2.0)).norm(), 1e-13);
  rising.add_force(u, 2.0, part, 0.25);
  EXPECT_LT((part - 0.25 * mean).norm(), 1e-13);
  EXPECT_EQ(rising.last().part, 0.25);
}

INSTANTIATE_TEST_SUITE_P(FollowerPressure, Pressed, testing::ValuesIn(all_body_kinds()),
                         [](const auto& info) { return info.param.label(); });

}  // namespace
}  // namespace ricochet::test_support
