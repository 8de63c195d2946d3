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
  std::vector<int> counts;   ///< boxes per axis; simplices cut each into 2 triangles or 6 tetrahedra
  int geometry_degree = 1;   ///< 2: nodes on edges, faces and inside are mapped too, so cells are curved
  double distortion = 0.15;  ///< largest random displacement of a vertex in [0, 1]ᵈ, in widths of a box
  PointMap map;              ///< from [0, 1]ᵈ to the body; empty: the identity
};

/// The unit box, its cells distorted as by default.
[[nodiscard]] BoxMesh box_of(CellShape shape, std::vector<int> counts);

/// Vertices on a side of the unit box move within that side only, so the undistorted shape of the body is kept. Groups:
/// "body" (cells), and of facets "x0", "x1", "y0", … (the sides where that reference coordinate is 0 or 1), "boundary".
[[nodiscard]] Mesh make_box_mesh(const BoxMesh& box);

/// Refuses tangled and degenerate cells as the reader of meshes does.
[[nodiscard]] Mesh make_checked_box_mesh(const BoxMesh& box);

/// x ↦ matrix · x + shift.
[[nodiscard]] PointMap affine_map(const Matrix& matrix, const Vector& shift);
/// A smooth map of [0, 1]ᵈ to itself that keeps every side: cells inside are curved, the body is still the box.
[[nodiscard]] PointMap swirl_map(double amplitude);
/// A smooth map that bends the sides.
[[nodiscard]] PointMap bend_map();
/// The unit box to the disc or ball of radius 1 about `centre`, smooth (its Jacobian vanishes at the corners only).
[[nodiscard]] PointMap ball_map(const Vector& centre);

/// A mesh with its space and material, at an address that does not change.
struct MeshedBody {
  Mesh mesh;
  DisplacementSpace space;
  Body body;
};
[[nodiscard]] Material test_material();
[[nodiscard]] std::unique_ptr<MeshedBody> make_meshed_body(Mesh mesh, int displacement_degree,
                                                           PlaneState plane = PlaneState::strain);

/// Nodal values of a vector field, d per node.
[[nodiscard]] Vector interpolate(const DisplacementSpace& space, const PointMap& field);

/// ∫ over the cells (their curved geometry included) of a scalar.
[[nodiscard]] double integrate(const MeshedBody& test, int degree, const std::function<double(const Vector&)>& value);

constexpr CellShape all_cell_shapes[] = {CellShape::triangle, CellShape::quadrilateral, CellShape::tetrahedron,
                                         CellShape::hexahedron};

/// A cell shape with the degrees of its geometry and of its displacement.
struct ElementKind {
  CellShape shape = CellShape::triangle;
  int geometry_degree = 1;
  int displacement_degree = 1;

  [[nodiscard]] int dimension() const { return ricochet::dimension(shape); }
  /// The displacement's degree is at least that of the geometry: then the space contains the affine displacements on
  /// curved cells too.
  [[nodiscard]] bool contains_affine() const { return displacement_degree >= geometry_degree; }
  /// "triangle_geometry1_displacement2"
  [[nodiscard]] std::string label() const;
};
[[nodiscard]] std::vector<ElementKind> all_element_kinds();

}  // namespace ricochet::test_support
