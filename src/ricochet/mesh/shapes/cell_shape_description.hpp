#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "ricochet/mesh/shapes/cell_shape.hpp"

/// @file Description of a cell shape. Everything that depends on the shape of a cell asks its
/// description, or the functions of reference_cell.hpp and flat_pieces.hpp, which derive the rest from it.
namespace ricochet {

/// Numbers of vertices; as a point of the cell, the mean of these vertices.
using VertexSet = std::vector<int>;
using VertexSets = std::vector<VertexSet>;

/// Value and gradient of a Lagrange function at a point of the reference cell. Components of the gradient beyond the
/// dimension of the cell have no meaning.
struct LagrangeValue {
  double value = 1.0;
  Eigen::Vector3d gradient = Eigen::Vector3d::Ones();
};

/// Cell of one degree in files of other programs.
struct FileCellType {
  int gmsh = 0;             ///< Gmsh's type
  int vtk = 0;              ///< number in vtkCellType.h
  std::string xdmf;         ///< TopologyType
  int xdmf_number = 0;      ///< in Mixed topologies
  std::string meshio_name;  ///< meshio's name, which the Python package uses, too
  /// Vertices in VTK's order; empty if that is `file_vertices`. (It is not for VTK_WEDGE, but for its quadratic forms.)
  VertexSet vtk_vertices = {};
};

/// Edges, and faces, at whose middles nodes lie, in the order of a file and by its numbers of vertices. The node in the
/// middle of the cell, if there is one, is the last.
struct FileNodes {
  VertexSets edges, faces = {};
};

struct CellShapeDescription {
  /// A cell of a subdivision: each of its vertices is the mean of some vertices of the parent.
  struct Child {
    CellShape shape;
    VertexSets vertices;
  };
  struct Subdivision {
    std::vector<Child> children;
    VertexSets diagonal;  ///< ends of the edge that it has inside, if there are others to choose from; else empty
  };

  /// @name Reference cell, in Basix's numbering
  /// @{
  int dimension = 0;
  std::vector<Eigen::Vector3d> vertices;
  VertexSets edges;   ///< each has a node of degree 2 at its middle
  VertexSets facets;  ///< ascending, which is also the facet's own order; none for intervals
  /// Whether degree 2 has a node at the mean of all vertices beside those on vertices, edges and facets.
  bool has_centre_node = false;
  /// Returns, at a point, the Lagrange function of degree 1 or 2 of the node at a position.
  std::function<LagrangeValue(int degree, const Eigen::Vector3d& node, const Eigen::Vector3d& at)> lagrange;
  /// Refinements, alternatives with the same numbers of children of each shape; of several, the one with the shortest
  /// diagonal is chosen.
  std::vector<Subdivision> subdivisions;
  /// Partition into simplices between vertices, in any orientation. Partitions of neighbours should match.
  VertexSets simplices;
  /// @}

  /// @name Files
  /// @{
  /// Vertices in the order of Gmsh, meshio, Abaqus, CalculiX and Exodus: around quadrilaterals, in place of row by row.
  VertexSet file_vertices;
  /// Order of the nodes of degree 2 behind the vertices, by the numbers of `file_vertices`. That of VTK is the order of
  /// meshio, Abaqus and CalculiX, too.
  FileNodes gmsh, vtk;
  std::array<FileCellType, 2> file_types;  ///< of degree 1 and 2
  /// Facets in the order of Abaqus (S1, S2, …) by the file's vertices; their order becomes that of the facet's nodes.
  VertexSets abaqus_facets;
  std::vector<int> exodus_sides;  ///< Exodus' sides 1, 2, … as indices of `abaqus_facets`
  /// @}
};

/// Returns the name of the first member that is missing or of another length than the others require; "" if none.
[[nodiscard]] std::string missing_member(const CellShapeDescription& cell);
/// Throws std::logic_error if the description of a shape is incomplete.
[[nodiscard]] const CellShapeDescription& describe(CellShape shape);
[[nodiscard]] inline const FileCellType& file_type(CellShape shape, int degree) {
  return describe(shape).file_types[degree == 1 ? 0 : 1];
}

/// Table with an entry per shape and degree, 1 and 2, made at once.
template <class Make>
class ShapeTable {
 public:
  explicit ShapeTable(const Make& make) {
    for (const CellShape shape : cell_shapes()) {
      for (const int degree : {1, 2}) entries_.push_back(make(shape, degree));
    }
  }
  [[nodiscard]] const auto& at(CellShape shape, int degree) const {
    return entries_[2 * std::size_t(shape) + (degree == 1 ? 0 : 1)];
  }

 private:
  std::vector<std::invoke_result_t<Make, CellShape, int>> entries_;
};

/// Returns the description of a product of simplices of these dimensions, of which the first has the first axes: of
/// a hexahedron, {1, 1, 1}. It has everything but edges, facets and data of files.
[[nodiscard]] CellShapeDescription product_of_simplices(CellShape shape, const std::vector<int>& dimensions);

}  // namespace ricochet
