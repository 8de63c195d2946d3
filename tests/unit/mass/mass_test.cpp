#include "ricochet/mass/mass.hpp"

#include <gtest/gtest.h>

#include "ricochet/base/error.hpp"
#include "ricochet/mass/mass_conditions.hpp"

/// @file Small matrices whose masses are computed by hand.
namespace ricochet {
namespace {

SparseMatrix sparse(const Matrix& dense) { return dense.sparseView(); }

Points points(Index dimension, std::initializer_list<double> values) {
  return Eigen::Map<const Points>(values.begin(), dimension, Index(values.size()) / dimension);
}

/// Consistent mass matrix of a bar of length 1 and mass 1: ⅓ and ⅙.
Matrix bar() { return (Matrix(2, 2) << 1.0 / 3.0, 1.0 / 6.0, 1.0 / 6.0, 1.0 / 3.0).finished(); }

TEST(LumpedMass, IsTheSumOfEachRow) {
  EXPECT_LE((lumped_diagonal(sparse(bar())) - Vector::Constant(2, 0.5)).cwiseAbs().maxCoeff(), 1e-16);
}

/// At corners of quadratic triangles the row sum is not positive.
TEST(LumpedMass, IsTheScaledDiagonalWhereASumIsNotPositive) {
  const Matrix mass = (Matrix(2, 2) << 1.0, -1.0, -1.0, 3.0).finished();
  const Vector lumped = lumped_diagonal(sparse(mass));
  EXPECT_DOUBLE_EQ(lumped.sum(), mass.sum());
  EXPECT_DOUBLE_EQ(lumped[1], 3.0 * lumped[0]);
}

TEST(PositiveDefinite, IsAskedOfTheOtherNodes) {
  Matrix mass = Matrix::Zero(3, 3);
  mass.topLeftCorner(2, 2) = bar();
  EXPECT_FALSE(is_positive_definite(sparse(mass), {}));
  EXPECT_TRUE(is_positive_definite(sparse(mass), {2}));
  mass(0, 1) = mass(1, 0) = 0.5;
  EXPECT_FALSE(is_positive_definite(sparse(mass), {2}));
  // The units have no effect.
  EXPECT_TRUE(is_positive_definite(sparse(1e-30 * bar()), {}));
}

/// A bar with one free node: it cannot carry the whole mass, and the refusal states the positions of the nodes.
TEST(Masses, AreRefusedWhereOneNodeIsLeft) {
  const SparseMatrix mass = sparse(bar());
  const Points nodes = points(2, {0.0, 0.0, 1.0, 0.0});
  MassInput input{.consistent = &mass, .nodes = &nodes, .contact_nodes = {0}};
  int refused = 0;
  for (const std::string& name : mass_names()) {
    if (!mass_registry().find(name).type.removes_contact_inertia) {
      EXPECT_LE(std::abs(build_mass(name, input).sum() - 1.0), 1e-15) << name;
      continue;
    }
    try {
      (void)build_mass(name, input);
      ADD_FAILURE() << name << " was built";
    } catch (const Error& problem) {
      const std::string message = problem.what();
      if (message.find("needs the mass matrices of single cells") != std::string::npos) continue;
      EXPECT_NE(message.find("(1, 0)"), std::string::npos) << message;
      ++refused;
    }
  }
  EXPECT_GE(refused, 2);
}

TEST(Masses, AreToldByNameAndHaveTheirOwnParameters) {
  EXPECT_THROW((void)build_mass("heavy", {}), Error);
  EXPECT_THROW((void)build_mass("equivalent", {}, {{"weight", 1.0}}), Error);
}

TEST(Degeneracy, IsSaidInWords) {
  const Points nodes = points(3, {0, 0, 0, 1, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0, 1e-9, 0, 0, 1});
  const std::vector<Index> body{0, 1, 2, 3, 4, 5};
  EXPECT_EQ(degeneracy(nodes, body, {0, 0}), "at one point");
  EXPECT_EQ(degeneracy(nodes, body, {0, 1, 2}), "on one line");
  EXPECT_EQ(degeneracy(nodes, body, {0, 1, 3}), "in one plane");
  EXPECT_EQ(degeneracy(nodes, body, {0, 1, 3, 4}), "in one plane") << "rounding of coordinates";
  EXPECT_EQ(degeneracy(nodes, body, {0, 1, 3, 5}), "");
  EXPECT_EQ(describe_massive_nodes(nodes, body, {0, 1, 2}),
            "3 nodes off the contact boundary, at (0, 0, 0), (1, 0, 0) and (2, 0, 0), all on one line");
  Points flat = nodes;
  flat.row(2) *= 1e-8;
  EXPECT_EQ(degeneracy(flat, body, {0, 1, 3, 5}), "") << "it is the body that is flat";
  EXPECT_EQ(degeneracy(flat, body, {0, 1, 3, 4}), "in one plane");
  EXPECT_EQ(degeneracy(nodes, {0, 1, 2, 3}, {0, 1, 3}), "in one plane") << "with all of the body";
}

/// A body of 1 × 1000 is as well conditioned as a square.
TEST(SpanSpace, IsAskedInTheBodysOwnFrame) {
  for (const double height : {1.0, 1e-3}) {
    const Points nodes = points(2, {0, 0, 1, 0, 1, height, 0, height, 0.5, 1e-8 * height});
    const std::vector<Index> body{0, 1, 2, 3, 4};
    EXPECT_TRUE(span_space(nodes, body, {0, 1, 2}));
    EXPECT_FALSE(span_space(nodes, body, {0, 1, 4})) << "nearly on one line";
    EXPECT_FALSE(span_space(nodes, body, {0, 2}));
  }
}

/// The frame of a bar of mass 1: its centre, and its spread ∫(x − ½)² = 1/12.
TEST(MassFrames, AreCentredAndRound) {
  const Points nodes = points(2, {0, 0, 1, 0, 1, 0.5, 0, 0.5});
  Matrix mass = Matrix::Zero(4, 4);
  mass.diagonal() << 1.0, 2.0, 3.0, 4.0;
  mass(0, 1) = mass(1, 0) = mass(1, 2) = mass(2, 1) = mass(2, 3) = mass(3, 2) = 0.1;
  const MassFrames frames = mass_frames(sparse(mass), nodes);
  ASSERT_EQ(frames.bodies.size(), 1U);
  const Matrix moments = mass_moments(sparse(mass), frames, frames.bodies[0]);
  EXPECT_LE((moments - mass.sum() * Matrix::Identity(3, 3)).cwiseAbs().maxCoeff(), 1e-14 * mass.sum());
}

}  // namespace
}  // namespace ricochet
