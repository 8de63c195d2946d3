#include <stdexcept>
#include <utility>

#include "ricochet/base/text.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

#define RICOCHET_DECLARE_SHAPE(shape) extern CellShapeDescription describe_##shape();
RICOCHET_CELL_SHAPES(RICOCHET_DECLARE_SHAPE)

std::string missing_member(const CellShapeDescription& cell) {
  const std::size_t facets = cell.facets.size(), vertices = cell.vertices.size();
  const std::pair<bool, const char*> members[] = {
      {cell.dimension > 0, "dimension"},
      {vertices > 0, "vertices"},
      {!cell.edges.empty(), "edges"},
      {facets > 0 || cell.dimension == 1, "facets"},
      {cell.lagrange != nullptr, "lagrange"},
      {!cell.subdivisions.empty(), "subdivisions"},
      {!cell.simplices.empty(), "simplices"},
      {cell.file_vertices.size() == vertices, "file_vertices"},
      {cell.gmsh.edges.size() == cell.edges.size(), "gmsh"},
      {cell.vtk.edges.size() == cell.edges.size(), "vtk"},
      {cell.file_types[0].gmsh > 0 && cell.file_types[1].gmsh > 0, "file_types"},
      {cell.abaqus_facets.size() == facets, "abaqus_facets"},
      {cell.exodus_sides.size() == facets, "exodus_sides"},
  };
  for (const auto& [is_complete, name] : members) {
    if (!is_complete) return name;
  }
  return "";
}

const CellShapeDescription& describe(CellShape shape) {
#define RICOCHET_DESCRIBE_SHAPE(shape) complete(describe_##shape(), #shape),
  const auto complete = [](CellShapeDescription cell, const char* name) {
    const std::string member = missing_member(cell);
    if (!member.empty()) throw std::logic_error(std::string("the description of ") + name + "s lacks " + member);
    return cell;
  };
  static const std::vector<CellShapeDescription> all{RICOCHET_CELL_SHAPES(RICOCHET_DESCRIBE_SHAPE)};
  return all[std::size_t(shape)];
}

const std::vector<CellShape>& cell_shapes() {
#define RICOCHET_LIST_SHAPE(shape) CellShape::shape,
  static const std::vector<CellShape> all{RICOCHET_CELL_SHAPES(RICOCHET_LIST_SHAPE)};
  return all;
}

int dimension(CellShape shape) { return describe(shape).dimension; }

int vertex_count(CellShape shape) { return int(describe(shape).vertices.size()); }

bool is_simplex(CellShape shape) { return vertex_count(shape) == dimension(shape) + 1; }

std::string name(CellShape shape) {
#define RICOCHET_NAME_SHAPE(shape) #shape,
  static const std::vector<std::string> names{RICOCHET_CELL_SHAPES(RICOCHET_NAME_SHAPE)};
  return names[std::size_t(shape)];
}

std::string plural_name(CellShape shape) {
  const std::string singular = name(shape);
  return singular.ends_with("hedron") ? singular.substr(0, singular.size() - 2) + "a" : singular + "s";
}

std::string names_of_cells(bool with_simplices) {
  std::vector<std::string> names;
  for (const CellShape shape : cell_shapes()) {
    if (dimension(shape) >= 2 && (with_simplices || !is_simplex(shape))) names.push_back(plural_name(shape));
  }
  return join_names(names, " or ", false);
}

}  // namespace ricochet
