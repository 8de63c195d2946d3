#include "ricochet/fem/elastic_blocks.hpp"

/// @file Branches of the materials beside their laws, of the cells of a body.
namespace ricochet {

void ElasticCells::find_internal_places() {
  Index sum = 0;
  std::vector<Index> begin;
  begin.reserve(body_.cell_material.size() + 1);
  CellWalk walk(body_.space->cells);
  for (Index cell = 0; cell < body_.mesh->cell_count(); ++cell) {
    walk.go_to(cell);
    begin.push_back(sum);
    const auto branches = static_cast<Index>(material_of(body_, cell).relaxation.size());
    sum += branches * internal_components * with_dimension(body_.mesh->dimension, [&](auto dimension) -> Index {
             constexpr int d = dimension;
             return blocks<d>().all[walk.block()].points;
           });
  }
  begin.push_back(sum);
  if (sum > 0) internal_begin_ = std::move(begin);
}

/// Adds up the forces of the cells that have branches: make(kernel, nodes) gives a function of a material and the place
/// of the internal strains of the kernel's point that returns F S there.
template <int d, class MakeForce>
void ElasticCells::add_up_branches(const MakeForce& make, Vector& result) const {
  const Blocks<d>& all = blocks<d>();
  assemble_vector<d>(
      body_, *graph_,
      [&](const CellWalk& walk, std::size_t, Index cell, auto& local) {
        local.fill(0.0);
        const Material& material = all.material(cell);
        if (material.relaxation.empty()) return;
        CellKernel<d> kernel = all.kernel(walk, cell);
        const auto force_at = make(kernel, walk.nodes());
        Index at = internal_begin_[static_cast<std::size_t>(cell)];
        for (int q = 0; q < kernel.points(); ++q) {
          kernel.go_to(q);
          kernel.add_force(q, force_at(material, at), local);
          at += internal_components * static_cast<Index>(material.relaxation.size());
        }
      },
      result);
}

/// Σ of make(kernel, nodes)(material, place of the internal strains) times the weight over the points of these cells.
template <int d, class MakeWork>
double ElasticCells::sum_branches(const MakeWork& make) const {
  const Blocks<d>& all = blocks<d>();
  const Index count = cells_.empty() ? body_.mesh->cell_count() : static_cast<Index>(cells_.size());
  return parallel_sum<double>(count, [&](Index first, Index last) {
    CellWalk walk(body_.space->cells);
    double sum = 0.0;
    for (Index i = first; i < last; ++i) {
      const Index cell = cells_.empty() ? i : cells_[static_cast<std::size_t>(i)];
      const Material& material = all.material(cell);
      if (material.relaxation.empty()) continue;
      walk.go_to(cell);
      CellKernel<d> kernel = all.kernel(walk, cell);
      const auto work_at = make(kernel, walk.nodes());
      Index at = internal_begin_[static_cast<std::size_t>(cell)];
      for (int q = 0; q < kernel.points(); ++q) {
        kernel.go_to(q);
        sum += kernel.weight(q) * work_at(material, at);
        at += internal_components * static_cast<Index>(material.relaxation.size());
      }
    }
    return sum;
  });
}

namespace {

/// The strain of a cell's points at one displacement.
template <int d>
class CellStrain {
 public:
  CellStrain(const CellKernel<d>& kernel, const Index* nodes, const Vector& displacement) : kernel_(kernel) {
    kernel.gather(nodes, displacement, u_);
  }
  /// At the point of the kernel.
  [[nodiscard]] Tensor gradient() const { return kernel_.gradient(u_); }
  [[nodiscard]] Tensor deviator() const { return deviator_of(green_strain(gradient())); }

 private:
  const CellKernel<d>& kernel_;
  typename CellKernel<d>::LocalVector u_;
};

/// The same over a step.
template <int d>
class CellStep {
 public:
  struct Point {
    Tensor middle_motion, end_motion;  ///< displacement gradients
    Tensor start, middle, end;         ///< deviators of E₀, Ē and E₁
  };
  CellStep(const CellKernel<d>& kernel, const Index* nodes, const BranchStep& step)
      : kernel_(kernel), end_(kernel, nodes, step.end) {
    kernel.gather(nodes, step.middle, middle_);
    kernel.gather(nodes, step.increment, increment_);
  }
  [[nodiscard]] Point point() const {
    const auto [motion, strain] = kernel_.mean_motion_of(middle_, increment_);
    const Tensor end = end_.gradient();
    const Tensor start = end - kernel_.gradient(increment_);
    return {motion, end, deviator_of(green_strain(start)), deviator_of(strain), deviator_of(green_strain(end))};
  }

 private:
  const CellKernel<d>& kernel_;
  typename CellKernel<d>::LocalVector middle_, increment_;
  CellStrain<d> end_;
};

/// Calls visit(modulus gμ, τ, A, place of A) for the branches of a point.
template <class Visit>
void for_each_branch(const Material& material, const Vector& internal, Index at, const Visit& visit) {
  for (const RelaxationBranch& branch : material.relaxation) {
    visit(branch.modulus * material.mu(), branch.time, read_tensor(internal.data() + at), at);
    at += internal_components;
  }
}

Tensor pulled(const Tensor& motion, const Tensor& stress) {
  return product(Tensor::Identity() + motion, stress);
}

}  // namespace

void ElasticCells::relax(const Vector& displacement, Vector& internal) const {
  internal.setZero(internal_size());
  with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    sum_branches<d>([&](const CellKernel<d>& kernel, const Index* nodes) {
      return [&, strain = CellStrain<d>(kernel, nodes, displacement)](const Material& material, Index at) {
        const Tensor deviator = strain.deviator();
        for (std::size_t i = 0; i < material.relaxation.size(); ++i, at += internal_components)
          write_tensor(deviator, internal.data() + at);
        return 0.0;
      };
    });
  });
}

double ElasticCells::branch_energy(const Vector& displacement, const Vector& internal) const {
  return with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    return sum_branches<d>([&](const CellKernel<d>& kernel, const Index* nodes) {
      return [&, strain = CellStrain<d>(kernel, nodes, displacement)](const Material& material, Index at) {
        const Tensor deviator = strain.deviator();
        double sum = 0.0;
        for_each_branch(material, internal, at, [&](double modulus, double, const Tensor& own, Index) {
          sum += modulus * (deviator - own).squaredNorm();
        });
        return sum;
      };
    });
  });
}

void ElasticCells::mean_branch_force(const BranchStep& step, Vector& result) const {
  with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    add_up_branches<d>(
        [&](const CellKernel<d>& kernel, const Index* nodes) {
          return [&, cell = CellStep<d>(kernel, nodes, step)](const Material& material, Index at) {
            const auto point = cell.point();
            Tensor stress = Tensor::Zero();
            for_each_branch(material, step.internal, at, [&](double modulus, double time, const Tensor& own, Index) {
              stress += 2.0 * modulus * RelaxationRule(step.step / time).mean(point.middle, point.end, own);
            });
            return pulled(point.middle_motion, stress);
          };
        },
        result);
  });
}

void ElasticCells::end_branch_force(const BranchStep& step, Vector& result) const {
  with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    add_up_branches<d>(
        [&](const CellKernel<d>& kernel, const Index* nodes) {
          return [&, cell = CellStep<d>(kernel, nodes, step)](const Material& material, Index at) {
            const auto point = cell.point();
            Tensor stress = Tensor::Zero();
            for_each_branch(material, step.internal, at, [&](double modulus, double time, const Tensor& own, Index) {
              stress +=
                  2.0 * modulus * (point.end - RelaxationRule(step.step / time).next(point.middle, point.end, own));
            });
            return pulled(point.end_motion, stress);
          };
        },
        result);
  });
}

double ElasticCells::start_branch_energy(const BranchStep& step, const Vector& displacement) const {
  return with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    return sum_branches<d>([&](const CellKernel<d>& kernel, const Index* nodes) {
      return [&, cell = CellStep<d>(kernel, nodes, step), strain = CellStrain<d>(kernel, nodes, displacement)](
                 const Material& material, Index at) {
        const auto point = cell.point();
        const Tensor deviator = strain.deviator();
        double sum = 0.0;
        for_each_branch(material, step.internal, at, [&](double modulus, double time, const Tensor& own, Index) {
          const RelaxationRule rule(step.step / time);
          const Tensor elastic_end = point.end - rule.next(point.middle, point.end, own);
          sum += modulus * rule.start_energy(deviator, own, elastic_end);
        });
        return sum;
      };
    });
  });
}

void ElasticCells::start_branch_force(const BranchStep& step, const Vector& displacement, Vector& result) const {
  with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    add_up_branches<d>(
        [&](const CellKernel<d>& kernel, const Index* nodes) {
          return [&, cell = CellStep<d>(kernel, nodes, step), strain = CellStrain<d>(kernel, nodes, displacement)](
                     const Material& material, Index at) {
            const auto point = cell.point();
            const Tensor deviator = strain.deviator();
            Tensor stress = Tensor::Zero();
            for_each_branch(material, step.internal, at, [&](double modulus, double time, const Tensor& own, Index) {
              const RelaxationRule rule(step.step / time);
              const Tensor elastic_end = point.end - rule.next(point.middle, point.end, own);
              stress += 2.0 * modulus * rule.start_stress(deviator, own, elastic_end);
            });
            return pulled(strain.gradient(), stress);
          };
        },
        result);
  });
}

double ElasticCells::advance_internal(const BranchStep& step, Vector& internal) const {
  internal.resize(internal_size());
  return with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    return sum_branches<d>([&](const CellKernel<d>& kernel, const Index* nodes) {
      return [&, cell = CellStep<d>(kernel, nodes, step)](const Material& material, Index at) {
        const auto point = cell.point();
        double sum = 0.0;
        for_each_branch(material, step.internal, at, [&](double modulus, double time, const Tensor& own, Index place) {
          const RelaxationRule rule(step.step / time);
          sum += modulus * rule.dissipation(point.start, point.middle, point.end, own);
          write_tensor(rule.next(point.middle, point.end, own), internal.data() + place);
        });
        return sum;
      };
    });
  });
}

}  // namespace ricochet
