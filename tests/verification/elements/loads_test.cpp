#include <gtest/gtest.h>

#include <cmath>

#include "support/box_mesh.hpp"
#include "support/convergence.hpp"

/// @file Nodal loads of body forces and tractions: their resultant and moment about the origin.
namespace ricochet::test_support::loads_test {

/// Σ f_i and Σ x_i ⊗ f_i: the moment about the origin is the antisymmetric part of the second.
struct Resultant {
  Vector force;
  Matrix first_moment;
};

Resultant resultant(const DisplacementSpace& space, const Vector& load) {
  const int d = space.dimension;
  Resultant result{Vector::Zero(d), Matrix::Zero(d, d)};
  for (Index node = 0; node < space.node_count(); ++node) {
    const Vector force = load.segment(node * d, d);
    result.force += force;
    result.first_moment += space.nodes.col(node) * force.transpose();
  }
  return result;
}

/// ∫ f and ∫ x ⊗ f over [low, high] for f = F x + c; axes with low = high are not integrated over. Three Gauss points
/// per axis are exact.
Resultant exact_resultant(const Vector& low, const Vector& high, const Matrix& slope, const Vector& constant) {
  const Index d = low.size();
  const double points[] = {0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};
  const double weights[] = {5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0};
  Resultant result{Vector::Zero(d), Matrix::Zero(d, d)};
  for (int k = 0; k < int(std::pow(3, d)); ++k) {
    Vector x(d);
    double weight = 1.0;
    for (Index axis = 0, rest = k; axis < d; ++axis, rest /= 3) {
      x[axis] = low[axis] + points[rest % 3] * (high[axis] - low[axis]);
      weight *= weights[rest % 3] * (high[axis] > low[axis] ? high[axis] - low[axis] : 1.0);
    }
    const Vector force = slope * x + constant;
    result.force += weight * force;
    result.first_moment += weight * x * force.transpose();
  }
  return result;
}

Matrix force_slope(int d) {
  Matrix slope(3, 3);
  slope << 0.7, -1.1, 0.4, 0.2, 0.5, -0.8, 1.3, -0.6, 0.9;
  return slope.topLeftCorner(d, d);
}

void expect_equal(const Resultant& found, const Resultant& exact) {
  const double size = exact.first_moment.cwiseAbs().maxCoeff() + exact.force.cwiseAbs().maxCoeff();
  EXPECT_LE((found.force - exact.force).cwiseAbs().maxCoeff(), 1e-14 * size);
  EXPECT_LE((found.first_moment - exact.first_moment).cwiseAbs().maxCoeff(), 1e-14 * size);
}

class NodalLoads : public testing::TestWithParam<ElementKind> {
 protected:
  /// A box [1, 2] × [1, 3] (× [1, 1.5]), distorted inside, with curved cells if the space contains x on them.
  std::unique_ptr<MeshedBody> make_box() const {
    const ElementKind& kind = GetParam();
    const Vector sides = lengths();
    const PointMap inside = kind.contains_affine() ? swirl_map(0.08) : PointMap([](const Vector& x) { return x; });
    const PointMap map = [=](const Vector& x) -> Vector {
      return sides.cwiseProduct(inside(x)) + Vector::Ones(x.size());
    };
    const std::vector<int> counts = kind.dimension() == 2 ? std::vector<int>{3, 4} : std::vector<int>{3, 2, 2};
    return make_meshed_body(make_checked_box_mesh({kind.shape, counts, kind.geometry_degree, 0.15, map}),
                            kind.displacement_degree);
  }
  Vector lengths() const {
    Vector all(3);
    all << 1.0, 2.0, 0.5;
    return all.head(GetParam().dimension());
  }
};

TEST_P(NodalLoads, LinearBodyForceHasItsResultantAndMoment) {
  const auto test = make_box();
  const int d = test->mesh.dimension;
  const Matrix slope = force_slope(d);
  const Vector constant = Vector::LinSpaced(d, -1.0, 2.0);
  Vector load = Vector::Zero(test->space.dof_count());
  add_body_load(
      test->body, [&](const Vector& x, Vector& force) { force = slope * x + constant; }, load);
  const Vector low = Vector::Ones(d);
  expect_equal(resultant(test->space, load), exact_resultant(low, low + lengths(), slope, constant));
}

TEST_P(NodalLoads, LinearTractionHasItsResultantAndMoment) {
  const auto test = make_box();
  const int d = test->mesh.dimension;
  const Matrix slope = force_slope(d);
  const Vector constant = Vector::LinSpaced(d, -1.0, 2.0);
  for (int axis = 0; axis < d; ++axis) {
    for (const int end : {0, 1}) {
      Vector load = Vector::Zero(test->space.dof_count());
      const std::string side = std::string(1, "xyz"[axis]) + (end == 1 ? "1" : "0");
      add_facet_load(
          test->body, test->mesh.group(side, d - 1).members,
          [&](const Vector& x, Vector& force) { force = slope * x + constant; }, load);
      Vector low = Vector::Ones(d);
      Vector high = low + lengths();
      (end == 1 ? low : high)[axis] = (end == 1 ? high : low)[axis];
      SCOPED_TRACE(side);
      expect_equal(resultant(test->space, load), exact_resultant(low, high, slope, constant));
    }
  }
}

TEST_P(NodalLoads, AddToWhatIsThere) {
  const auto test = make_box();
  const int d = test->mesh.dimension;
  const ForceDensity force = [](const Vector& x, Vector& density) { density = x; };
  Vector once = Vector::Zero(test->space.dof_count());
  add_facet_load(test->body, test->mesh.group("x1", d - 1).members, force, once);
  add_body_load(test->body, force, once);
  Vector twice = once;
  add_facet_load(test->body, test->mesh.group("x1", d - 1).members, force, twice);
  add_body_load(test->body, force, twice);
  // Each entry is a sum over some hundred quadrature points, here with another initial value.
  EXPECT_LE((twice - 2.0 * once).cwiseAbs().maxCoeff(), 1e-14 * once.cwiseAbs().maxCoeff());
  EXPECT_GT(once.cwiseAbs().maxCoeff(), 0.0);
}

/// The traction f = x on the circle or sphere of radius one: Σ f·x is its length or area, ∮ x x = ⅓ or ½ of that.
TEST_P(NodalLoads, OnACircleOrSphereConverge) {
  const ElementKind& kind = GetParam();
  const int d = kind.dimension();
  const double area = d == 2 ? 2.0 * M_PI : 4.0 * M_PI;
  Convergence errors(kind.label());
  for (const int count : d == 2 ? std::vector<int>{4, 8, 16, 32} : std::vector<int>{2, 4, 8, 16}) {
    const auto test = make_meshed_body(make_box_mesh({kind.shape, std::vector<int>(std::size_t(d), count),
                                                      kind.geometry_degree, 0.15, ball_map(Vector::Zero(d))}),
                                       kind.displacement_degree);
    Vector constant = Vector::Zero(test->space.dof_count());
    const std::vector<Index>& all = test->mesh.group("boundary", d - 1).members;
    add_facet_load(
        test->body, all, [](const Vector&, Vector& force) { force.setOnes(); }, constant);
    Vector linear = Vector::Zero(test->space.dof_count());
    add_facet_load(
        test->body, all, [](const Vector& x, Vector& force) { force = x; }, linear);
    const Matrix moment = resultant(test->space, linear).first_moment;
    errors.add(std::max((resultant(test->space, constant).force / area - Vector::Ones(d)).cwiseAbs().maxCoeff(),
                        (d * moment / area - Matrix::Identity(d, d)).cwiseAbs().maxCoeff()));
  }
  const double expected = kind.geometry_degree == 2 && kind.displacement_degree == 2 ? 3.0 : 2.0;
  EXPECT_GE(errors.last_order(), expected - 0.25);
}

INSTANTIATE_TEST_SUITE_P(Elements, NodalLoads, testing::ValuesIn(all_element_kinds()),
                         [](const auto& info) { return info.param.label(); });

}  // namespace ricochet::test_support::loads_test
