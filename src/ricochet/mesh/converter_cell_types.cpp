#include <algorithm>

#include "ricochet/base/json.hpp"
#include "ricochet/mesh/converter_files.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet::gmsh {

namespace {

std::vector<int> inverse_of(const std::vector<int>& order) {
  std::vector<int> result(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) result[std::size_t(order[i])] = int(i);
  return result;
}

/// Nodes of a facet in meshio's order and numbers. The facet is given by the file's numbers of vertices.
std::vector<int> nodes_of_facet_in_file(CellShape shape, CellShape own, int degree, const VertexSet& facet) {
  const std::vector<int> in_file = inverse_of(meshio_nodes(shape, degree)), corner = inverse_of(meshio_nodes(own, 1));
  std::vector<int> result;
  for (const int node : meshio_nodes(own, degree)) {
    VertexSet vertices = node_vertices(own, degree)[std::size_t(node)];
    for (int& vertex : vertices) {
      const int of_cell = facet[std::size_t(corner[std::size_t(vertex)])];
      vertex = describe(shape).file_vertices[std::size_t(of_cell)];
    }
    result.push_back(in_file[std::size_t(node_at_mean(shape, vertices))]);
  }
  return result;
}

Json type_of(CellShape shape, int degree) {
  const CellShapeDescription& cell = describe(shape);
  std::vector<int> order;
  for (const int node : gmsh_nodes(shape, degree))
    order.push_back(inverse_of(meshio_nodes(shape, degree))[std::size_t(node)]);
  Json facets = Json::array();
  for (const VertexSet& facet : cell.abaqus_facets) {
    const auto same_size = [&](const VertexSet& each) { return each.size() == facet.size(); };
    const auto like = std::ranges::find_if(cell.facets, same_size) - cell.facets.begin();
    const CellShape own = facet_shape(shape, std::size_t(like));
    facets.push_back(Json{{"kind", file_type(own, degree).meshio_name},
                          {"nodes", nodes_of_facet_in_file(shape, own, degree, facet)}});
  }
  const VertexSets& points = node_vertices(shape, degree);
  const auto is_in_face = [](const VertexSet& point) { return point.size() > 2; };
  return {{"gmsh", file_type(shape, degree).gmsh},
          {"dimension", cell.dimension},
          {"vertices", vertex_count(shape)},
          {"order", order},
          {"facets", facets},
          {"exodus_sides", cell.exodus_sides},
          {"has_face_nodes", std::ranges::any_of(points, is_in_face)}};
}

}  // namespace

std::string converter_cell_types() {
  Json types = Json::object();
  for (const CellShape shape : cell_shapes()) {
    for (const int degree : {1, 2}) types[file_type(shape, degree).meshio_name] = type_of(shape, degree);
  }
  return Json{{"types", types}, {"names", names_of_cells()}}.dump();
}

}  // namespace ricochet::gmsh
