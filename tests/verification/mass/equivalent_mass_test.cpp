#include <gtest/gtest.h>

#include <cstdio>

#include "ricochet/base/error.hpp"
#include "ricochet/fem/assembly.hpp"
#include "ricochet/mass/mass.hpp"
#include "ricochet/mesh/read_mesh.hpp"
#include "support/case_run.hpp"

// The equivalent masses on meshes of every kind: thin strips and plates, coarse balls, contact all around,
// quadrilaterals and hexahedra, curved second-order cells. Meshed by the gmsh program from the descriptions below.

namespace ricochet {
namespace {

constexpr const char* strip =
    "Rectangle(1)={0,0,0,10,1}; Physical Surface(\"body\")={1}; Physical Curve(\"contact\")={1};";
constexpr const char* strip_around =
    "Rectangle(1)={0,0,0,10,1}; Physical Surface(\"body\")={1}; Physical Curve(\"contact\")={1,2,3,4};";
constexpr const char* disc = "Disk(1)={0,0,0,1}; Physical Surface(\"body\")={1}; Physical Curve(\"contact\")={1};";
constexpr const char* ring =
    "Disk(1)={0,0,0,1}; Disk(2)={0,0,0,0.6}; BooleanDifference(3)={Surface{1};Delete;}{Surface{2};Delete;}; "
    "Physical Surface(\"body\")={3}; Physical Curve(\"contact\")={Boundary{Surface{3};}};";
constexpr const char* ball = "Sphere(1)={0,0,0,1}; Physical Volume(\"body\")={1}; Physical Surface(\"contact\")={1};";
constexpr const char* plate =
    "Box(1)={0,0,0,10,10,1}; Physical Volume(\"body\")={1}; Physical Surface(\"contact\")={5};";
constexpr const char* plate_around =
    "Box(1)={0,0,0,10,10,1}; Physical Volume(\"body\")={1}; Physical Surface(\"contact\")={1,2,3,4,5,6};";
constexpr const char* cylinder =
    "Cylinder(1)={0,0,0,0,0,3,0.5}; Physical Volume(\"body\")={1}; Physical Surface(\"contact\")={1,2,3};";
constexpr const char* brick = "Box(1)={0,0,0,2,1,1}; Physical Volume(\"body\")={1}; Physical Surface(\"contact\")={5};";
constexpr const char* brick_around =
    "Box(1)={0,0,0,2,1,1}; Physical Volume(\"body\")={1}; Physical Surface(\"contact\")={1,2,3,4,5,6};";
constexpr const char* quadrilaterals = " Recombine Surface{:};";
constexpr const char* hexahedra = " Transfinite Surface{:}; Recombine Surface{:}; Transfinite Volume{:};";

struct Description {
  std::string name;
  int order;
  double size;
  std::string geometry;
};

const std::vector<Description>& bodies() {
  static const std::vector<Description> all{
      {"strip, 2 thick", 1, 0.5, strip},
      {"strip, 3 thick", 1, 0.34, strip},
      {"strip, 6 thick", 1, 0.17, strip},
      {"strip, 2 thick, quads", 1, 0.5, std::string(strip) + quadrilaterals},
      {"strip, 3 thick, around", 1, 0.34, strip_around},
      {"strip, 6 thick, around", 1, 0.17, strip_around},
      {"strip, 4 thick, quads, around", 1, 0.25, std::string(strip_around) + quadrilaterals},
      {"strip, 3 thick, degree 2, around", 2, 0.34, strip_around},
      {"disc, h 0.5", 1, 0.5, disc},
      {"disc, h 0.25", 1, 0.25, disc},
      {"disc, h 0.1", 1, 0.1, disc},
      {"disc, h 0.5, degree 2", 2, 0.5, disc},
      {"disc, h 0.25, degree 2", 2, 0.25, disc},
      {"disc, h 0.12, degree 2", 2, 0.12, disc},
      {"disc, quads", 1, 0.25, std::string(disc) + quadrilaterals},
      {"disc, quads, degree 2", 2, 0.25, std::string(disc) + quadrilaterals},
      {"ring", 1, 0.1, ring},
      {"ring, degree 2", 2, 0.13, ring},
      {"ball, h 0.6", 1, 0.6, ball},
      {"ball, h 0.4", 1, 0.4, ball},
      {"ball, h 0.25", 1, 0.25, ball},
      {"ball, h 0.15", 1, 0.15, ball},
      {"ball, h 0.6, degree 2", 2, 0.6, ball},
      {"ball, h 0.4, degree 2", 2, 0.4, ball},
      {"plate, 1 thick", 1, 1.0, plate},
      {"plate, 2 thick", 1, 0.5, plate},
      {"plate, 3 thick, around", 1, 0.33, plate_around},
      {"plate, degree 2", 2, 0.7, plate},
      {"cylinder, h 0.3", 1, 0.3, cylinder},
      {"cylinder, h 0.2", 1, 0.2, cylinder},
      {"cylinder, degree 2", 2, 0.3, cylinder},
      {"brick, hexahedra", 1, 0.33, std::string(brick) + hexahedra},
      {"brick, hexahedra, around", 1, 0.2, std::string(brick_around) + hexahedra},
      {"brick, hexahedra, degree 2", 2, 0.5, std::string(brick) + hexahedra},
      {"brick, hexahedra, degree 2, around", 2, 0.34, std::string(brick_around) + hexahedra},
  };
  return all;
}

/// Meshes a body and assembles its consistent mass.
struct Assembled {
  Mesh mesh;
  DisplacementSpace space;
  SparseMatrix consistent;
  MassInput input;

  explicit Assembled(const Description& description) {
    const std::string path =
        test_support::write_temporary("body.geo", "SetFactory(\"OpenCASCADE\");\n" + description.geometry + "\n");
    MeshFile file;
    file.path = path;
    file.size = description.size;
    file.geometry_degree = description.order;
    mesh = read_mesh(file);
    space = make_displacement_space(mesh, description.order);
    Body body{&mesh, &space, PlaneState::strain, {{"body", 3.0, 1.0, 1.0, 0.0, 0.0}}, {}};
    body.cell_material.assign(static_cast<std::size_t>(mesh.cell_count()), 0);
    consistent = assemble_scalar_mass(body, node_graph(space));
    input = {&consistent, &space.nodes, facet_nodes(space, mesh.group("contact", mesh.dimension - 1).members)};
  }
};

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
  std::printf("%-38s %6s %8s %12s %12s %12s\n", "body", "nodes", "contact", "consistent", "equivalent", "nearest");
  for (const Description& description : bodies()) {
    const Assembled body(description);
    const Vector scale = body.consistent.diagonal();
    const SparseMatrix mass = make_equivalent_mass()->build(body.input);
    expect_equivalent(mass, body, description.name);
    const double top = top_eigenvalue(mass, scale);
    std::string nearest_text = "refused";
    try {
      const SparseMatrix nearest = make_nearest_equivalent_mass()->build(body.input);
      expect_equivalent(nearest, body, description.name + " (nearest)");
      char text[16];
      std::snprintf(text, sizeof text, "%.2f", top_eigenvalue(nearest, scale));
      nearest_text = text;
    } catch (const Error& problem) {
      ++refused;
      EXPECT_EQ(problem.kind(), ErrorKind::invalid_input);
      EXPECT_NE(std::string(problem.what()).find("use mass type \"equivalent\""), std::string::npos) << problem.what();
    }
    std::printf("%-38s %6td %8zu %12.2f %12.2f %12s\n", description.name.c_str(), body.consistent.cols(),
                body.input.contact_nodes.size(), top_eigenvalue(body.consistent, scale), top, nearest_text.c_str());
  }
  // Those on which the nearest matrix is indefinite are among the meshes, or the first construction would not be
  // needed.
  EXPECT_GE(refused, 15);
}

TEST(EquivalentMass, DegreeOneSpaceOnSecondOrderCells) {
  for (const char* geometry : {disc, ball}) {
    Assembled body({"", 2, 0.4, geometry});
    const DisplacementSpace linear = make_displacement_space(body.mesh, 1);
    Body same{&body.mesh, &linear, PlaneState::strain, {{"body", 3.0, 1.0, 1.0, 0.0, 0.0}}, {}};
    same.cell_material.assign(static_cast<std::size_t>(body.mesh.cell_count()), 0);
    body.consistent = assemble_scalar_mass(same, node_graph(linear));
    body.space = linear;
    body.input = {&body.consistent, &body.space.nodes,
                  facet_nodes(linear, body.mesh.group("contact", body.mesh.dimension - 1).members)};
    expect_equivalent(make_equivalent_mass()->build(body.input), body, geometry);
  }
}

TEST(EquivalentMass, SaysWhereTheInertiaHasNowhereToGo) {
  // Two triangles: every node is on the boundary.
  const Assembled body({"", 1, 1.0,
                        "Rectangle(1)={0,0,0,1,1}; Physical Surface(\"body\")={1}; Transfinite Curve{:}=2; "
                        "Transfinite Surface{1}; Physical Curve(\"contact\")={1,2,3,4};"});
  try {
    (void)make_equivalent_mass()->build(body.input);
    FAIL() << "no error";
  } catch (const Error& problem) {
    EXPECT_NE(std::string(problem.what()).find("the free nodes around the contact node at (0, 0)"), std::string::npos)
        << problem.what();
  }
}

}  // namespace
}  // namespace ricochet
