#include <gtest/gtest.h>

#include <cstdio>

#include "ricochet/base/error.hpp"
#include "support/mass_bodies.hpp"
#include "support/mass_moments.hpp"

// The equivalent masses on meshes of every kind.

namespace ricochet {
namespace {

using Assembled = test_support::AssembledBody;
using Description = test_support::BodyDescription;
using test_support::mass_moments;

/// Largest eigenvalue of D⁻¹ m on the nodes with mass, D the diagonal of the consistent mass, by power iteration.
double top_eigenvalue(const SparseMatrix& mass, const Vector& scale) {
  Vector x = Vector::LinSpaced(mass.cols(), 1.0, 2.0);
  double value = 0.0;
  for (int k = 0; k < 2000; ++k) {
    const Vector y = (mass * x).cwiseQuotient(scale);
    const double next = y.norm() / x.norm();
    x = y / y.norm();
    if (std::abs(next - value) < 1e-6 * next) return next;
    value = next;
  }
  return value;
}

/// The conditions of section 5 of the source: no inertia on contact nodes; mass, centre of gravity and inertia kept.
void expect_equivalent(const SparseMatrix& mass, const Assembled& body, const std::string& name) {
  for (const Index node : body.input.contact_nodes) {
    EXPECT_EQ(mass.col(node).nonZeros(), 0) << name;
  }
  EXPECT_EQ((mass - SparseMatrix(mass.transpose())).norm(), 0.0) << name;
  const Matrix wanted = mass_moments(body.consistent, body.space.nodes);
  const Matrix found = mass_moments(mass, body.space.nodes);
  EXPECT_LE((found - wanted).cwiseAbs().maxCoeff(), 1e-12 * wanted.cwiseAbs().maxCoeff()) << name;
  EXPECT_TRUE(is_positive_definite(mass, body.input.contact_nodes)) << name;
}

TEST(EquivalentMass, KeepsMassCentreAndInertiaAndIsSemidefiniteOnMeshesOfEveryKind) {
  int refused = 0;
  std::printf("%-38s %6s %8s %12s %12s %12s %12s %12s %12s\n", "body", "nodes", "contact", "consistent", "equivalent",
              "nearest", "compact", "entries", "compact's");
  for (const Description& description : test_support::bodies_of_every_kind()) {
    const Assembled body(description);
    const Vector scale = body.consistent.diagonal();
    const SparseMatrix mass = make_mass("equivalent")->build(body.input);
    expect_equivalent(mass, body, description.name);
    const double top = top_eigenvalue(mass, scale);
    std::string nearest_text = "refused";
    try {
      const SparseMatrix nearest = make_mass("equivalent-nearest")->build(body.input);
      expect_equivalent(nearest, body, description.name + " (nearest)");
      char text[16];
      std::snprintf(text, sizeof text, "%.2f", top_eigenvalue(nearest, scale));
      nearest_text = text;
    } catch (const Error& problem) {
      ++refused;
      EXPECT_EQ(problem.kind(), ErrorKind::invalid_input);
      EXPECT_NE(std::string(problem.what()).find("use mass type \"equivalent\""), std::string::npos) << problem.what();
    }
    const SparseMatrix compact = make_mass("equivalent-compact")->build(body.input);
    expect_equivalent(compact, body, description.name + " (compact)");
    const auto share = [&](const SparseMatrix& of) {
      return static_cast<double>(of.nonZeros()) / static_cast<double>(body.consistent.nonZeros());
    };
    std::printf("%-38s %6td %8zu %12.2f %12.2f %12s %12.2f %12.2f %12.2f\n", description.name.c_str(),
                body.consistent.cols(), body.input.contact_nodes.size(), top_eigenvalue(body.consistent, scale), top,
                nearest_text.c_str(), top_eigenvalue(compact, scale), share(mass), share(compact));
  }
  // Those on which the nearest matrix is indefinite are among the meshes, or the first construction would not be
  // needed.
  EXPECT_GE(refused, 15);
}

TEST(EquivalentMass, DegreeOneSpaceOnSecondOrderCells) {
  for (const char* name : {"disc, h 0.25, degree 2", "ball, h 0.4, degree 2"}) {
    Assembled body(test_support::body_of_kind(name));
    const DisplacementSpace linear = make_displacement_space(body.mesh, 1);
    Body same{&body.mesh, &linear, PlaneState::strain, {{"body", 3.0, make_linear_elasticity(1.0, 1.0)}}, {}};
    same.cell_material.assign(static_cast<std::size_t>(body.mesh.cell_count()), 0);
    body.consistent = assemble_scalar_mass(same, node_graph(linear));
    body.space = linear;
    body.input = {&body.consistent, &body.space.nodes,
                  facet_nodes(linear, body.mesh.group("contact", body.mesh.dimension - 1).members)};
    expect_equivalent(make_mass("equivalent")->build(body.input), body, name);
  }
}

TEST(EquivalentMass, OfDampingThatVanishesAroundContactNodes) {
  // Rayleigh damping of one of two materials: its matrix has zeros where the weights of contact nodes are looked for.
  const Assembled body(test_support::body_of_kind("disc, h 0.1"));
  Vector inside(body.space.nodes.cols());
  for (Index i = 0; i < inside.size(); ++i) inside[i] = body.space.nodes.col(i).norm() < 0.3 ? 1.0 : 0.0;
  const SparseMatrix damping = inside.asDiagonal() * body.consistent * inside.asDiagonal();
  const SparseMatrix found =
      make_mass("equivalent")->build({&damping, &body.space.nodes, body.input.contact_nodes, &body.consistent});
  EXPECT_NEAR(found.sum(), damping.sum(), 1e-13 * damping.sum());
}

TEST(EquivalentMass, SaysWhereTheInertiaHasNowhereToGo) {
  // Two triangles: every node is on the boundary.
  const Assembled body({"", 1, 1.0,
                        "Rectangle(1)={0,0,0,1,1}; Physical Surface(\"body\")={1}; Transfinite Curve{:}=2; "
                        "Transfinite Surface{1}; Physical Curve(\"contact\")={1,2,3,4};"});
  try {
    (void)make_mass("equivalent")->build(body.input);
    FAIL() << "no error";
  } catch (const Error& problem) {
    EXPECT_NE(std::string(problem.what()).find("the inertia of the contact node at (0, 0) cannot be moved"),
              std::string::npos)
        << problem.what();
  }
}

}  // namespace
}  // namespace ricochet
