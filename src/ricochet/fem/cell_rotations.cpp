#include "ricochet/fem/cell_rotations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/base/instruction_sets.hpp"
#include "ricochet/base/packs.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/fem/cell_integration.hpp"

namespace ricochet {

namespace {

/// Largest rotation among some cells. Below a right angle the tangents can be compared, so that a single arc tangent
/// serves all cells. The sum of two is their maximum.
struct LargestRotation {
  double tangent = 0.0;
  double beyond_right_angle = 0.0;

  /// Includes a rotation; `axial` and `trace` may have a common positive factor.
  void enter(double axial, double trace) {
    if (trace > 0.0) {
      tangent = std::max(tangent, axial / trace);
    } else {
      beyond_right_angle = std::max(beyond_right_angle, std::atan2(axial, trace));
    }
  }
  LargestRotation& operator+=(const LargestRotation& other) {
    tangent = std::max(tangent, other.tangent);
    beyond_right_angle = std::max(beyond_right_angle, other.beyond_right_angle);
    return *this;
  }
  [[nodiscard]] double angle() const { return std::max(beyond_right_angle, std::atan(tangent)); }
};

/// Displacement gradient H(a, k) = ∂u_a/∂x_k of one cell.
template <int d>
Eigen::Matrix<double, d, d> displacement_gradient(const Index* nodes, int count, const double* gradients,
                                                  const Vector& u) {
  Eigen::Matrix<double, d, d> result = Eigen::Matrix<double, d, d>::Zero();
  for (int i = 0; i < count; ++i) {
    result += u.segment<d>(nodes[i] * d) * Eigen::Map<const Eigen::Matrix<double, 1, d>>(gradients + i * d);
  }
  return result;
}

/// Computes the largest rotation from stored gradients.
LargestRotation largest_of(const CellBlock& cells, const std::vector<double>& gradients, int d, Index first, Index last,
                           const Vector& displacement) {
  LargestRotation result;
  const int count = cells.nodes_per_cell;
  for (Index cell = first; cell < last; ++cell) {
    const double* own = gradients.data() + cell * count * d;
    if (d == 2) {
      const Eigen::Matrix2d h = displacement_gradient<2>(cells.cell(cell), count, own, displacement);
      result.enter(std::abs(h(1, 0) - h(0, 1)), 2.0 + h(0, 0) + h(1, 1));
    } else {
      const Eigen::Matrix3d h = displacement_gradient<3>(cells.cell(cell), count, own, displacement);
      const Eigen::Vector3d axial(h(2, 1) - h(1, 2), h(0, 2) - h(2, 0), h(1, 0) - h(0, 1));
      result.enter(axial.norm(), 2.0 + h.trace());
    }
  }
  return result;
}

/// Batch of simplices for SIMD: component k of edge e of cell i is edge[e][k][i], where edges are those from the first
/// vertex, as reference positions and as differences of displacement.
template <int d>
struct SimplexBatch {
  static constexpr int size = 64;
  double edge[d][d][size], difference[d][d][size];
  double axial[size], trace[size];  ///< both times the determinant of the edges; in 3D `axial` is squared
  /// Largest tangent, in 3D its square; 0 beyond a right angle.
  double largest_tangent;
  bool beyond_right_angle;  ///< whether some rotation is

  [[nodiscard]] LargestRotation largest() const {
    LargestRotation result;
    result.tangent = d == 2 ? largest_tangent : std::sqrt(largest_tangent);
    if (!beyond_right_angle) return result;
    for (int i = 0; i < size; ++i) {
      if (trace[i] <= 0.0) result.enter(d == 2 ? axial[i] : std::sqrt(axial[i]), trace[i]);
    }
    return result;
  }
};

/// Loads the d numbers of a node; in 3D the fourth is meaningless, and is missing for the last node, at dof `last`.
RICOCHET_PART_OF_CALLER Pack<4> numbers_of_node(const double* values, int dof, int last) {
  return dof != last ? load<4>(values + dof) : Pack<4>{values[dof], values[dof + 1], values[dof + 2], 0.0};
}

/// Transposes rows into columns.
RICOCHET_PART_OF_CALLER void transpose(Pack<4> (&rows)[4]) {
  const Pack<4> a = __builtin_shufflevector(rows[0], rows[1], 0, 4, 2, 6),
                b = __builtin_shufflevector(rows[0], rows[1], 1, 5, 3, 7),
                c = __builtin_shufflevector(rows[2], rows[3], 0, 4, 2, 6),
                e = __builtin_shufflevector(rows[2], rows[3], 1, 5, 3, 7);
  rows[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
  rows[1] = __builtin_shufflevector(b, e, 0, 1, 4, 5);
  rows[2] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
  rows[3] = __builtin_shufflevector(b, e, 2, 3, 6, 7);
}

/// Gathers a batch. `vertices`: the first dofs of d + 1 nodes per cell. The last cell is repeated in unused lanes.
RICOCHET_PART_OF_CALLER void gather(const int* vertices, int count, const double* positions, const double* displacement,
                                    int, SimplexBatch<2>& batch) {
  for (int i = 0; i < SimplexBatch<2>::size; i += 4) {
    Pack<4> a[4], b[4];  // an edge and its difference
    for (int k = 0; k < 4; ++k) {
      const int* const at = vertices + 3 * std::min(i + k, count - 1);
      const Pack<2> x = load<2>(positions + at[0]), u = load<2>(displacement + at[0]);
      const Pack<4> first = __builtin_shufflevector(x, u, 0, 1, 2, 3);
      const Pack<2> ax = load<2>(positions + at[1]), au = load<2>(displacement + at[1]);
      const Pack<2> bx = load<2>(positions + at[2]), bu = load<2>(displacement + at[2]);
      a[k] = __builtin_shufflevector(ax, au, 0, 1, 2, 3) - first;
      b[k] = __builtin_shufflevector(bx, bu, 0, 1, 2, 3) - first;
    }
    transpose(a);
    transpose(b);
    for (int k = 0; k < 2; ++k) {
      store<4>(batch.edge[0][k] + i, a[k]);
      store<4>(batch.difference[0][k] + i, a[k + 2]);
      store<4>(batch.edge[1][k] + i, b[k]);
      store<4>(batch.difference[1][k] + i, b[k + 2]);
    }
  }
}

RICOCHET_PART_OF_CALLER void gather(const int* vertices, int count, const double* positions, const double* displacement,
                                    int last, SimplexBatch<3>& batch) {
  const auto gather_differences = [&](const double* values, double(&to)[3][3][SimplexBatch<3>::size], int i) {
    Pack<4> of_edge[3][4];
    for (int k = 0; k < 4; ++k) {
      const int* const at = vertices + 4 * std::min(i + k, count - 1);
      const Pack<4> first = numbers_of_node(values, at[0], last);
      for (int e = 0; e < 3; ++e) of_edge[e][k] = numbers_of_node(values, at[e + 1], last) - first;
    }
    for (int e = 0; e < 3; ++e) {
      transpose(of_edge[e]);
      for (int k = 0; k < 3; ++k) store<4>(to[e][k] + i, of_edge[e][k]);
    }
  };
  for (int i = 0; i < SimplexBatch<3>::size; i += 4) {
    gather_differences(positions, batch.edge, i);
    gather_differences(displacement, batch.difference, i);
  }
}

/// Replaces the first `half` numbers by the larger, or smaller, of each and its counterpart in the second half.
/// Compilers vectorize this, but not a reduction over all.
template <int half>
RICOCHET_PART_OF_CALLER void keep_larger(double* values) {
  for (int i = 0; i < half; ++i) values[i] = values[i + half] > values[i] ? values[i + half] : values[i];
}
template <int half>
RICOCHET_PART_OF_CALLER void keep_smaller(double* values) {
  for (int i = 0; i < half; ++i) values[i] = values[i + half] < values[i] ? values[i + half] : values[i];
}

/// Computes the batch results from `axial` and `trace`.
template <int d>
RICOCHET_PART_OF_CALLER void compare(SimplexBatch<d>& batch) {
  constexpr int size = SimplexBatch<d>::size;
  static_assert(size == 64);
  double tangent[size], least[size];
  for (int i = 0; i < size; ++i) {
    const double trace = batch.trace[i];
    const double quotient = d == 2 ? batch.axial[i] / trace : batch.axial[i] / (trace * trace);
    tangent[i] = trace > 0.0 ? quotient : 0.0;
    least[i] = trace;
  }
  keep_larger<32>(tangent);
  keep_larger<16>(tangent);
  keep_larger<8>(tangent);
  keep_smaller<32>(least);
  keep_smaller<16>(least);
  keep_smaller<8>(least);
  batch.largest_tangent = *std::max_element(tangent, tangent + 8);
  batch.beyond_right_angle = *std::min_element(least, least + 8) <= 0.0;
}

/// ∇u = Σ_e (difference e) ⊗ c_e / det with the dual vectors c of the edges; its axial part is Σ c_e × (difference e).
RICOCHET_EACH_INSTRUCTION_SET(void, evaluate,
                              (const int* vertices, int count, const double* positions, const double* displacement,
                               int last, SimplexBatch<2>& batch),
                              (vertices, count, positions, displacement, last, batch)) {
  gather(vertices, count, positions, displacement, last, batch);
  const auto& [a, b] = batch.edge;
  const auto& [u, v] = batch.difference;
  for (int i = 0; i < SimplexBatch<2>::size; ++i) {
    const double determinant = a[0][i] * b[1][i] - a[1][i] * b[0][i];
    const double curl = (u[1][i] * b[1][i] + u[0][i] * b[0][i]) - (v[1][i] * a[1][i] + v[0][i] * a[0][i]);
    const double divergence = (u[0][i] * b[1][i] - u[1][i] * b[0][i]) + (v[1][i] * a[0][i] - v[0][i] * a[1][i]);
    batch.axial[i] = std::abs(curl);
    batch.trace[i] = 2.0 * determinant + divergence;
  }
  compare(batch);
}

/// Written out: inner loops over edges would prevent compilers from vectorizing over cells.
RICOCHET_EACH_INSTRUCTION_SET(void, evaluate,
                              (const int* vertices, int count, const double* positions, const double* displacement,
                               int last, SimplexBatch<3>& batch),
                              (vertices, count, positions, displacement, last, batch)) {
  gather(vertices, count, positions, displacement, last, batch);
  const auto& [p, q, r] = batch.edge;
  const auto& [u, v, w] = batch.difference;
  for (int i = 0; i < SimplexBatch<3>::size; ++i) {
    const double a0 = q[1][i] * r[2][i] - q[2][i] * r[1][i], a1 = q[2][i] * r[0][i] - q[0][i] * r[2][i],
                 a2 = q[0][i] * r[1][i] - q[1][i] * r[0][i];
    const double b0 = r[1][i] * p[2][i] - r[2][i] * p[1][i], b1 = r[2][i] * p[0][i] - r[0][i] * p[2][i],
                 b2 = r[0][i] * p[1][i] - r[1][i] * p[0][i];
    const double c0 = p[1][i] * q[2][i] - p[2][i] * q[1][i], c1 = p[2][i] * q[0][i] - p[0][i] * q[2][i],
                 c2 = p[0][i] * q[1][i] - p[1][i] * q[0][i];
    const double curl0 = (a1 * u[2][i] - a2 * u[1][i]) + (b1 * v[2][i] - b2 * v[1][i]) + (c1 * w[2][i] - c2 * w[1][i]);
    const double curl1 = (a2 * u[0][i] - a0 * u[2][i]) + (b2 * v[0][i] - b0 * v[2][i]) + (c2 * w[0][i] - c0 * w[2][i]);
    const double curl2 = (a0 * u[1][i] - a1 * u[0][i]) + (b0 * v[1][i] - b1 * v[0][i]) + (c0 * w[1][i] - c1 * w[0][i]);
    const double divergence = (a0 * u[0][i] + a1 * u[1][i] + a2 * u[2][i]) +
                              (b0 * v[0][i] + b1 * v[1][i] + b2 * v[2][i]) +
                              (c0 * w[0][i] + c1 * w[1][i] + c2 * w[2][i]);
    const double determinant = a0 * p[0][i] + a1 * p[1][i] + a2 * p[2][i];
    batch.axial[i] = curl0 * curl0 + curl1 * curl1 + curl2 * curl2;
    batch.trace[i] = 2.0 * determinant + divergence;
  }
  compare(batch);
}

/// Computes the largest rotation of straight simplices from the positions of their vertices.
template <int d>
LargestRotation largest_of_simplices(const std::vector<int>& vertices, const Points& positions, Index first, Index last,
                                     const Vector& displacement) {
  LargestRotation result;
  SimplexBatch<d> batch;
  const int last_dof = int(displacement.size()) - d;
  for (Index cell = first; cell < last; cell += SimplexBatch<d>::size) {
    const int count = int(std::min<Index>(SimplexBatch<d>::size, last - cell));
    evaluate(vertices.data() + cell * (d + 1), count, positions.data(), displacement.data(), last_dof, batch);
    result += batch.largest();
  }
  return result;
}

/// First dofs of the vertices of all cells, sorted so that nearby cells are adjacent: nodes are numbered by proximity,
/// cells are not.
std::vector<int> sorted_vertices(const CellBlock& cells, int d) {
  const int count = cells.nodes_per_cell;
  const auto lowest = [&](Index cell) { return *std::min_element(cells.cell(cell), cells.cell(cell) + count); };
  std::vector<std::pair<Index, Index>> order(static_cast<std::size_t>(cells.size()));
  for (Index cell = 0; cell < cells.size(); ++cell) order[std::size_t(cell)] = {lowest(cell), cell};
  std::ranges::sort(order);
  std::vector<int> vertices;
  vertices.reserve(cells.nodes.size());
  for (const auto& [node, cell] : order) {
    for (int k = 0; k < count; ++k) vertices.push_back(int(cells.cell(cell)[k]) * d);
  }
  return vertices;
}

template <int d>
std::vector<double> gradients_at_centres(const Body& body, const CellBlock& geometry, const CellBlock& cells) {
  const Points centre = reference_centre(geometry.shape);
  const Tabulation map = ReferenceElement::get(geometry.shape, body.mesh->degree).tabulate(centre);
  const Tabulation shape = ReferenceElement::get(geometry.shape, body.space->degree).tabulate(centre);
  std::vector<double> result(cells.nodes.size() * std::size_t(d));
  parallel_ranges(cells.size(), [&](Index first, Index last) {
    for (Index cell = first; cell < last; ++cell) {
      const Eigen::Matrix<double, d, d> inverse =
          jacobian<d>(body.mesh->nodes, geometry.cell(cell), map.gradients[0]).inverse();
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, d, Eigen::RowMajor>> own(
          result.data() + cell * cells.nodes_per_cell * d, cells.nodes_per_cell, d);
      own = shape.gradients[0].lazyProduct(inverse);
    }
  });
  return result;
}

}  // namespace

CellRotations::CellRotations(const Body& body) : dimension_(body.mesh->dimension), positions_(&body.space->nodes) {
  for (std::size_t b = 0; b < body.space->cells.size(); ++b) {
    const CellBlock& geometry = body.mesh->cells[b];
    const CellBlock& cells = body.space->cells[b];
    blocks_.push_back({&cells, {}, {}});
    if (is_simplex(geometry.shape) && body.mesh->degree == 1 && body.space->degree == 1) {
      blocks_.back().vertices = sorted_vertices(cells, dimension_);
      continue;
    }
    blocks_.back().gradients = dimension_ == 2 ? gradients_at_centres<2>(body, geometry, cells)
                                               : gradients_at_centres<3>(body, geometry, cells);
  }
}

double CellRotations::largest(const Vector& displacement) const {
  LargestRotation result;
  for (const Block& block : blocks_) {
    const CellBlock& cells = *block.cells;
    result += parallel_sum<LargestRotation>(cells.size(), [&](Index first, Index last) {
      if (!block.gradients.empty()) return largest_of(cells, block.gradients, dimension_, first, last, displacement);
      return dimension_ == 2 ? largest_of_simplices<2>(block.vertices, *positions_, first, last, displacement)
                             : largest_of_simplices<3>(block.vertices, *positions_, first, last, displacement);
    });
  }
  return result.angle();
}

}  // namespace ricochet
