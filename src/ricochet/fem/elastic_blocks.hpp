#pragma once

#include "ricochet/fem/branch_kernels.hpp"
#include "ricochet/fem/cell_assembly.hpp"
#include "ricochet/fem/cell_kernel.hpp"
#include "ricochet/fem/cell_packs.hpp"
#include "ricochet/fem/elastic_cells.hpp"

/// @file Constant data of the cells of an elastic body. Not part of the public interface.
namespace ricochet {

/// Input and output of all packs.
struct ElasticCells::PackNumbers {
  std::vector<double> displacement, increment, force;
  std::vector<double> end, at;  ///< for viscoelastic branches only
};

template <int d>
struct ElasticCells::Blocks {
  const Body& body;
  CellPacks packs;
  std::vector<KernelBlock<d>> all;
  mutable PackNumbers numbers;
  mutable std::vector<std::vector<BranchNumbers>> branches;  ///< per material, over a step

  Blocks(const Body& of, const NodeGraph* graph, const std::vector<int>& cells, CellPoints points)
      : body(of), packs(of, graph, cells) {
    for (std::size_t b = 0; b < body.mesh->cells.size(); ++b)
      all.push_back(make(body.mesh->cells[b], packs.lanes(b), points));
    numbers.displacement = packs.template storage<d>();
    if (graph == nullptr) return;  // energies only, neither forces nor branches
    numbers.increment = numbers.force = numbers.displacement;
    const auto relaxes = [](const Material& each) { return !each.relaxation.empty(); };
    if (std::ranges::any_of(body.materials, relaxes)) numbers.end = numbers.at = numbers.displacement;
  }
  /// Sets up the branches for a step of this length; 0: for an instant.
  void set_branches(double step) const {
    branches.resize(body.materials.size());
    for (std::size_t m = 0; m < branches.size(); ++m) {
      const Material& of = body.materials[m];
      branches[m].clear();
      for (const RelaxationBranch& branch : of.relaxation)
        branches[m].push_back({branch.modulus * of.mu(), RelaxationRule(step > 0.0 ? step / branch.time : 1.0)});
    }
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
  [[nodiscard]] KernelBlock<d> make(const CellBlock& cells, const std::vector<int>& lanes, CellPoints points) const {
    const auto integration = points == CellPoints::nodes ? nodal_integration : stiffness_integration;
    KernelBlock<d> block{integration(cells.shape, body.mesh->degree, body.space->degree, is_axisymmetric(body))};
    const bool simplex = is_simplex(cells.shape);
    block.affine = simplex && body.mesh->degree == 1;
    block.points = int(block.integration.rule.weights.size());
    block.nodes = int(block.integration.displacement.values.rows());
    block.width = pack_width();
    for (const Matrix& of_point : block.integration.displacement.gradients) {
      for (int i = 0; i < block.nodes; ++i) {
        for (int k = 0; k < d; ++k) block.gradients.push_back(of_point(i, k));
      }
    }
    const auto packs_of_block = lanes.size() / std::size_t(block.width);
    block.weight.resize(lanes.size() * std::size_t(block.points));
    if (is_axisymmetric(body)) block.radius.resize(block.weight.size());
    block.inverse.resize(d * d * (block.affine ? lanes.size() : block.weight.size()));
    block.lane.assign(std::size_t(cells.size()), -1);
    for (std::size_t pack = 0; pack < packs_of_block; ++pack) {
      for (int k = 0; k < block.width; ++k) {
        const std::size_t index = pack * std::size_t(block.width) + std::size_t(k);
        // An unused lane has the geometry of the first lane's cell.
        const Index cell = lanes[lanes[index] < 0 ? pack * std::size_t(block.width) : index];
        if (lanes[index] >= 0) block.lane[std::size_t(cell)] = int(index);
        measure(cells.cell(cell), Index(pack), k, block);
        if (points == CellPoints::nodes) share_weight(Index(pack), k, block);
      }
    }
    if (!simplex || body.space->degree > 1) block.dilatation_functions = dilatation_functions(cells.shape, block);
    return block;
  }
  /// Computes Jacobians, weights and radii of one cell.
  void measure(const Index* nodes, Index pack, int lane, KernelBlock<d>& block) const {
    for (int q = 0; q < block.points; ++q) {
      const auto map = jacobian<d>(body.mesh->nodes, nodes, block.integration.geometry.gradients[std::size_t(q)]);
      const auto index = std::size_t(block.index(pack, q) + lane);
      block.weight[index] =
          block.integration.rule.weights[q] * map.determinant() * block.integration.ring(body.mesh->nodes, nodes, q);
      if (is_axisymmetric(body)) block.radius[index] = block.integration.radius(body.mesh->nodes, nodes, q);
      if (block.affine && q > 0) continue;
      const Eigen::Matrix<double, d, d> inverse = map.inverse();
      auto at = std::size_t(block.inverse_of_pack(pack, q) - block.inverse.data() + lane);
      for (int i = 0; i < d; ++i) {
        for (int j = 0; j < d; ++j, at += std::size_t(block.width)) block.inverse[at] = inverse(i, j);
      }
    }
  }
  /// Gives all points of a cell the same weight, also those close to an axis.
  void share_weight(Index pack, int lane, KernelBlock<d>& block) const {
    const auto at = [&](int q) -> double& { return block.weight[std::size_t(block.index(pack, q) + lane)]; };
    double sum = 0.0;
    for (int q = 0; q < block.points; ++q) sum += at(q);
    for (int q = 0; q < block.points; ++q) at(q) = sum / block.points;
  }
  /// Constant on simplices and with degree 1, else linear. (Linear ones are unstable on triangles of degree 2.)
  [[nodiscard]] Matrix dilatation_functions(CellShape shape, const KernelBlock<d>& block) const {
    const bool linear = !is_simplex(shape) && body.space->degree == 2;
    Matrix result = Matrix::Ones(block.points, linear ? d + 1 : 1);
    const Vector centre = reference_centre(shape);
    if (linear) result.rightCols(d) = (block.integration.rule.points.colwise() - centre).transpose();
    return result;
  }
};

template <>
inline const ElasticCells::Blocks<2>& ElasticCells::blocks<2>() const {
  return *plane_;
}
template <>
inline const ElasticCells::Blocks<3>& ElasticCells::blocks<3>() const {
  return *solid_;
}

/// Calls work(std::integral_constant<int, d>) for the dimension.
template <class Work>
auto with_dimension(int dimension, const Work& work) {
  return dimension == 2 ? work(std::integral_constant<int, 2>()) : work(std::integral_constant<int, 3>());
}

}  // namespace ricochet
