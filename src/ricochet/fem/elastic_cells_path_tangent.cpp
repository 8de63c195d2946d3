#include "ricochet/fem/cell_path_kernel.hpp"
#include "ricochet/fem/elastic_blocks.hpp"

/// @file Tangent of the mean stress along the path of the strain over a step.
namespace ricochet {

SparseMatrix ElasticCells::path_tangent(const Vector& middle, const Vector& increment, const PathRules& rules,
                                        const PathVariation& variation) const {
  return assemble_path_tangent(middle, increment, rules, variation, nullptr);
}

SparseMatrix ElasticCells::path_tangent(const BranchStep& step, const PathRules& rules,
                                        const PathVariation& variation) const {
  return assemble_path_tangent(step.middle, step.increment, rules, variation, &step);
}

SparseMatrix ElasticCells::assemble_path_tangent(const Vector& middle, const Vector& increment, const PathRules& rules,
                                                 const PathVariation& variation, const BranchStep* step) const {
  return with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    const Blocks<d>& all = blocks<d>();
    const bool has_branches = step != nullptr && !internal_begin_.empty();
    if (has_branches) all.set_branches(step->step);
    const auto element = [&](std::size_t block, Index local, std::size_t number, double* values) {
      const auto cell = Index(number);
      const Material& material = all.material(cell);
      CellPathKernel<d> kernel(all.all[block], local, *material.law, is_plane_stress(body_), material.mean_dilatation,
                               variation);
      typename CellPathKernel<d>::LocalVector x, change;
      kernel.gather(body_.space->cells[block].cell(local), middle, x);
      kernel.gather(body_.space->cells[block].cell(local), increment, change);
      const Index size = Index(kernel.nodes()) * d;
      typename CellPathKernel<d>::LocalMatrix matrix(values, size, size);
      matrix.setZero();
      kernel.set_path(x, change);
      kernel.add_law(rules[number], matrix);
      if (has_branches) {
        const auto own = std::size_t(body_.cell_material[number]);
        kernel.add_branches(all.branches[own], step->internal.data() + internal_begin_[number]);
      }
      kernel.add_points(matrix);
    };
    return assemble<d, CellMatrix::general>(body_, *graph_, element);
  });
}

}  // namespace ricochet
