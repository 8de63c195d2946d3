#include "ricochet/fem/elastic_cells.hpp"

#include "ricochet/fem/elastic_blocks.hpp"

namespace ricochet {

ElasticCells::ElasticCells(const Body& body, const NodeGraph* graph) : ElasticCells(body, graph, {}) {}

ElasticCells::ElasticCells(const Body& body, const NodeGraph* graph, std::vector<int> cells, CellPoints points)
    : body_(body), graph_(graph), cells_(std::move(cells)) {
  if (body.mesh->dimension == 2) plane_ = std::make_unique<Blocks<2>>(body, graph, cells_, points);
  if (body.mesh->dimension == 3) solid_ = std::make_unique<Blocks<3>>(body, graph, cells_, points);
  find_internal_offsets();
}

ElasticCells::~ElasticCells() = default;

double ElasticCells::size() const {
  return with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    double sum = 0.0;
    for (std::size_t block = 0; block < body_.mesh->cells.size(); ++block) {
      const KernelBlock<d>& own = blocks<d>().all[block];
      sum += double(body_.mesh->cells[block].size()) * own.points * own.nodes * d;
    }
    return sum;
  });
}

SparseMatrix ElasticCells::tangent(const Vector& displacement, double step) const {
  return with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    const Blocks<d>& all = blocks<d>();
    return assemble<d>(body_, *graph_, [&](std::size_t block, Index local, std::size_t number, double* values) {
      const auto cell = Index(number);
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

/// Writes a tensor in the order of XDMF.
void write_for_files(const Tensor& tensor, double* to) {
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) *to++ = tensor(i, j);
  }
}

/// Adds the stress of the branches at a point; returns their energy and advances `internal` to the next point.
double add_branch_stress(const Material& material, const Tensor& strain, const double*& internal, Tensor& stress) {
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
  const double* at = internal.size() > 0 ? internal.data() + internal_begin_[std::size_t(cell)] : nullptr;
  with_dimension(body_.mesh->dimension, [&](auto dimension) {
    constexpr int d = dimension;
    CellKernel<d> kernel = blocks<d>().kernel(block, local, cell);
    typename CellKernel<d>::LocalVector u;
    kernel.gather(body_.space->cells[block].cell(local), displacement, u);
    Tensor mean = Tensor::Zero();
    double volume = 0.0, energy = 0.0;
    kernel.visit_stress(u, [&](int q, const Tensor& deformation, const Tensor& strain, const Tensor& second) {
      const double weight = kernel.weight(q);
      volume += weight;
      Tensor all = second;
      energy += weight * kernel.energy_at(q, strain);
      if (at != nullptr) energy += weight * add_branch_stress(material, strain, at, all);
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
