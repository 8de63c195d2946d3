#include <algorithm>
#include <cmath>

#include "ricochet/fem/assembly.hpp"
#include "ricochet/fem/cell_integration.hpp"

namespace ricochet {

RotationGauge::RotationGauge(const Body& body) : dimension_(body.mesh->dimension) {
  for (std::size_t b = 0; b < body.space->cells.size(); ++b) {
    const CellBlock& geometry = body.mesh->cells[b];
    const CellBlock& cells = body.space->cells[b];
    const Points centre = reference_centre(geometry.shape);
    const Tabulation map = ReferenceElement::get(geometry.shape, body.mesh->degree).tabulate(centre);
    const Tabulation shape = ReferenceElement::get(geometry.shape, body.space->degree).tabulate(centre);
    Block block{cells.nodes_per_cell, cells.nodes, {}};
    block.gradients.reserve(cells.nodes.size() * static_cast<std::size_t>(dimension_));
    for (Index cell = 0; cell < cells.size(); ++cell) {
      const Index* nodes = geometry.cell(cell);
      const Matrix jacobian_at_centre = dimension_ == 2
                                            ? Matrix(jacobian<2>(body.mesh->nodes, nodes, map.gradients[0]))
                                            : Matrix(jacobian<3>(body.mesh->nodes, nodes, map.gradients[0]));
      const Matrix gradients = shape.gradients[0] * jacobian_at_centre.inverse();
      for (Index i = 0; i < gradients.rows(); ++i) {
        for (Index k = 0; k < dimension_; ++k) block.gradients.push_back(gradients(i, k));
      }
    }
    blocks_.push_back(std::move(block));
  }
}

namespace {

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

}  // namespace

double RotationGauge::largest(const Vector& displacement) const {
  // Below a right angle the tangent tells which rotation is larger: one arc tangent serves all cells.
  double largest_tangent = 0.0;
  double beyond_right_angle = 0.0;
  const auto enter = [&](double axial, double trace) {
    if (trace > 0.0) {
      largest_tangent = std::max(largest_tangent, axial / trace);
    } else {
      beyond_right_angle = std::max(beyond_right_angle, std::atan2(axial, trace));
    }
  };
  for (const Block& block : blocks_) {
    const auto cells = static_cast<Index>(block.nodes.size()) / block.nodes_per_cell;
    for (Index cell = 0; cell < cells; ++cell) {
      const Index* nodes = block.nodes.data() + cell * block.nodes_per_cell;
      const double* gradients = block.gradients.data() + cell * block.nodes_per_cell * dimension_;
      if (dimension_ == 2) {
        const Eigen::Matrix2d h = displacement_gradient<2>(nodes, block.nodes_per_cell, gradients, displacement);
        enter(std::abs(h(1, 0) - h(0, 1)), 2.0 + h(0, 0) + h(1, 1));
      } else {
        const Eigen::Matrix3d h = displacement_gradient<3>(nodes, block.nodes_per_cell, gradients, displacement);
        const Eigen::Vector3d axial(h(2, 1) - h(1, 2), h(0, 2) - h(2, 0), h(1, 0) - h(0, 1));
        enter(axial.norm(), 2.0 + h.trace());
      }
    }
  }
  return std::max(beyond_right_angle, std::atan(largest_tangent));
}

}  // namespace ricochet
