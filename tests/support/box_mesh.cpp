#include "support/box_mesh.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <stdexcept>

#include "ricochet/fem/cell_integration.hpp"
#include "ricochet/mesh/build_mesh.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet::test_support {

namespace {

/// Position of a node in half box widths, so that midpoints are integers as well.
using LatticePoint = std::array<int, 3>;

LatticePoint corner(int k) { return {2 * (k & 1), 2 * ((k >> 1) & 1), 2 * ((k >> 2) & 1)}; }

/// Returns the cells of one box as lists of its corners (numbered by their bits), positively oriented.
std::vector<std::vector<int>> cells_of_box(CellShape shape, bool flipped) {
  switch (shape) {
    case CellShape::triangle:
      if (flipped) return {{0, 1, 3}, {0, 3, 2}};
      return {{0, 1, 2}, {1, 3, 2}};
    case CellShape::quadrilateral:
      return {{0, 1, 2, 3}};
    case CellShape::tetrahedron:  // one along each monotone path from corner 0 to corner 7
      return {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}};
    case CellShape::hexahedron:
      return {{0, 1, 2, 3, 4, 5, 6, 7}};
    case CellShape::interval:
      break;
  }
  throw std::logic_error("boxes of " + plural_name(shape) + " are not made");
}

class Builder {
 public:
  explicit Builder(const BoxMesh& box) : box_(box), dimension_(ricochet::dimension(box.shape)), random_(20061) {
    mesh_.source = "box in memory";
    mesh_.dimension = dimension_;
    mesh_.degree = box.geometry_degree;
    mesh_.cells.push_back({box.shape, node_count(box.shape, box.geometry_degree), {}, {}});
    for (std::size_t f = 0; f < describe(box.shape).facets.size(); ++f) {
      const CellShape facet = facet_shape(box.shape, f);
      if (find_block(facet) == nullptr) mesh_.facets.push_back({facet, node_count(facet, box.geometry_degree), {}, {}});
    }
    mesh_.groups.push_back({"body", 1, dimension_, {}});
    for (int axis = 0; axis < dimension_; ++axis) {
      for (const char* end : {"0", "1"}) {
        mesh_.groups.push_back({std::string(1, "xyz"[axis]) + end, int(mesh_.groups.size()) + 1, dimension_ - 1, {}});
      }
    }
    mesh_.groups.push_back({"boundary", 99, dimension_ - 1, {}});
  }

  Mesh build() {
    const int depth = dimension_ == 3 ? box_.counts[2] : 1;
    for (int k = 0; k < depth; ++k) {
      for (int j = 0; j < box_.counts[1]; ++j) {
        for (int i = 0; i < box_.counts[0]; ++i) {
          for (const std::vector<int>& corners : cells_of_box(box_.shape, (i + j) % 2 == 1)) {
            add_cell({2 * i, 2 * j, 2 * k}, corners);
          }
        }
      }
    }
    mesh_.nodes.resize(dimension_, Index(positions_.size()));
    for (std::size_t node = 0; node < positions_.size(); ++node) {
      mesh_.nodes.col(Index(node)) = box_.map ? box_.map(positions_[node]) : positions_[node];
      mesh_.node_tags.push_back(std::int64_t(node) + 1);
    }
    Index first = 0;
    for (const CellBlock& block : mesh_.facets) {
      for (const auto& [group, facet] : members_[block.shape]) mesh_.groups[group].members.push_back(first + facet);
      first += block.size();
    }
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] CellBlock* find_block(CellShape shape) {
    const auto found = std::ranges::find_if(mesh_.facets, [&](const CellBlock& block) { return block.shape == shape; });
    return found == mesh_.facets.end() ? nullptr : &*found;
  }

  void add_cell(const LatticePoint& origin, const std::vector<int>& corners) {
    std::vector<LatticePoint> vertices;
    for (const int k : corners) {
      LatticePoint place = corner(k);
      for (std::size_t axis = 0; axis < 3; ++axis) place[axis] += origin[axis];
      vertices.push_back(place);
    }
    std::vector<Index> nodes;
    for (const std::vector<int>& support : node_vertices(box_.shape, box_.geometry_degree)) {
      nodes.push_back(node_between(vertices, support));
    }
    CellBlock& block = mesh_.cells[0];
    mesh_.groups[0].members.push_back(block.size());
    block.nodes.insert(block.nodes.end(), nodes.begin(), nodes.end());
    block.tags.push_back(block.size() + 1);
    const auto& facet_vertices = facet_nodes(box_.shape, 1);
    for (std::size_t facet = 0; facet < facet_vertices.size(); ++facet) add_facet(vertices, nodes, facet);
  }

  /// Keeps the facet if it lies on a side of the box.
  void add_facet(const std::vector<LatticePoint>& vertices, const std::vector<Index>& nodes, std::size_t facet) {
    const auto& own = facet_nodes(box_.shape, 1)[facet];
    for (int axis = 0; axis < dimension_; ++axis) {
      const auto a = std::size_t(axis);
      for (const int end : {0, 1}) {
        const int wanted = 2 * end * box_.counts[a];
        const auto there = [&](int v) { return vertices[std::size_t(v)][a] == wanted; };
        if (!std::ranges::all_of(own, there)) continue;
        CellBlock& block = *find_block(facet_shape(box_.shape, facet));
        for (const std::size_t group : {std::size_t(1 + 2 * axis + end), mesh_.groups.size() - 1})
          members_[block.shape].emplace_back(group, block.size());
        for (const int node : facet_nodes(box_.shape, box_.geometry_degree)[facet]) {
          block.nodes.push_back(nodes[std::size_t(node)]);
        }
        block.tags.push_back(1000000 + block.size());
      }
    }
  }

  Index node_between(const std::vector<LatticePoint>& vertices, const std::vector<int>& support) {
    LatticePoint sum{};
    for (const int v : support) {
      for (std::size_t axis = 0; axis < 3; ++axis) sum[axis] += vertices[std::size_t(v)][axis];
    }
    for (int& coordinate : sum) coordinate /= int(support.size());
    if (support.size() == 1) return number(sum, [&] { return distorted(sum); });
    return number(sum, [&] {
      Vector mean = Vector::Zero(dimension_);
      for (const int v : support) {
        const LatticePoint& at = vertices[std::size_t(v)];
        mean += positions_[std::size_t(number(at, [&] { return distorted(at); }))];
      }
      return Vector(mean / double(support.size()));
    });
  }

  template <class Position>
  Index number(const LatticePoint& place, const Position& position) {
    const auto found = numbers_.find(place);
    if (found != numbers_.end()) return found->second;
    const Vector at = position();  // may number vertices itself
    const auto index = Index(positions_.size());
    numbers_[place] = index;
    positions_.push_back(at);
    return index;
  }

  Vector distorted(const LatticePoint& place) {
    Vector at(dimension_);
    for (int axis = 0; axis < dimension_; ++axis) {
      const auto a = std::size_t(axis);
      const double width = 1.0 / box_.counts[a];
      const double random = double(random_()) / 2147483648.0 - 1.0;
      const bool on_side = place[a] == 0 || place[a] == 2 * box_.counts[a];
      at[axis] = 0.5 * width * place[a] + (on_side ? 0.0 : box_.distortion * width * random);
    }
    return at;
  }

  const BoxMesh& box_;
  int dimension_;
  std::mt19937 random_;  // the numbers of the engine are the same everywhere, those of distributions are not
  Mesh mesh_;
  std::vector<Vector> positions_;
  std::map<CellShape, std::vector<std::pair<std::size_t, Index>>> members_;  // of facets: group, number in the block
  std::map<LatticePoint, Index> numbers_;
};

}  // namespace

std::vector<CellShape> all_cell_shapes() {
  std::vector<CellShape> result = cell_shapes();
  std::erase_if(result, [](CellShape shape) { return dimension(shape) < 2; });
  return result;
}

BoxMesh box_of(CellShape shape, std::vector<int> counts) {
  BoxMesh box;
  box.shape = shape;
  box.counts = std::move(counts);
  return box;
}

Mesh make_box_mesh(const BoxMesh& box) { return Builder(box).build(); }

Mesh make_checked_box_mesh(const BoxMesh& box) {
  Mesh mesh = make_box_mesh(box);
  gmsh::check_facets(mesh);
  gmsh::orient_cells(mesh);
  gmsh::check_coincident_nodes(mesh, false);
  return mesh;
}

PointMap affine_map(const Matrix& matrix, const Vector& shift) {
  return [=](const Vector& x) -> Vector { return matrix * x + shift; };
}

PointMap swirl_map(double amplitude) {
  return [amplitude](const Vector& x) -> Vector {
    double bump = amplitude;
    for (const double coordinate : x) bump *= std::sin(M_PI * coordinate);
    Vector result = x;
    for (Index k = 0; k < x.size(); ++k) result[k] += bump * (k % 2 == 0 ? 1.0 : -0.8);
    return result;
  };
}

PointMap bend_map() {
  return [](const Vector& x) -> Vector {
    Vector result(x.size());
    result[0] = (1.0 + x[1]) * std::sin(0.9 * x[0]) + 0.1 * x[1];
    result[1] = (1.0 + x[1]) * std::cos(0.9 * x[0]);
    if (x.size() == 3) result[2] = 1.2 * x[2] + 0.15 * x[0] * x[0] - 0.1 * x[1] * x[2];
    return result;
  };
}

PointMap ball_map(const Vector& centre) {
  return [centre](const Vector& x) -> Vector {
    const Vector s = 2.0 * x - Vector::Ones(x.size());
    Vector result(x.size());
    for (Index k = 0; k < x.size(); ++k) {
      const double a = s[(k + 1) % x.size()] * s[(k + 1) % x.size()];
      if (x.size() == 2) {
        result[k] = s[k] * std::sqrt(1.0 - 0.5 * a);
      } else {
        const double b = s[(k + 2) % 3] * s[(k + 2) % 3];
        result[k] = s[k] * std::sqrt(1.0 - 0.5 * a - 0.5 * b + a * b / 3.0);
      }
    }
    return result + centre;
  };
}

Material test_material() { return {"body", 1.7, make_linear_elasticity(1.3, 0.8)}; }

std::unique_ptr<MeshedBody> make_meshed_body(Mesh mesh, int displacement_degree, PlaneState plane) {
  auto test = std::make_unique<MeshedBody>();
  test->mesh = std::move(mesh);
  test->space = make_displacement_space(test->mesh, displacement_degree);
  test->body = Body{
      &test->mesh, &test->space, plane, {test_material()}, std::vector<int>(std::size_t(test->mesh.cell_count()), 0)};
  return test;
}

Vector interpolate(const DisplacementSpace& space, const PointMap& field) {
  Vector result(space.dof_count());
  for (Index node = 0; node < space.node_count(); ++node) {
    result.segment(node * space.dimension, space.dimension) = field(space.nodes.col(node));
  }
  return result;
}

double integrate(const MeshedBody& test, int degree, const std::function<double(const Vector&)>& value) {
  double sum = 0.0;
  const int d = test.mesh.dimension;
  for (const CellBlock& block : test.mesh.cells) {
    const QuadratureRule rule = quadrature(block.shape, degree);
    const Tabulation map = ReferenceElement::get(block.shape, test.mesh.degree).tabulate(rule.points);
    for (Index cell = 0; cell < block.size(); ++cell) {
      Matrix corners(d, block.nodes_per_cell);
      for (int k = 0; k < block.nodes_per_cell; ++k) corners.col(k) = test.mesh.nodes.col(block.cell(cell)[k]);
      for (Index q = 0; q < rule.weights.size(); ++q) {
        const Matrix jacobian = corners * map.gradients[std::size_t(q)];
        sum += rule.weights[q] * jacobian.determinant() * value(corners * map.values.col(q));
      }
    }
  }
  return sum;
}

std::string ElementKind::label() const {
  return name(shape) + "_geometry" + std::to_string(geometry_degree) + "_displacement" +
         std::to_string(displacement_degree);
}

std::vector<ElementKind> all_element_kinds() {
  std::vector<ElementKind> kinds;
  for (const CellShape shape : all_cell_shapes()) {
    for (const int geometry : {1, 2}) {
      for (const int displacement : {1, 2}) kinds.push_back({shape, geometry, displacement});
    }
  }
  return kinds;
}

}  // namespace ricochet::test_support
