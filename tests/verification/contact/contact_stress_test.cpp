#include "ricochet/contact/contact_stress.hpp"
#include "ricochet/contact/construction/make_contact_boundary.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/contact/multipliers/multiplier_space.hpp"
#include "ricochet/problem/internal_force.hpp"
#include "support/box_mesh.hpp"

// Stress at the contact points, compared with uniform strains for every element and multiplier space; and the stiffness
// that bounds it, compared with the largest possible one.

namespace ricochet::test_support::contact_stress_test {

struct Side {
  std::unique_ptr<MeshedBody> test;
  std::unique_ptr<Obstacle> obstacle;
  ContactBoundary boundary;
  Vector outward, normal;  ///< of the body and of the obstacle, which is tilted

  Side(const ElementKind& kind, const std::string& multipliers) {
    const int d = kind.dimension();
    test = make_meshed_body(make_checked_box_mesh({kind.shape, std::vector<int>(std::size_t(d), 2),
                                                   kind.geometry_degree, 0.15, swirl_map(0.03)}),
                            kind.displacement_degree);
    outward = -Vector::Unit(d, d - 1);
    normal = (-outward + 0.2 * Vector::Unit(d, 0)).normalized();
    obstacle = make_plane(Vector::Constant(d, -0.5), normal);
    const std::string group = d == 2 ? "y0" : "z0";
    const ContactPair pair{group, test->mesh.group(group, d - 1).members, "plane", obstacle.get(), {}, multipliers};
    boundary = make_contact_boundary(test->body, {pair}, [](Index, int) { return true; });
  }
};

void each_side(const std::function<void(const Side&, const std::string&)>& check) {
  for (const ElementKind& kind : all_element_kinds()) {
    for (const std::string& multipliers : multiplier_space_names()) {
      if (kind.contains_affine()) check(Side(kind, multipliers), kind.label() + ' ' + multipliers);
    }
  }
}

TEST(ContactStress, IsExactForUniformStrainsAndZeroForRigidMotions) {
  each_side([](const Side& side, const std::string& label) {
    const int d = side.boundary.dimension;
    Matrix gradient(d, d), spin = Matrix::Zero(d, d);
    for (int i = 0; i < d; ++i) {
      for (int j = 0; j < d; ++j) gradient(i, j) = 0.3 * i - 0.7 * j + 0.2 * i * j + 0.1;
    }
    spin(0, 1) = 0.4;
    spin(1, 0) = -0.4;
    const Vector shift = Vector::LinSpaced(d, 0.5, -0.3);
    const auto forces = [&](const Matrix& a) {
      return Vector(make_contact_stress(side.test->body, side.boundary).rows *
                    interpolate(side.test->space, [&](const Vector& x) -> Vector { return a * x + shift; }));
    };
    Matrix stress(d, d);
    linear_law(side.test->body, side.test->body.materials[0])
        .stress(Matrix(0.5 * (gradient + gradient.transpose())), stress);
    const Vector expected = side.boundary.weights * side.normal.dot(stress * side.outward);
    const double size = expected.lpNorm<Eigen::Infinity>();
    EXPECT_GT(size, 0.0) << label;
    EXPECT_LT((forces(gradient) - expected).lpNorm<Eigen::Infinity>(), 1e-11 * size) << label;
    EXPECT_LT(forces(spin).lpNorm<Eigen::Infinity>(), 1e-11 * size) << label;
  });
}

TEST(ContactStress, HasAStiffnessThatBoundsItByTheElasticEnergy) {
  each_side([](const Side& side, const std::string& label) {
    const ContactStress stress = make_contact_stress(side.test->body, side.boundary);
    // Largest Σ s²/κ over U with UᵀKU = 1.
    const SymmetricEigen modes =
        symmetric_eigen(Matrix(assemble_stiffness(side.test->body, node_graph(side.test->space))));
    const int d = side.boundary.dimension;
    const Index rest = modes.values.size() - d * (d + 1) / 2;
    Matrix rows = Matrix(stress.rows) * modes.vectors.rightCols(rest) *
                  modes.values.tail(rest).cwiseSqrt().cwiseInverse().asDiagonal();
    for (Index i = 0; i < rows.rows(); ++i) {
      if (stress.stiffness[i] > 0.0) rows.row(i) /= std::sqrt(stress.stiffness[i]);
    }
    const Vector values = symmetric_eigenvalues(Matrix(rows * rows.transpose()));
    EXPECT_LE(values[values.size() - 1], 1.0 + 1e-10) << label;
    EXPECT_GE(values[values.size() - 1], 0.1) << label << ": the bound is of the right size";
  });
}

}  // namespace ricochet::test_support::contact_stress_test
