#pragma once

#include <string>
#include <vector>

#include "ricochet/fem/cell_masses.hpp"
#include "ricochet/mass/mass.hpp"

/// @file Bodies on whose meshes masses are tested: thin strips and plates, coarse balls, contact all around,
/// quadrilaterals and hexahedra, curved second-order cells. Meshed by the gmsh program.
namespace ricochet::test_support {

struct BodyDescription {
  std::string name;
  int order;
  double size;
  std::string geometry;  ///< Gmsh, OpenCASCADE kernel; groups "body" and "contact"
};

[[nodiscard]] const std::vector<BodyDescription>& bodies_of_every_kind();
/// Returns the body of this name.
[[nodiscard]] const BodyDescription& body_of_kind(const std::string& name);

/// A meshed body with its consistent mass.
struct AssembledBody {
  Mesh mesh;
  DisplacementSpace space;
  Body body;
  SparseMatrix consistent;
  std::unique_ptr<CellMasses> cells;
  MassInput input;

  AssembledBody(const AssembledBody&) = delete;
  AssembledBody& operator=(const AssembledBody&) = delete;
  explicit AssembledBody(const BodyDescription& description);

 protected:
  /// Makes another body, whose mesh and space may be changed before its mass is assembled.
  AssembledBody(Mesh of_mesh, DisplacementSpace of_space, const Body& like);
  void assemble(std::vector<Index> contact_nodes);
};

}  // namespace ricochet::test_support
