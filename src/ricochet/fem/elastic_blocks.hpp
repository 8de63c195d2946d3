#pragma once

#include "ricochet/fem/cell_assembly.hpp"
#include "ricochet/fem/cell_kernel.hpp"
#include "ricochet/fem/elastic_cells.hpp"
#include "ricochet/fem/relaxation.hpp"

/// @file What stays the same of the cells of a body with elastic energy. Not part of the public interface.
namespace ricochet {

template <int d>
struct ElasticCells::Blocks {
  const Body& body;
  std::vector<KernelBlock<d>> all;

  explicit Blocks(const Body& of) : body(of) {
    for (std::size_t b = 0; b < body.mesh->cells.size(); ++b) all.push_back(make(body.mesh->cells[b]));
  }
  [[nodiscard]] const Material& material(Index cell) const { return material_of(body, cell); }
  [[nodiscard]] CellKernel<d> kernel(std::size_t block, Index local, Index cell) const {
    const Material& of = material(cell);
    return {all[block], local, *of.law, is_plane_stress(body), of.mean_dilatation};
  }
  [[nodiscard]] CellKernel<d> kernel(const CellWalk& walk, Index cell) const {
    return kernel(walk.block(), walk.local(), cell);
  }

 private:
  [[nodiscard]] KernelBlock<d> make(const CellBlock& cells) const {
    KernelBlock<d> block{
        stiffness_integration(cells.shape, body.mesh->degree, body.space->degree, is_axisymmetric(body))};
    const bool simplex = is_simplex(cells.shape);
    block.affine = simplex && body.mesh->degree == 1;
    block.points = static_cast<int>(block.integration.rule.weights.size());
    block.nodes = static_cast<int>(block.integration.displacement.values.rows());
    block.weight.reserve(static_cast<std::size_t>(cells.size() * block.points));
    for (Index cell = 0; cell < cells.size(); ++cell) {
      for (int q = 0; q < block.points; ++q) {
        const auto map = jacobian<d>(body.mesh->nodes, cells.cell(cell),
                                     block.integration.geometry.gradients[static_cast<std::size_t>(q)]);
        block.weight.push_back(block.integration.rule.weights[q] * map.determinant() *
                               block.integration.ring(body.mesh->nodes, cells.cell(cell), q));
        if (is_axisymmetric(body))
          block.radius.push_back(block.integration.radius(body.mesh->nodes, cells.cell(cell), q));
        if (block.affine && q > 0) continue;
        const Eigen::Matrix<double, d, d> inverse = map.inverse();
        for (int i = 0; i < d; ++i) {
          for (int j = 0; j < d; ++j) block.inverse.push_back(inverse(i, j));
        }
      }
    }
    if (!simplex || body.space->degree > 1) block.dilatation_functions = dilatation_functions(cells.shape, block);
    return block;
  }
  /// Linear on quadrilaterals and hexahedra of degree 2, else constant. (Triangles of degree 2 are not stable with
  /// linear ones.)
  [[nodiscard]] Matrix dilatation_functions(CellShape shape, const KernelBlock<d>& block) const {
    const bool linear = !is_simplex(shape) && body.space->degree == 2;
    Matrix result = Matrix::Ones(block.points, linear ? d + 1 : 1);
    const Vector centre = reference_centre(shape);
    if (linear) result.rightCols(d) = (block.integration.rule.points.colwise() - centre).transpose();
    return result;
  }
  static bool is_simplex(CellShape shape) { return shape == CellShape::triangle || shape == CellShape::tetrahedron; }
};

template <>
inline const ElasticCells::Blocks<2>& ElasticCells::blocks<2>() const {
  return *plane_;
}
template <>
inline const ElasticCells::Blocks<3>& ElasticCells::blocks<3>() const {
  return *solid_;
}

/// Of an internal strain of a branch.
inline constexpr Index internal_components = 6;
inline Tensor read_tensor(const double* from) {
  Tensor result;
  for (std::size_t k = 0; k < tangent_components.size(); ++k) {
    const auto [i, j] = tangent_components[k];
    result(i, j) = result(j, i) = from[k];
  }
  return result;
}
inline void write_tensor(const Tensor& tensor, double* to) {
  for (const auto& [i, j] : tangent_components) *to++ = tensor(i, j);
}

/// Calls work(std::integral_constant<int, d>) for the dimension.
template <class Work>
auto with_dimension(int dimension, const Work& work) {
  return dimension == 2 ? work(std::integral_constant<int, 2>()) : work(std::integral_constant<int, 3>());
}

}  // namespace ricochet
