#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <bit>
#include <cmath>

#include "ricochet/base/error.hpp"
#include "ricochet/base/log.hpp"
#include "ricochet/base/text.hpp"
#include "ricochet/mesh/boundary_facets.hpp"
#include "ricochet/mesh/build_mesh.hpp"
#include "ricochet/mesh/disjoint_sets.hpp"
#include "ricochet/mesh/offenders.hpp"
#include "ricochet/mesh/reference_cell.hpp"
#include "ricochet/mesh/shapes/cell_shape_description.hpp"

namespace ricochet::gmsh {

namespace {

// Relative to the lengths of the Jacobian's columns, and to the size of the mesh.
constexpr double flatness_tolerance = 1e-12;
constexpr double coincidence_tolerance = 1e-10;  // Gmsh places nodes on curves to about 1e-12

/// Gradients of the geometry's shape functions, one column per node, at each point where the Jacobian is evaluated: all
/// nodes, or only one on a straight simplex.
std::vector<Matrix> gradients_at_nodes(CellShape shape, int degree) {
  const auto& nodes = node_vertices(shape, degree);
  std::vector<Matrix> result;
  for (const std::vector<int>& point : nodes) {
    Matrix& gradients = result.emplace_back(dimension(shape), Index(nodes.size()));
    for (Index k = 0; k < gradients.cols(); ++k) {
      const Eigen::Vector3d node = reference_position(shape, nodes[std::size_t(k)]);
      const LagrangeValue function = describe(shape).lagrange(degree, node, reference_position(shape, point));
      gradients.col(k) = function.gradient.head(dimension(shape));
    }
    if (is_simplex(shape) && degree == 1) break;
  }
  return result;
}

struct Orientation {
  bool positive = false;  ///< somewhere in the cell
  bool negative = false;
  bool flat = false;
};

/// Signs of the Jacobian determinant, scaled by the lengths of its columns, so that a thin cell is not mistaken for a
/// flat one.
template <int Dimension>
Orientation orientation(const Points& points, const Index* cell, const std::vector<Matrix>& gradients) {
  Orientation result;
  for (const Matrix& gradient : gradients) {
    Eigen::Matrix<double, Dimension, Dimension> jacobian = Eigen::Matrix<double, Dimension, Dimension>::Zero();
    for (Index node = 0; node < gradient.cols(); ++node) {
      // Relative to the first node, so that a large distance to the origin does not cost digits.
      const Eigen::Matrix<double, Dimension, 1> position =
          points.col(cell[node]).template head<Dimension>() - points.col(cell[0]).template head<Dimension>();
      jacobian += position * gradient.col(node).template head<Dimension>().transpose();
    }
    const double lengths = jacobian.colwise().norm().prod();
    const double determinant = jacobian.determinant();
    if (determinant > flatness_tolerance * lengths) {
      result.positive = true;
    } else if (determinant < -flatness_tolerance * lengths) {
      result.negative = true;
    } else {
      result.flat = true;
    }
  }
  return result;
}

void reverse_orientation(Index* cell, const std::vector<int>& mirrored, std::vector<Index>& nodes) {
  nodes.assign(cell, cell + mirrored.size());
  for (std::size_t node = 0; node < mirrored.size(); ++node) cell[node] = nodes[std::size_t(mirrored[node])];
}

/// Centre of a facet's vertices, as text.
std::string facet_centre_text(const Mesh& mesh, const CellFacet& facet) {
  const CellBlock& block = mesh.cells[facet.block];
  const std::vector<int>& vertices = outward_facet_vertices(block.shape)[facet.local];
  Vector middle = Vector::Zero(mesh.dimension);
  for (const int vertex : vertices) middle += mesh.nodes.col(block.cell(facet.cell)[vertex]);
  middle /= double(vertices.size());
  return fmt::format("({:.6g})", fmt::join(middle.begin(), middle.end(), ", "));
}

/// Refuses folded meshes. An inverted straight simplex has a negative Jacobian throughout, as if its nodes were only
/// numbered in reverse. Its neighbours distinguish the two cases: they are on the wrong side of it.
void check_folds(const Mesh& mesh) {
  const std::vector<SharedFacet> found = folded_facets(mesh.cells);
  if (found.empty()) return;
  const auto tag = [&](const CellFacet& facet) { return mesh.cells[facet.block].tags[std::size_t(facet.cell)]; };
  constexpr std::size_t most = 5;
  std::string pairs;
  for (std::size_t i = 0; i < std::min(found.size(), most); ++i) {
    pairs += fmt::format("{}elements {} and {} at {}", i == 0 ? "" : ", ", tag(found[i].first), tag(found[i].second),
                         facet_centre_text(mesh, found[i].first));
  }
  fail_mesh(mesh.source,
            fmt::format("the mesh is folded and cells overlap: {} on the same side of the facet that they share: {}{}; "
                        "a node has probably been moved across its neighbours: move it back, or remesh the part",
                        counted(found.size(), "pair of cells is", "pairs of cells are"), pairs,
                        found.size() > most ? ", …" : ""));
}

template <int Dimension>
void orient_cells_of_dimension(Mesh& mesh) {
  Offenders reversed;
  Offenders tangled;
  Offenders flat;
  std::vector<Index> nodes;
  for (CellBlock& block : mesh.cells) {
    const std::vector<Matrix> gradients = gradients_at_nodes(block.shape, mesh.degree);
    const std::vector<int>& mirrored = mirrored_nodes(block.shape, mesh.degree);
    for (Index i = 0; i < block.size(); ++i) {
      const Orientation found = orientation<Dimension>(mesh.nodes, block.cell(i), gradients);
      const std::int64_t tag = block.tags[std::size_t(i)];
      if (found.flat) {
        flat.add(tag);
      } else if (found.negative && found.positive) {
        tangled.add(tag);
      } else if (found.negative) {
        reversed.add(tag);
        reverse_orientation(block.nodes.data() + i * block.nodes_per_cell, mirrored, nodes);
      }
    }
  }
  if (flat.any())
    fail_mesh(mesh.source, fmt::format("degenerate cells, whose Jacobian vanishes: {}", flat.text("element")));
  if (tangled.any()) {
    const char* cure = mesh.degree > 1
                           ? "; use smaller cells where the part is curved, or set Mesh.HighOrderOptimize = 2 in Gmsh"
                           : "";
    fail_mesh(mesh.source,
              fmt::format("tangled cells, whose Jacobian changes sign: {}{}", tangled.text("element"), cure));
  }
  if (reversed.any()) {
    const bool all = reversed.count() == mesh.cell_count();
    if (!all) check_folds(mesh);
    log::info(fmt::format(
        "{0}: {1} {2} reversed (a negative Jacobian) and {2} reoriented; the shape of the mesh is unchanged",
        mesh.source,
        all ? (reversed.count() == 1 ? "its only cell" : fmt::format("all {} cells", reversed.count()))
            : fmt::format("of {} cells, {}", mesh.cell_count(), reversed.text("element")),
        reversed.count() == 1 ? "was" : "were"));
  }
}

template <int Dimension>
Offenders cells_not_positive(const Mesh& mesh) {
  Offenders result;
  for (const CellBlock& block : mesh.cells) {
    const std::vector<Matrix> gradients = gradients_at_nodes(block.shape, mesh.degree);
    for (Index i = 0; i < block.size(); ++i) {
      const Orientation found = orientation<Dimension>(mesh.nodes, block.cell(i), gradients);
      if (found.flat || found.negative) result.add(block.tags[std::size_t(i)]);
    }
  }
  return result;
}

/// A hash of boxes a few tolerances wide. Distances alone decide, so boxes that share a bucket only cost time.
class NodeGrid {
 public:
  explicit NodeGrid(const Points& nodes)
      : nodes_(nodes),
        origin_(nodes.rowwise().minCoeff()),
        tolerance_(coincidence_tolerance * (nodes.rowwise().maxCoeff() - origin_).maxCoeff()),
        heads_(std::bit_ceil(std::size_t(nodes.cols()) + 1), -1),
        next_(std::size_t(nodes.cols()), -1) {}

  /// Returns a previously entered node at the same position, or −1; then enters the node.
  Index find_and_enter(Index node) {
    Box low{};
    Box high{};
    Box own{};
    for (Index axis = 0; axis < nodes_.rows(); ++axis) {
      const auto k = std::size_t(axis);
      const double distance = nodes_(axis, node) - origin_(axis);
      low[k] = box(distance - tolerance_);
      high[k] = box(distance + tolerance_);
      own[k] = box(distance);
    }
    Index found = -1;
    Box at{};
    for (at[0] = low[0]; at[0] <= high[0]; ++at[0]) {
      for (at[1] = low[1]; at[1] <= high[1]; ++at[1]) {
        for (at[2] = low[2]; at[2] <= high[2]; ++at[2]) found = std::max(found, search(node, at));
      }
    }
    Index& head = heads_[bucket(own)];
    next_[std::size_t(node)] = head;
    head = node;
    return found;
  }

 private:
  using Box = std::array<std::int64_t, 3>;
  static constexpr double tolerances_per_box = 16.0;

  std::int64_t box(double distance) const {
    return std::int64_t(std::floor(distance / (tolerances_per_box * tolerance_) + 0.381966));
  }
  std::size_t bucket(const Box& box) const {
    std::uint64_t hash = 0;
    for (const std::int64_t k : box) hash = (std::rotl(hash, 29) ^ std::uint64_t(k)) * 0x9e3779b97f4a7c15u;
    return std::size_t(hash ^ (hash >> 32)) & (heads_.size() - 1);
  }
  Index search(Index node, const Box& box) const {
    for (Index other = heads_[bucket(box)]; other >= 0; other = next_[std::size_t(other)]) {
      if ((nodes_.col(node) - nodes_.col(other)).norm() <= tolerance_) return other;
    }
    return -1;
  }

  const Points& nodes_;
  Vector origin_;
  double tolerance_;
  std::vector<Index> heads_;
  std::vector<Index> next_;
};

/// Sets of nodes connected by cells.
DisjointSets bodies_of(const Mesh& mesh) {
  DisjointSets bodies(mesh.node_count());
  for (const CellBlock& block : mesh.cells) {
    for (Index cell = 0; cell < block.size(); ++cell) {
      for (int k = 1; k < block.nodes_per_cell; ++k) bodies.join(block.cell(cell)[0], block.cell(cell)[k]);
    }
  }
  return bodies;
}

}  // namespace

void orient_cells(Mesh& mesh) {
  mesh.dimension == 2 ? orient_cells_of_dimension<2>(mesh) : orient_cells_of_dimension<3>(mesh);
}

void require_positive_cells(const Mesh& mesh, const std::string& what) {
  const Offenders found = mesh.dimension == 2 ? cells_not_positive<2>(mesh) : cells_not_positive<3>(mesh);
  if (!found.any()) return;
  throw Error(ErrorKind::invalid_input,
              fmt::format("{} so far that cells are inverted: {}", what, found.text("element")));
}

void check_coincident_nodes(const Mesh& mesh, bool bodies_may_touch) {
  NodeGrid grid(mesh.nodes);
  DisjointSets bodies = bodies_may_touch ? bodies_of(mesh) : DisjointSets(0);
  Index count = 0;
  std::string pairs;
  for (Index node = 0; node < mesh.node_count(); ++node) {
    const Index other = grid.find_and_enter(node);
    if (other < 0) continue;
    if (bodies_may_touch && bodies.root(node) != bodies.root(other)) continue;
    if (++count > 5) continue;
    pairs += fmt::format("{}{} and {}", count == 1 ? "" : ", ", mesh.node_tags[std::size_t(other)],
                         mesh.node_tags[std::size_t(node)]);
  }
  if (count == 0) return;
  fail_mesh(
      mesh.source,
      fmt::format("{} at the same position: {}{}; cells that should be joined are not (in Gmsh: Mesh > Remove "
                  "duplicate nodes, or BooleanFragments on the geometry){}",
                  counted(count, "pair of nodes is", "pairs of nodes are"), pairs, count > 5 ? ", …" : "",
                  bodies_may_touch
                      ? ""
                      : "; if the nodes belong to bodies that touch, add a [[contact]] with \"against\" to the case"));
}

}  // namespace ricochet::gmsh
