#include "support/mass_bodies.hpp"

#include <stdexcept>
#include <utility>

#include "ricochet/mesh/read_mesh.hpp"
#include "support/case_run.hpp"

namespace ricochet::test_support {

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

}  // namespace

const std::vector<BodyDescription>& bodies_of_every_kind() {
  static const std::vector<BodyDescription> all{
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

const BodyDescription& body_of_kind(const std::string& name) {
  for (const BodyDescription& description : bodies_of_every_kind()) {
    if (description.name == name) return description;
  }
  throw std::runtime_error("no body is called " + name);
}

AssembledBody::AssembledBody(const BodyDescription& description) {
  const std::string path = write_temporary("body.geo", "SetFactory(\"OpenCASCADE\");\n" + description.geometry + "\n");
  MeshFile file;
  file.path = path;
  file.size = description.size;
  file.geometry_degree = description.order;
  mesh = read_mesh(file);
  space = make_displacement_space(mesh, description.order);
  body = {&mesh, &space, PlaneState::strain, {{"body", 3.0, make_linear_elasticity(1.0, 1.0)}}, {}};
  body.cell_material.assign(std::size_t(mesh.cell_count()), 0);
  assemble(facet_nodes(space, mesh.group("contact", mesh.dimension - 1).members));
}

AssembledBody::AssembledBody(Mesh of_mesh, DisplacementSpace of_space, const Body& like)
    : mesh(std::move(of_mesh)), space(std::move(of_space)), body(like) {
  body.mesh = &mesh;
  body.space = &space;
}

void AssembledBody::assemble(std::vector<Index> contact_nodes) {
  consistent = assemble_scalar_mass(body, node_graph(space));
  cells = std::make_unique<CellMasses>(body);
  input = {&consistent, &space.nodes, std::move(contact_nodes), nullptr, cells.get()};
}

}  // namespace ricochet::test_support
