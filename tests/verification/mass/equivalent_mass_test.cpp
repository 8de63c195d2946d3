#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>

#include "ricochet/base/error.hpp"
#include "ricochet/run/session.hpp"
#include "support/errors.hpp"
#include "support/mass_bodies.hpp"
#include "support/mass_moments.hpp"
#include "support/paths.hpp"

// The equivalent masses on meshes of every kind.

namespace ricochet::test_support::equivalent_mass_test {

using Assembled = AssembledBody;
using Description = BodyDescription;

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

/// Checks section 5 of the source: no inertia on contact nodes; mass, centre of gravity and inertia are kept.
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

/// Expects every entry in the pattern of the consistent mass.
void expect_pattern(const SparseMatrix& mass, const SparseMatrix& consistent, const std::string& name) {
  for (Index column = 0; column < mass.cols(); ++column) {
    const int* const inner = consistent.innerIndexPtr();
    for (SparseMatrix::InnerIterator entry(mass, column); entry; ++entry) {
      ASSERT_TRUE(std::binary_search(inner + consistent.outerIndexPtr()[column],
                                     inner + consistent.outerIndexPtr()[column + 1], int(entry.row())))
          << name << ": (" << entry.row() << ", " << column << ")";
    }
  }
}

TEST(EquivalentMass, KeepsMassCentreAndInertiaAndIsSemidefiniteOnMeshesOfEveryKind) {
  const std::vector<std::string> types{"equivalent-nodewise", "equivalent-cellwise", "equivalent-compact",
                                       "equivalent-nearest"};
  std::map<std::string, int> refused;
  std::printf("Top eigenvalue [entries by those of the consistent mass]\n%-38s %6s %8s %10s", "body", "nodes",
              "contact", "consistent");
  for (const std::string& type : types) std::printf(" %20s", type.c_str());
  std::printf("  equivalent\n");
  for (const Description& description : bodies_of_every_kind()) {
    const Assembled body(description);
    const Vector scale = body.consistent.diagonal();
    std::printf("%-38s %6td %8zu %10.2f", description.name.c_str(), body.consistent.cols(),
                body.input.contact_nodes.size(), top_eigenvalue(body.consistent, scale));
    for (const std::string& type : types) {
      try {
        const SparseMatrix mass = build_mass(type, body.input);
        expect_equivalent(mass, body, description.name + " (" + type + ")");
        if (type == "equivalent-cellwise" || type == "equivalent-nearest")
          expect_pattern(mass, body.consistent, description.name);
        std::printf("      %7.2f [%5.2f]", top_eigenvalue(mass, scale),
                    double(mass.nonZeros()) / double(body.consistent.nonZeros()));
      } catch (const Error& problem) {
        ++refused[type];
        std::printf(" %20s", "refused");
        EXPECT_EQ(problem.kind(), ErrorKind::invalid_input);
        const bool is_cellwise = type == "equivalent-cellwise";
        EXPECT_TRUE(has(problem.what(),
                        is_cellwise ? "use mass type \"equivalent-nodewise\"" : "use mass type \"equivalent\""));
      }
    }
    std::printf("  %s\n", mass_to_build("equivalent", {}, body.input).name.c_str());
  }
  // Meshes on which the nearest matrix is indefinite are included, as the others are needed for them; one body has no
  // cell without contact nodes (ball, h 0.6).
  EXPECT_GE(refused["equivalent-nearest"], 15);
  EXPECT_EQ(refused["equivalent-cellwise"], 1);
  EXPECT_EQ(refused["equivalent-nodewise"] + refused["equivalent-compact"], 0);
}

TEST(EquivalentMass, IsChosenByDimensionAndByWhatHeapsUp) {
  const auto built = [](const char* name) {
    const Assembled body(body_of_kind(name));
    const MassChoice choice = mass_to_build("equivalent", {}, body.input);
    EXPECT_EQ(choice.reason.empty(), body.space.nodes.rows() == 2) << name;
    // The type that makes the choice also builds it: the same bits.
    const SparseMatrix mass = build_mass("equivalent", body.input);
    EXPECT_EQ((mass - build_mass(choice.name, body.input)).norm(), 0.0) << name;
    if (choice.mass) {
      EXPECT_EQ((mass - *choice.mass).norm(), 0.0) << name;
    }
    return choice.name;
  };
  EXPECT_EQ(built("disc, h 0.1"), "equivalent-nodewise") << "in the plane";
  EXPECT_EQ(built("ball, h 0.6"), "equivalent-nodewise") << "no cell without contact nodes";
  EXPECT_EQ(built("plate, 1 thick"), "equivalent-nodewise") << "a top eigenvalue of 800";
  EXPECT_EQ(built("ball, h 0.15"), "equivalent-cellwise");
  EXPECT_EQ(built("brick, hexahedra, degree 2"), "equivalent-cellwise");
  Assembled body(body_of_kind("ball, h 0.15"));
  for (const char* name : {"consistent", "equivalent-nodewise", "equivalent-compact"})
    EXPECT_EQ(mass_to_build(name, {}, body.input).name, name);
  body.input.cells = nullptr;
  EXPECT_EQ(mass_to_build("equivalent", {}, body.input).name, "equivalent-nodewise");
}

TEST(EquivalentMass, DegreeOneSpaceOnSecondOrderCells) {
  for (const char* name : {"disc, h 0.25, degree 2", "ball, h 0.4, degree 2"}) {
    Assembled body(body_of_kind(name));
    const DisplacementSpace linear = make_displacement_space(body.mesh, 1);
    Body same{&body.mesh, &linear, PlaneState::strain, {{"body", 3.0, make_linear_elasticity(1.0, 1.0)}}, {}};
    same.cell_material.assign(std::size_t(body.mesh.cell_count()), 0);
    body.consistent = assemble_scalar_mass(same, node_graph(linear));
    body.space = linear;
    body.input = {&body.consistent, &body.space.nodes,
                  facet_nodes(linear, body.mesh.group("contact", body.mesh.dimension - 1).members)};
    expect_equivalent(build_mass("equivalent", body.input), body, name);
  }
}

TEST(EquivalentMass, OfDampingThatVanishesAroundContactNodes) {
  // Rayleigh damping of one of two materials: its matrix is zero where the weights of contact nodes are sought.
  const Assembled body(body_of_kind("disc, h 0.1"));
  Vector inside(body.space.nodes.cols());
  for (Index i = 0; i < inside.size(); ++i) inside[i] = body.space.nodes.col(i).norm() < 0.3 ? 1.0 : 0.0;
  const SparseMatrix damping = inside.asDiagonal() * body.consistent * inside.asDiagonal();
  const SparseMatrix found =
      build_mass("equivalent", {&damping, &body.space.nodes, body.input.contact_nodes, &body.consistent});
  EXPECT_NEAR(found.sum(), damping.sum(), 1e-13 * damping.sum());
}

TEST(EquivalentMass, OfDampingOfOneOfTwoBodies) {
  const std::string path = source_path("cases/stack/stack.toml");
  for (const std::string& name : mass_names()) {
    if (!name.starts_with("equivalent")) continue;
    for (const char* damped : {"material.0", "material.1"}) {
      const double rate = 0.7;
      Session session(path, {"mass.type=" + name, fmt::format("{}.damping.mass={}", damped, rate)});
      const SparseMatrix damping = session.problem().damping.mass_part()->to_sparse();
      // Twice the mass of a column: 2 coordinates, density 1 or 3, 0.5 wide, 1 high.
      const double mass = 2.0 * 0.5 * (damped == std::string("material.0") ? 1.0 : 3.0);
      EXPECT_NEAR(damping.sum(), rate * mass, 1e-12 * mass) << name << ", " << damped;
    }
  }
}

TEST(EquivalentMass, SaysWhereTheInertiaHasNowhereToGo) {
  // Two triangles: every node is on the boundary.
  const Assembled body({"", 1, 1.0,
                        "Rectangle(1)={0,0,0,1,1}; Physical Surface(\"body\")={1}; Transfinite Curve{:}=2; "
                        "Transfinite Surface{1}; Physical Curve(\"contact\")={1,2,3,4};"});
  expect_error({"the inertia of the contact node at (0, 0) cannot be moved"},
               [&] { (void)build_mass("equivalent", body.input); });
}

}  // namespace ricochet::test_support::equivalent_mass_test
