#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "ricochet/fem/assembly.hpp"

/// @file Structured meshes of every cell shape on a box, distorted and mapped, made in memory.
namespace ricochet::test_support {

using PointMap = std::function<Vector(const Vector&)>;

struct BoxMesh {
  CellShape shape = CellShape::triangle;
  std::vector<int> counts;   ///< boxes per axis; simplices divide each into 2 triangles or 6 tetrahedra
  int geometry_degree = 1;   ///< 2: nodes on edges, faces and inside are mapped as well, so that cells are curved
  double distortion = 0.15;  ///< largest random displacement of a vertex in [0, 1]ᵈ, in widths of a box
  PointMap map;              ///< from [0, 1]ᵈ to the body; empty: the identity
};

/// Returns the unit box with the default distortion of its cells.
[[nodiscard]] BoxMesh box_of(CellShape shape, std::vector<int> counts);

/// Makes the mesh. Vertices on a side of the unit box move within that side only, so that the undistorted shape of the
/// body is kept. Groups: "body" (cells), and facets "x0", "x1", "y0", … (the sides where that reference coordinate is 0
/// or 1), "boundary".
[[nodiscard]] Mesh make_box_mesh(const BoxMesh& box);

/// Makes the mesh and refuses tangled and degenerate cells, as the reader of meshes does.
[[nodiscard]] Mesh make_checked_box_mesh(const BoxMesh& box);

/// x ↦ matrix · x + shift.
[[nodiscard]] PointMap affine_map(const Matrix& matrix, const Vector& shift);
/// A smooth map of [0, 1]ᵈ to itself that keeps every side: cells inside are curved, the body is still the box.
[[nodiscard]] PointMap swirl_map(double amplitude);
/// A smooth map that bends the sides.
[[nodiscard]] PointMap bend_map();
/// A smooth map of the unit box to the disc or ball of radius 1 about `centre` (its Jacobian vanishes at the corners
/// only).
[[nodiscard]] PointMap ball_map(const Vector& centre);

/// A mesh with its space and material, at a fixed address.
struct MeshedBody {
  Mesh mesh;
  DisplacementSpace space;
  Body body;
};
[[nodiscard]] Material test_material();
[[nodiscard]] std::unique_ptr<MeshedBody> make_meshed_body(Mesh mesh, int displacement_degree,
                                                           PlaneState plane = PlaneState::strain);

/// Returns the nodal values of a vector field, d per node.
[[nodiscard]] Vector interpolate(const DisplacementSpace& space, const PointMap& field);

/// Returns the integral of a scalar over the cells, including their curved geometry.
[[nodiscard]] double integrate(const MeshedBody& test, int degree, const std::function<double(const Vector&)>& value);

/// All shapes of dimension 2 and 3, in their order.
[[nodiscard]] std::vector<CellShape> all_cell_shapes();

/// A cell shape with the degrees of its geometry and of its displacement.
struct ElementKind {
  CellShape shape = CellShape::triangle;
  int geometry_degree = 1;
  int displacement_degree = 1;

  [[nodiscard]] int dimension() const { return ricochet::dimension(shape); }
  /// Returns true if the degree of the displacement is at least that of the geometry: the space then contains the
  /// affine displacements on curved cells as well.
  [[nodiscard]] bool contains_affine() const { return displacement_degree >= geometry_degree; }
  /// Returns "triangle_geometry1_displacement2".
  [[nodiscard]] std::string label() const;
};
[[nodiscard]] std::vector<ElementKind> all_element_kinds();

}  // namespace ricochet::test_support
