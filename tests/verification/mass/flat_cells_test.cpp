#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <cstdio>

#include "support/errors.hpp"
#include "support/mass_bodies.hpp"
#include "support/mass_moments.hpp"
#include "support/uniform.hpp"

// An affine map of a mesh preserves the relative positions of nodes and, up to one factor, the consistent mass: the
// equivalent mass must be the same, however flat the map makes the cells.

namespace ricochet::test_support::flat_cells_test {

Matrix rotation(Index dimension, std::mt19937& random) {
  Matrix matrix(dimension, dimension);
  for (double& entry : matrix.reshaped()) entry = uniform(random);
  return Eigen::HouseholderQR<Matrix>(matrix).householderQ();
}

/// A map that stretches by 1 to `ratio` in random directions.
Matrix affine_map(Index dimension, double ratio, std::mt19937& random) {
  Vector stretch = Vector::Ones(dimension);
  for (Index k = 1; k < dimension; ++k) stretch[k] = k == 1 ? ratio : std::pow(ratio, 0.5 + 0.5 * uniform(random));
  return rotation(dimension, random) * stretch.asDiagonal() * rotation(dimension, random);
}

/// The body after x ↦ A x + b. Its mass is multiplied by |det A|.
struct MappedBody {
  Points nodes;
  SparseMatrix consistent;
  MassInput input;
  MappedBody(const AssembledBody& body, const Matrix& map, const Vector& shift)
      : nodes((map * body.space.nodes).colwise() + shift),
        consistent(std::abs(map.determinant()) * body.consistent),
        input{&consistent, &nodes, body.input.contact_nodes} {}
};

/// Largest defect of mass, centre and inertia, evaluated without small numbers: affine functions of the rounded mapped
/// positions are affine functions of the positions mapped back.
double defect(const SparseMatrix& mass, const MappedBody& mapped, const Matrix& map, const Vector& shift) {
  using Long = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  Long monomials(mapped.nodes.cols(), mapped.nodes.rows() + 1);
  monomials.col(0).setOnes();
  monomials.rightCols(mapped.nodes.rows()) =
      (map.cast<long double>().inverse() *
       (mapped.nodes.cast<long double>().colwise() - shift.cast<long double>().col(0)))
          .transpose();
  const auto moments = [&](const SparseMatrix& matrix) {
    Long product = Long::Zero(monomials.rows(), monomials.cols());
    for (Index j = 0; j < matrix.cols(); ++j) {
      for (SparseMatrix::InnerIterator entry(matrix, j); entry; ++entry)
        product.row(j) += static_cast<long double>(entry.value()) * monomials.row(entry.row());
    }
    return Long(monomials.transpose() * product);
  };
  const Long wanted = moments(mapped.consistent);
  return double((moments(mass) - wanted).cwiseAbs().maxCoeff() / wanted.cwiseAbs().maxCoeff());
}

TEST(FlatCells, TheEquivalentMassOfAMappedMeshIsThatOfTheMesh) {
  std::mt19937 random(11);
  for (const char* name : {"strip, 2 thick", "strip, 3 thick, around", "disc, h 0.25", "disc, quads, degree 2",
                           "ball, h 0.4", "plate, 1 thick", "plate, 2 thick", "brick, hexahedra, around"}) {
    const AssembledBody body(body_of_kind(name));
    const Index d = body.space.nodes.rows();
    const SparseMatrix plain = build_mass("equivalent-nodewise", body.input);
    for (const double ratio : {1.0, 5.0, 100.0, 1000.0}) {
      const Matrix map = affine_map(d, ratio, random);
      const Vector shift = 3.0 * ratio * Vector::Ones(d);
      const MappedBody mapped(body, map, shift);
      const SparseMatrix found = build_mass("equivalent-nodewise", mapped.input);
      const double largest = plain.coeffs().cwiseAbs().maxCoeff();
      const SparseMatrix change = found / std::abs(map.determinant()) - plain;
      const double difference = change.coeffs().cwiseAbs().maxCoeff();
      std::printf("%-26s %6.0f:1  entries differ by %.1e, moments by %.1e\n", name, ratio, difference / largest,
                  defect(found, mapped, map, shift));
      EXPECT_EQ(found.nonZeros(), plain.nonZeros()) << name << ": the same nodes are taken";
      // Rounding of the mapped positions is 1e-13 of the thickness at 1000:1, and solving for the weights leaves as
      // much; weights that extrapolate far (the plate of one layer) are a hundred times as sensitive.
      EXPECT_LE(difference, 1e-11 * largest) << name;
      EXPECT_LE(defect(found, mapped, map, shift), 1e-12) << name;
      EXPECT_TRUE(is_positive_definite(found, body.input.contact_nodes)) << name;
      for (const Index node : body.input.contact_nodes) EXPECT_EQ(found.col(node).nonZeros(), 0) << name;
    }
  }
}

/// A grid of transfinite cells, drawn flat along the axes.
TEST(FlatCells, LayersOfFlatCellsAreTaken) {
  struct Layers {
    int count;
    double ratio;
  };
  for (const Layers layers : {Layers{2, 5.0}, {3, 10.0}, {2, 1000.0}}) {
    char geometry[400];
    std::snprintf(geometry, sizeof geometry,
                  "Rectangle(1)={0,0,0,%g,%d}; Physical Surface(\"body\")={1}; Physical Curve(\"contact\")={1}; "
                  "Transfinite Curve{1,3}=13; Transfinite Curve{2,4}=%d; Transfinite Surface{1}; Recombine Surface{1};",
                  12.0 * layers.ratio, layers.count, layers.count + 1);
    const AssembledBody body({"layers", 1, 1.0, geometry});
    const SparseMatrix mass = build_mass("equivalent-nodewise", body.input);
    const Matrix wanted = mass_moments(body.consistent, body.space.nodes), found = mass_moments(mass, body.space.nodes);
    for (Index a = 0; a < 3; ++a) {
      for (Index b = 0; b < 3; ++b)
        EXPECT_NEAR(found(a, b), wanted(a, b), 1e-12 * std::sqrt(wanted(a, a) * wanted(b, b))) << layers.ratio;
    }
    EXPECT_TRUE(is_positive_definite(mass, body.input.contact_nodes));
  }
}

TEST(FlatCells, WhatIsRefusedIsRefusedInEveryShape) {
  std::mt19937 random(5);
  struct Kind {
    const char* geometry;
    const char* expected;
  };
  const Kind kinds[] = {
      // No free nodes; only those on the one line between two layers; only those in the one plane between two layers.
      {"Rectangle(1)={0,0,0,1,1}; Physical Surface(\"body\")={1}; Transfinite Curve{:}=2; Transfinite Surface{1}; "
       "Physical Curve(\"contact\")={1,2,3,4};",
       "no node off the contact boundary"},
      {"Rectangle(1)={0,0,0,4,1}; Physical Surface(\"body\")={1}; Transfinite Curve{1,3}=7; Transfinite Curve{2,4}=3; "
       "Transfinite Surface{1}; Physical Curve(\"contact\")={1,2,3,4};",
       "5 nodes off the contact boundary, at"},
      {"Box(1)={0,0,0,4,4,1}; Physical Volume(\"body\")={1}; Physical Surface(\"contact\")={1,2,3,4,5,6}; "
       "Transfinite Curve{:}=5; Transfinite Curve{1,3,5,7}=3; Transfinite Surface{:}; Recombine Surface{:}; "
       "Transfinite Volume{1};",
       "9 nodes off the contact boundary, at"},
  };
  for (const Kind& kind : kinds) {
    const AssembledBody body({"refused", 1, 1.0, kind.geometry});
    const Index d = body.space.nodes.rows();
    for (const double ratio : {1.0, 10.0, 1000.0}) {
      for (const double shift : {0.0, 1000.0}) {
        const MappedBody mapped(body, affine_map(d, ratio, random), shift * Vector::Ones(d));
        for (const char* type : {"equivalent", "equivalent-nodewise", "equivalent-lumped", "equivalent-nearest"}) {
          SCOPED_TRACE(testing::Message() << type << ' ' << ratio << ':' << 1 << ' ' << kind.expected);
          const std::string message =
              expect_error({kind.expected, "refine the mesh"}, [&] { (void)build_mass(type, mapped.input); });
          if (kind.expected[0] != 'n') {
            EXPECT_TRUE(has(message, d == 2 ? "all on one line" : "all in one plane"));
          }
        }
      }
    }
  }
}

}  // namespace ricochet::test_support::flat_cells_test
