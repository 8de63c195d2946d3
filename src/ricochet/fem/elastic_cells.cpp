#include "ricochet/fem/elastic_cells.hpp"

#include "ricochet/fem/cell_assembly.hpp"
#include "ricochet/fem/cell_kernel.hpp"

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

ElasticCells::ElasticCells(const Body& body, const NodeGraph* graph) : body_(body), graph_(graph) {
  if (body.mesh->dimension == 2) plane_ = std::make_unique<Blocks<2>>(body);
  if (body.mesh->dimension == 3) solid_ = std::make_unique<Blocks<3>>(body);
}

ElasticCells::ElasticCells(const Body& body, const NodeGraph* graph, std::vector<int> cells)
    : ElasticCells(body, graph) {
  cells_ = std::move(cells);
}

ElasticCells::~ElasticCells() = default;

template <>
const ElasticCells::Blocks<2>& ElasticCells::blocks<2>() const {
  return *plane_;
}
template <>
const ElasticCells::Blocks<3>& ElasticCells::blocks<3>() const {
  return *solid_;
}

namespace {

/// Calls work(std::integral_constant<int, d>) for the dimension.
template <class Work>
auto with_dimension(int dimension, const Work& work) {
  return dimension == 2 ? work(std::integral_constant<int, 2>()) : work(std::integral_constant<int, 3>());
}

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

SparseMatrix ElasticCells::tangent(const Vector& displacement) const {
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
    });
  });
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
            const Tensor motion = kernel.gradient(u), rate = kernel.gradient(change);
            const Tensor deformation = Tensor::Identity() + motion;
            const Tensor half = transposed_product(deformation, rate);
            Tensor stress;
            law.stress((0.5 * (half + half.transpose())).eval(), stress);
            kernel.add_force(q, product(deformation, stress), local);
          }
        },
        result);
  });
}

namespace {

/// In the order of XDMF.
void write_tensor(const Tensor& tensor, double* to) {
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) *to++ = tensor(i, j);
  }
}

}  // namespace

void ElasticCells::cell_stress(std::size_t block, Index local, Index cell, const Vector& displacement, double* stress,
                               double& energy_density) const {
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
                          energy += weight * kernel.energy_at(q, strain);
                          mean += weight / determinant(deformation) * (deformation * second * deformation.transpose());
                        });
    energy_density = energy / volume;
    write_tensor(mean / volume, stress);
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
    write_tensor(mean / volume, strain);
  });
}

}  // namespace ricochet
