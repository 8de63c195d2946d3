#include "ricochet/fem/rotation_gauge.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "ricochet/base/instruction_sets.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/fem/cell_integration.hpp"

namespace ricochet {

namespace {

/// The largest rotation among some cells. Below a right angle the tangent tells which is larger: one arc tangent serves
/// all cells. Sums of them are maxima.
struct LargestRotation {
  double tangent = 0.0;
  double beyond_right_angle = 0.0;

  /// `axial` and `trace` may have a common positive factor.
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

/// From stored gradients.
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

/// Some simplices side by side, so that one instruction works on several of them: component k of edge e of cell i is
/// edge[e][k][i], the edges being those from the first vertex, in the reference and as differences of displacement.
template <int d>
struct SimplexBatch {
  static constexpr int size = 64;
  double edge[d][d][size], difference[d][d][size];
  double axial[size], trace[size];  ///< both times the determinant of the edges

  /// `vertices`: d + 1 nodes per cell.
  void gather(const int* vertices, int count, const double* positions, const double* displacement) {
    for (int i = 0; i < count; ++i, vertices += d + 1) {
      const Index first = Index{vertices[0]} * d;
      for (int e = 0; e < d; ++e) {
        const Index other = Index{vertices[e + 1]} * d;
        for (int k = 0; k < d; ++k) {
          edge[e][k][i] = positions[other + k] - positions[first + k];
          difference[e][k][i] = displacement[other + k] - displacement[first + k];
        }
      }
    }
  }
};

/// ∇u = Σ_e (difference e) ⊗ c_e / det with the dual vectors c of the edges; its axial part is Σ c_e × (difference e).
RICOCHET_EACH_INSTRUCTION_SET
void evaluate(SimplexBatch<2>& batch) {
  const auto& [a, b] = batch.edge;
  const auto& [u, v] = batch.difference;
  for (int i = 0; i < SimplexBatch<2>::size; ++i) {
    const double determinant = a[0][i] * b[1][i] - a[1][i] * b[0][i];
    const double curl = (u[1][i] * b[1][i] + u[0][i] * b[0][i]) - (v[1][i] * a[1][i] + v[0][i] * a[0][i]);
    const double divergence = (u[0][i] * b[1][i] - u[1][i] * b[0][i]) + (v[1][i] * a[0][i] - v[0][i] * a[1][i]);
    batch.axial[i] = std::abs(curl);
    batch.trace[i] = 2.0 * determinant + divergence;
  }
}

RICOCHET_EACH_INSTRUCTION_SET
void evaluate(SimplexBatch<3>& batch) {
  for (int i = 0; i < SimplexBatch<3>::size; ++i) {
    double curl[3] = {0.0, 0.0, 0.0};
    double divergence = 0.0, determinant = 0.0;
    for (int e = 0; e < 3; ++e) {
      const auto& p = batch.edge[(e + 1) % 3];
      const auto& q = batch.edge[(e + 2) % 3];
      const auto& u = batch.difference[e];
      const double c[3] = {p[1][i] * q[2][i] - p[2][i] * q[1][i], p[2][i] * q[0][i] - p[0][i] * q[2][i],
                           p[0][i] * q[1][i] - p[1][i] * q[0][i]};
      curl[0] += c[1] * u[2][i] - c[2] * u[1][i];
      curl[1] += c[2] * u[0][i] - c[0] * u[2][i];
      curl[2] += c[0] * u[1][i] - c[1] * u[0][i];
      divergence += c[0] * u[0][i] + c[1] * u[1][i] + c[2] * u[2][i];
      if (e == 0) {
        const auto& edge = batch.edge[0];
        determinant = c[0] * edge[0][i] + c[1] * edge[1][i] + c[2] * edge[2][i];
      }
    }
    batch.axial[i] = std::sqrt(curl[0] * curl[0] + curl[1] * curl[1] + curl[2] * curl[2]);
    batch.trace[i] = 2.0 * determinant + divergence;
  }
}

/// From the positions of the vertices of straight simplices.
template <int d>
LargestRotation largest_of_simplices(const std::vector<int>& vertices, const Points& positions, Index first, Index last,
                                     const Vector& displacement) {
  LargestRotation result;
  SimplexBatch<d> batch{};
  for (Index cell = first; cell < last; cell += SimplexBatch<d>::size) {
    const int count = static_cast<int>(std::min<Index>(SimplexBatch<d>::size, last - cell));
    batch.gather(vertices.data() + cell * (d + 1), count, positions.data(), displacement.data());
    evaluate(batch);
    for (int i = 0; i < count; ++i) result.enter(batch.axial[i], batch.trace[i]);
  }
  return result;
}

/// The vertices of all cells, cells near one another together: nodes are numbered so, cells are not.
std::vector<int> sorted_vertices(const CellBlock& cells) {
  const int count = cells.nodes_per_cell;
  const auto lowest = [&](Index cell) { return *std::min_element(cells.cell(cell), cells.cell(cell) + count); };
  std::vector<std::pair<Index, Index>> order(static_cast<std::size_t>(cells.size()));
  for (Index cell = 0; cell < cells.size(); ++cell) order[static_cast<std::size_t>(cell)] = {lowest(cell), cell};
  std::sort(order.begin(), order.end());
  std::vector<int> vertices;
  vertices.reserve(cells.nodes.size());
  for (const auto& [node, cell] : order) {
    for (int k = 0; k < count; ++k) vertices.push_back(static_cast<int>(cells.cell(cell)[k]));
  }
  return vertices;
}

template <int d>
std::vector<double> gradients_at_centres(const Body& body, const CellBlock& geometry, const CellBlock& cells) {
  const Points centre = reference_centre(geometry.shape);
  const Tabulation map = ReferenceElement::get(geometry.shape, body.mesh->degree).tabulate(centre);
  const Tabulation shape = ReferenceElement::get(geometry.shape, body.space->degree).tabulate(centre);
  std::vector<double> result(cells.nodes.size() * static_cast<std::size_t>(d));
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

RotationGauge::RotationGauge(const Body& body) : dimension_(body.mesh->dimension), positions_(&body.space->nodes) {
  for (std::size_t b = 0; b < body.space->cells.size(); ++b) {
    const CellBlock& geometry = body.mesh->cells[b];
    const CellBlock& cells = body.space->cells[b];
    const bool simplex = geometry.shape == CellShape::triangle || geometry.shape == CellShape::tetrahedron;
    blocks_.push_back({&cells, {}, {}});
    if (simplex && body.mesh->degree == 1 && body.space->degree == 1) {
      blocks_.back().vertices = sorted_vertices(cells);
      continue;
    }
    blocks_.back().gradients = dimension_ == 2 ? gradients_at_centres<2>(body, geometry, cells)
                                               : gradients_at_centres<3>(body, geometry, cells);
  }
}

double RotationGauge::largest(const Vector& displacement) const {
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
