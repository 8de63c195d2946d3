#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet {

#define RICOCHET_DECLARE_SHAPE(shape) extern CellShapeDescription describe_##shape();
RICOCHET_CELL_SHAPES(RICOCHET_DECLARE_SHAPE)

const CellShapeDescription& describe(CellShape shape) {
#define RICOCHET_DESCRIBE_SHAPE(shape) describe_##shape(),
  static const std::vector<CellShapeDescription> all{RICOCHET_CELL_SHAPES(RICOCHET_DESCRIBE_SHAPE)};
  return all[static_cast<std::size_t>(shape)];
}

const std::vector<CellShape>& cell_shapes() {
#define RICOCHET_LIST_SHAPE(shape) CellShape::shape,
  static const std::vector<CellShape> all{RICOCHET_CELL_SHAPES(RICOCHET_LIST_SHAPE)};
  return all;
}

int dimension(CellShape shape) {
  return describe(shape).dimension;
}

int vertex_count(CellShape shape) {
  return static_cast<int>(describe(shape).vertices.size());
}

bool is_simplex(CellShape shape) {
  return vertex_count(shape) == dimension(shape) + 1;
}

std::string name(CellShape shape) {
#define RICOCHET_NAME_SHAPE(shape) #shape,
  static const std::vector<std::string> names{RICOCHET_CELL_SHAPES(RICOCHET_NAME_SHAPE)};
  return names[static_cast<std::size_t>(shape)];
}

std::string plural_name(CellShape shape) {
  const std::string singular = name(shape);
  return singular.ends_with("hedron") ? singular.substr(0, singular.size() - 2) + "a" : singular + "s";
}

std::string names_of_cells() {
  std::string result;
  for (const CellShape shape : cell_shapes()) {
    if (dimension(shape) < 2) continue;
    const bool is_last = shape == cell_shapes().back();
    result += (result.empty() ? "" : is_last ? " or " : ", ") + plural_name(shape);
  }
  return result;
}

}  // namespace ricochet
