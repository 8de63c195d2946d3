#include "ricochet/fem/elastic_cells.hpp"

#include "ricochet/fem/elastic_blocks.hpp"

namespace ricochet {

ElasticCells::ElasticCells(const Body& body, const NodeGraph* graph) : body_(body), graph_(graph) {
  if (body.mesh->dimension == 2) plane_ = std::make_unique<Blocks<2>>(body);
  if (body.mesh->dimension == 3) solid_ = std::make_unique<Blocks<3>>(body);
  find_internal_places();
}

ElasticCells::ElasticCells(const Body& body, const NodeGraph* graph, std::vector<int> cells)
    : ElasticCells(body, graph) {
  cells_ = std::move(cells);
}

ElasticCells::~ElasticCells() = default;

namespace {

/// The worst of the cells of one part; parts are compared in their order.
void worse(InvertedCell& worst, Index cell, double ratio) {
  if (ratio < worst.volume_ratio) worst = {cell, ratio};
}

}  // namespace

namespace {

/// Of the parts, in their order.
InvertedCell worst_of(const std::vector<InvertedCell>& parts) {
  InvertedCell all;
  for (const InvertedCell& each : parts) {
    if (each.cell >= 0) worse(all, each.cell, each.volume_ratio);
  }
  return all;
}

}  // namespace

/// Adds up the forces of cells whose points move as make_motion(kernel, nodes) has it.
template <int d, class MakeMotion>
InvertedCell ElasticCells::add_up(const MakeMotion& make_motion, Vector& result) const {
  std::vector<InvertedCell> worst(static_cast<std::size_t>(graph_->parts()));
  const Blocks<d>& all = blocks<d>();
  assemble_vector<d>(
      body_, *graph_,
      [&](const CellWalk& walk, std::size_t part, Index cell, auto& local) {
        CellKernel<d> kernel = all.kernel(walk, cell);
        local.fill(0.0);
        const double least =
            kernel.visit_stress(make_motion(kernel, walk.nodes()),
                                [&](int q, const Tensor& deformation, const Tensor&, const Tensor& stress) {
                                  kernel.add_force(q, product(deformation, stress), local);
                                });
        if (!(least > 0.0)) worse(worst[part], cell, least);
      },
      result);
  return worst_of(worst);
}

InvertedCell ElasticCells::force(const Vector& displacement, Vector& result) const {
  return with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    return add_up<d>(
        [&](const CellKernel<d>& kernel, const Index* nodes) {
          typename CellKernel<d>::LocalVector u;
          kernel.gather(nodes, displacement, u);
          return [&kernel, u] { return kernel.motion_of(u); };
        },
        result);
  });
}

InvertedCell ElasticCells::mean_force(const Vector& middle, const Vector& increment, Vector& result) const {
  return with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    return add_up<d>(
        [&](const CellKernel<d>& kernel, const Index* nodes) {
          typename CellKernel<d>::LocalVector u, change;
          kernel.gather(nodes, middle, u);
          kernel.gather(nodes, increment, change);
          return [&kernel, u, change] { return kernel.mean_motion_of(u, change); };
        },
        result);
  });
}

double ElasticCells::energy(const Vector& displacement) const {
  return with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    const Blocks<d>& all = blocks<d>();
    const Index count = cells_.empty() ? body_.mesh->cell_count() : static_cast<Index>(cells_.size());
    return parallel_sum<double>(count, [&](Index first, Index last) {
      CellWalk walk(body_.space->cells);
      double sum = 0.0;
      for (Index i = first; i < last; ++i) {
        const Index cell = cells_.empty() ? i : cells_[static_cast<std::size_t>(i)];
        walk.go_to(cell);
        CellKernel<d> kernel = all.kernel(walk, cell);
        typename CellKernel<d>::LocalVector u;
        kernel.gather(walk.nodes(), displacement, u);
        sum += kernel.energy(u);
      }
      return sum;
    });
  });
}

SparseMatrix ElasticCells::tangent(const Vector& displacement, double step) const {
  return with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    const Blocks<d>& all = blocks<d>();
    return assemble<d>(body_, *graph_, [&](std::size_t block, Index local, std::size_t number, double* values) {
      const auto cell = static_cast<Index>(number);
      CellKernel<d> kernel = all.kernel(block, local, cell);
      typename CellKernel<d>::LocalVector u{};
      if (displacement.size() > 0) kernel.gather(body_.space->cells[block].cell(local), displacement, u);
      std::fill_n(values, pair_number(0, kernel.nodes()) * d * d, 0.0);
      kernel.add_tangent(u, values);
      if (step == 0.0 || internal_begin_.empty()) return;
      const Material& material = all.material(cell);
      double modulus = 0.0;
      for (const RelaxationBranch& branch : material.relaxation)
        modulus += 2.0 * branch.modulus * material.mu() * RelaxationRule(step / branch.time).stiffness();
      if (modulus > 0.0) kernel.add_deviatoric_tangent(u, modulus, values);
    });
  });
}

namespace {

/// Adds the force of the stress 𝔻₀ : (the derivative of the strain along a change) of a point, at F.
template <int d>
void add_strain_force(const CellKernel<d>& kernel, const IsotropicElasticity& law, int q, const Tensor& deformation,
                      const Tensor& rate, typename CellKernel<d>::LocalVector& local) {
  const Tensor half = transposed_product(deformation, rate);
  Tensor stress;
  law.stress((0.5 * (half + half.transpose())).eval(), stress);
  kernel.add_force(q, product(deformation, stress), local);
}

}  // namespace

InvertedCell ElasticCells::mean_forces(const Vector& middle, const Vector& increment, Vector& result,
                                       Vector& strain_result) const {
  std::vector<InvertedCell> worst(static_cast<std::size_t>(graph_->parts()));
  with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    const Blocks<d>& all = blocks<d>();
    const bool plane_stress = is_plane_stress(body_);
    const auto element = [&](const CellWalk& walk, std::size_t part, Index cell, auto& local) {
      CellKernel<d> kernel = all.kernel(walk, cell);
      typename CellKernel<d>::LocalVector u, change;
      kernel.gather(walk.nodes(), middle, u);
      kernel.gather(walk.nodes(), increment, change);
      local[0].fill(0.0);
      local[1].fill(0.0);
      const Material& material = all.material(cell);
      const bool is_linear = material.law->is_linear();
      const IsotropicElasticity law = IsotropicElasticity::of(material.lambda(), material.mu(), plane_stress);
      const double least =
          kernel.visit_stress([&] { return kernel.mean_motion_of(u, change); },
                              [&](int q, const Tensor& deformation, const Tensor&, const Tensor& stress) {
                                kernel.add_force(q, product(deformation, stress), local[0]);
                                if (is_linear) return;
                                const Tensor in_plane = Tensor::Identity() + kernel.gradient(u);
                                add_strain_force(kernel, law, q, in_plane, kernel.gradient(change), local[1]);
                              });
      if (!(least > 0.0)) worse(worst[part], cell, least);
    };
    assemble_vectors<d>(body_, *graph_, element, std::array<Vector*, 2>{&result, &strain_result});
  });
  return worst_of(worst);
}

void ElasticCells::strain_force(const Vector& displacement, const Vector& increment, Vector& result) const {
  with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    const Blocks<d>& all = blocks<d>();
    assemble_vector<d>(
        body_, *graph_,
        [&](const CellWalk& walk, std::size_t, Index cell, auto& local) {
          local.fill(0.0);
          const Material& material = all.material(cell);
          if (material.law->is_linear()) return;
          CellKernel<d> kernel = all.kernel(walk, cell);
          typename CellKernel<d>::LocalVector u, change;
          kernel.gather(walk.nodes(), displacement, u);
          kernel.gather(walk.nodes(), increment, change);
          const IsotropicElasticity law =
              IsotropicElasticity::of(material.lambda(), material.mu(), is_plane_stress(body_));
          for (int q = 0; q < kernel.points(); ++q) {
            kernel.go_to(q);
            const Tensor deformation = Tensor::Identity() + kernel.gradient(u);
            add_strain_force(kernel, law, q, deformation, kernel.gradient(change), local);
          }
        },
        result);
  });
}

namespace {

/// In the order of XDMF.
void write_for_files(const Tensor& tensor, double* to) {
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) *to++ = tensor(i, j);
  }
}

/// Adds the stress of the branches of a point; returns their energy. Goes on to the next point.
double take_branches(const Material& material, const Tensor& strain, const double*& internal, Tensor& stress) {
  const Tensor deviator = deviator_of(strain);
  double energy = 0.0;
  for (const RelaxationBranch& branch : material.relaxation) {
    const Tensor elastic = deviator - read_tensor(internal);
    const double modulus = branch.modulus * material.mu();
    stress += 2.0 * modulus * elastic;
    energy += modulus * elastic.squaredNorm();
    internal += internal_components;
  }
  return energy;
}

}  // namespace

void ElasticCells::cell_stress(std::size_t block, Index local, Index cell, const Vector& displacement,
                               const Vector& internal, double* stress, double& energy_density) const {
  const Material& material = material_of(body_, cell);
  const double* at = internal.size() > 0 ? internal.data() + internal_begin_[static_cast<std::size_t>(cell)] : nullptr;
  with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    CellKernel<d> kernel = blocks<d>().kernel(block, local, cell);
    typename CellKernel<d>::LocalVector u;
    kernel.gather(body_.space->cells[block].cell(local), displacement, u);
    Tensor mean = Tensor::Zero();
    double volume = 0.0, energy = 0.0;
    kernel.visit_stress([&] { return kernel.motion_of(u); },
                        [&](int q, const Tensor& deformation, const Tensor& strain, const Tensor& second) {
                          const double weight = kernel.weight(q);
                          volume += weight;
                          Tensor all = second;
                          energy += weight * kernel.energy_at(q, strain);
                          if (at != nullptr) energy += weight * take_branches(material, strain, at, all);
                          mean += weight / determinant(deformation) * (deformation * all * deformation.transpose());
                        });
    energy_density = energy / volume;
    write_for_files(mean / volume, stress);
  });
}

void ElasticCells::cell_strain(std::size_t block, Index local, Index cell, const Vector& displacement,
                               double* strain) const {
  with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    CellKernel<d> kernel = blocks<d>().kernel(block, local, cell);
    typename CellKernel<d>::LocalVector u;
    kernel.gather(body_.space->cells[block].cell(local), displacement, u);
    Tensor mean = Tensor::Zero();
    double volume = 0.0;
    for (int q = 0; q < kernel.points(); ++q) {
      kernel.go_to(q);
      volume += kernel.weight(q);
      mean += kernel.weight(q) * kernel.motion_of(u).strain;
    }
    write_for_files(mean / volume, strain);
  });
}

}  // namespace ricochet
