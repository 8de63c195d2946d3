#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "support/mass_bodies.hpp"
#include "support/mass_moments.hpp"

// The diagonal mass without inertia on contact nodes, on meshes of every kind.

namespace ricochet::test_support::lumped_equivalent_mass_test {

/// Largest relative differences of total mass and first moments, and of second moments about the centre of gravity.
struct Lack {
  double centre = 0.0, inertia = 0.0;
};

Lack lack(const SparseMatrix& mass, const AssembledBody& body) {
  const Index d = body.space.nodes.rows();
  const Vector first = mass_moments(body.consistent, body.space.nodes).col(0);
  const Points nodes = body.space.nodes.colwise() - Vector(first.tail(d) / first[0]);
  const Matrix wanted = mass_moments(body.consistent, nodes);
  const Matrix difference = (mass_moments(mass, nodes) - wanted).cwiseAbs();
  return {difference.row(0).maxCoeff() / wanted.cwiseAbs().maxCoeff(),
          difference.bottomRightCorner(d, d).maxCoeff() / wanted.bottomRightCorner(d, d).maxCoeff()};
}

/// Expects a diagonal mass, zero on contact nodes, positive on all others.
void expect_lumped(const SparseMatrix& mass, const AssembledBody& body, const std::string& name) {
  const Vector diagonal = mass.diagonal();
  EXPECT_EQ((SparseMatrix(mass) - SparseMatrix(Matrix(diagonal.asDiagonal()).sparseView())).norm(), 0.0) << name;
  for (Index i = 0; i < diagonal.size(); ++i) {
    const bool contact = std::ranges::binary_search(body.input.contact_nodes, i);
    EXPECT_EQ(mass.col(i).nonZeros(), contact ? 0 : 1) << name;
    EXPECT_TRUE(contact || diagonal[i] > 0.0) << name;
  }
}

/// Meshes whose free nodes cannot have the body's centre of gravity with positive masses (a plate of two layers on one
/// face: they are all above the middle), or less than a tenth of a moment of inertia.
const std::vector<std::string> refused_bodies{"strip, 2 thick", "strip, 2 thick, quads", "ball, h 0.6",
                                              "plate, 1 thick", "plate, 2 thick",        "plate, degree 2"};

TEST(LumpedEquivalentMass, KeepsTheConditionsOnMeshesOfEveryKind) {
  log::set_level(log::Level::error);
  int all_kept = 0;
  std::printf("%-38s %6s %8s %12s %12s %12s %12s\n", "body", "nodes", "contact", "least ratio", "most", "centre",
              "inertia");
  for (const BodyDescription& description : bodies_of_every_kind()) {
    const AssembledBody body(description);
    const bool refused = std::ranges::count(refused_bodies, description.name) > 0;
    std::vector<std::string> warnings;
    const log::CollectWarnings collect(warnings);
    SparseMatrix mass;
    try {
      mass = build_mass("equivalent-lumped", body.input);
    } catch (const Error& problem) {
      EXPECT_TRUE(refused) << description.name << ": " << problem.what();
      EXPECT_EQ(problem.kind(), ErrorKind::invalid_input);
      EXPECT_NE(std::string(problem.what()).find("has too few nodes off the contact boundary"), std::string::npos)
          << problem.what();
      continue;
    }
    EXPECT_FALSE(refused) << description.name;
    expect_lumped(mass, body, description.name);
    const Vector lumped = lumped_diagonal(body.consistent);
    double least = INFINITY, most = 0.0;
    for (Index i = 0; i < lumped.size(); ++i) {
      if (mass.col(i).nonZeros() == 0) continue;
      least = std::min(least, mass.coeff(i, i) / lumped[i]);
      most = std::max(most, mass.coeff(i, i) / lumped[i]);
    }
    const Lack found = lack(mass, body);
    std::printf("%-38s %6td %8zu %12.2f %12.2f %12.1e %12.1e\n", description.name.c_str(), body.consistent.cols(),
                body.input.contact_nodes.size(), least, most, found.centre, found.inertia);
    EXPECT_LE(found.centre, 1e-14) << description.name;
    EXPECT_GT(least, 0.25) << description.name << ": half of a mass in each of two steps";
    // A moment that is not kept is reported.
    EXPECT_EQ(warnings.size(), found.inertia > 1e-12 ? 1u : 0u) << description.name;
    EXPECT_LE(found.inertia, 0.9) << description.name;
    all_kept += found.inertia <= 1e-12 ? 1 : 0;
  }
  EXPECT_GE(all_kept, 10);
}

TEST(LumpedEquivalentMass, MovesLessMassOnFinerMeshes) {
  log::set_level(log::Level::error);
  double before = INFINITY;
  for (const double size : {0.2, 0.1, 0.05}) {
    BodyDescription description = body_of_kind("disc, h 0.1");
    description.size = size;
    const AssembledBody body(description);
    const SparseMatrix mass = build_mass("equivalent-lumped", body.input);
    const Vector lumped = lumped_diagonal(body.consistent);
    // Nodes that share no cell with a contact node only have the correction, of order h².
    double correction = 0.0;
    for (Index i = 0; i < lumped.size(); ++i) {
      bool beside = false;
      for (SparseMatrix::InnerIterator entry(body.consistent, i); entry; ++entry) {
        beside = beside || std::ranges::binary_search(body.input.contact_nodes, Index(entry.row()));
      }
      if (!beside) correction = std::max(correction, std::abs(mass.coeff(i, i) / lumped[i] - 1.0));
    }
    std::printf("disc, h %.2f: correction %.4f\n", size, correction);
    EXPECT_LT(correction, 0.4 * before);
    before = correction;
  }
  EXPECT_LT(before, 0.05);
}

TEST(LumpedEquivalentMass, KeepsMassAndCentreWhereInertiaAcrossIsOutOfReach) {
  // A bar of one layer of cells: a lumped mass has all of it at the sides, with three times the inertia across.
  log::set_level(log::Level::error);
  const AssembledBody body({"bar", 1, 1.0,
                            "Rectangle(1)={0,0,0,12,1}; Physical Surface(\"body\")={1}; Transfinite Curve{1,3}=13; "
                            "Transfinite Curve{2,4}=2; Transfinite Surface{1}; Physical Curve(\"contact\")={4}; "
                            "Recombine Surface{1};"});
  ASSERT_EQ(body.input.contact_nodes.size(), 2u);
  std::vector<std::string> warnings;
  const log::CollectWarnings collect(warnings);
  const SparseMatrix mass = build_mass("equivalent-lumped", body.input);
  expect_lumped(mass, body, "bar");
  const Matrix wanted = mass_moments(body.consistent, body.space.nodes);
  const Matrix found = mass_moments(mass, body.space.nodes);
  for (Index k = 0; k < 3; ++k) EXPECT_NEAR(found(0, k), wanted(0, k), 1e-13 * wanted(0, k));
  EXPECT_NEAR(found(1, 1), wanted(1, 1), 1e-13 * wanted(1, 1)) << "along the bar";
  EXPECT_NEAR(found(1, 2), wanted(1, 2), 1e-13 * wanted(1, 2));
  EXPECT_EQ(warnings.size(), 1u) << "what is not kept is said";
}

TEST(LumpedEquivalentMass, TreatsEachBodyOnItsOwn) {
  const AssembledBody one({"two discs", 1, 0.2,
                           "Disk(1)={0,0,0,1}; Disk(2)={5,0,0,0.5}; Physical Surface(\"body\")={1,2}; "
                           "Physical Curve(\"contact\")={1};"});
  const SparseMatrix mass = build_mass("equivalent-lumped", one.input);
  const Vector lumped = lumped_diagonal(one.consistent);
  double left = 0.0;
  for (Index i = 0; i < lumped.size(); ++i) {
    if (one.space.nodes(0, i) < 2.0) left += mass.coeff(i, i) - lumped[i];
  }
  EXPECT_NEAR(left, 0.0, 1e-13 * lumped.sum()) << "no mass goes from one body to the other";
}

TEST(LumpedEquivalentMass, DampingKeepsTheRateOfEachNode) {
  const AssembledBody body(body_of_kind("disc, h 0.25, degree 2"));
  const SparseMatrix mass = build_mass("equivalent-lumped", body.input);
  // Damping in the right half only.
  Vector inside(body.space.nodes.cols());
  for (Index i = 0; i < inside.size(); ++i) inside[i] = body.space.nodes(0, i) > 0.0 ? std::sqrt(0.7) : 0.0;
  const SparseMatrix damping = inside.asDiagonal() * body.consistent * inside.asDiagonal();
  const SparseMatrix found =
      build_mass("equivalent-lumped", {&damping, &body.space.nodes, body.input.contact_nodes, &body.consistent});
  for (Index i = 0; i < inside.size(); ++i) {
    EXPECT_NEAR(found.coeff(i, i), inside[i] * inside[i] * mass.coeff(i, i), 1e-15 * mass.sum());
  }
}

}  // namespace ricochet::test_support::lumped_equivalent_mass_test
