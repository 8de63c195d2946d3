#include "ricochet/fem/stress.hpp"

#include <cmath>

#include "ricochet/base/dense_decompositions.hpp"
#include "ricochet/base/parallel.hpp"
#include "ricochet/fem/cell_integration.hpp"
#include "ricochet/fem/elastic_cells.hpp"

namespace ricochet {

namespace {

/// Calls visit(block, number of its first cell) for all blocks.
template <class Visit>
void for_each_block(const Body& body, const Visit& visit) {
  Index first = 0;
  for (std::size_t block = 0; block < body.space->cells.size(); ++block) {
    visit(block, first);
    first += body.space->cells[block].size();
  }
}

template <int d>
void block_volumes(const Body& body, std::size_t block, Index first_cell, Vector& volumes) {
  const CellBlock& geometry = body.mesh->cells[block];
  const BlockIntegration integration =
      stiffness_integration(geometry.shape, body.mesh->degree, body.space->degree, is_axisymmetric(body));
  for (Index cell = 0; cell < geometry.size(); ++cell) {
    double volume = 0.0;
    for (Index q = 0; q < integration.rule.weights.size(); ++q) {
      const auto map =
          jacobian<d>(body.mesh->nodes, geometry.cell(cell), integration.geometry.gradients[std::size_t(q)]);
      volume += integration.rule.weights[q] * std::abs(map.determinant()) *
                integration.ring(body.mesh->nodes, geometry.cell(cell), q);
    }
    volumes[first_cell + cell] = volume;
  }
}

/// Law of one material in a body of this dimension.
template <int d>
class StressLaw {
 public:
  using Tensor = Eigen::Matrix<double, d, d>;

  StressLaw(const Body& body, Index cell)
      : has_out_of_plane_stress_(d == 2 && !is_plane_stress(body)),
        elasticity_(linear_law(body, material_of(body, cell))) {}

  /// `hoop`: the strain normal to the plane of an axisymmetric body; zero in others.
  [[nodiscard]] double energy_density(const Tensor& strain, double hoop) const {
    return elasticity_.energy(strain) + elasticity_.hoop_energy(strain, hoop);
  }
  void write_stress(const Tensor& strain, double hoop, double* to) const {
    Tensor in_space;
    elasticity_.stress(strain, in_space);
    in_space.diagonal().array() += elasticity_.hoop_pressure(hoop);
    Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
    stress.template topLeftCorner<d, d>() = in_space;
    if (has_out_of_plane_stress_)
      stress(2, 2) = elasticity_.out_of_plane_stress(strain) + elasticity_.hoop_stress(hoop);
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) *to++ = stress(i, j);
    }
  }

 private:
  bool has_out_of_plane_stress_;
  IsotropicElasticity elasticity_;
};

template <int d>
Eigen::Matrix<double, d, d> symmetric(const Eigen::Matrix<double, d, d>& gradient) {
  return 0.5 * (gradient + gradient.transpose());
}

/// Strain of a straight simplex of degree 1, from its edges; it is constant.
template <int d>
Eigen::Matrix<double, d, d> simplex_strain(const Points& positions, const Index* nodes, const Vector& displacement) {
  Eigen::Matrix<double, d, d> edges, differences;
  for (int i = 0; i < d; ++i) {
    edges.col(i) = positions.block<d, 1>(0, nodes[i + 1]) - positions.block<d, 1>(0, nodes[0]);
    differences.col(i) = displacement.segment<d>(nodes[i + 1] * d) - displacement.segment<d>(nodes[0] * d);
  }
  return symmetric<d>(differences * edges.inverse());
}

/// Whether the strain is constant over each cell.
bool has_straight_simplices(const Body& body, CellShape shape) {
  if (is_axisymmetric(body)) return false;
  return is_simplex(shape) && body.mesh->degree == 1 && body.space->degree == 1;
}

}  // namespace

CellStress::CellStress(const Body& body) : body_(body) {
  if (has_finite_strain(body)) {
    finite_ = std::make_unique<ElasticCells>(body);
    return;
  }
  for (const CellBlock& block : body.mesh->cells) {
    const bool simple = has_straight_simplices(body, block.shape);
    integrations_.push_back(simple ? nullptr
                                   : std::make_unique<const BlockIntegration>(stiffness_integration(
                                         block.shape, body.mesh->degree, body.space->degree, is_axisymmetric(body))));
  }
}

CellStress::~CellStress() = default;
CellStress::CellStress(CellStress&&) noexcept = default;

namespace {

/// Means over a cell.
template <int d>
struct CellMeans {
  Eigen::Matrix<double, d, d> strain = Eigen::Matrix<double, d, d>::Zero();
  double hoop = 0.0;
  double energy_density = 0.0;
};

/// u_x/x at a point of the rule.
double hoop_strain(const BlockIntegration& integration, const Points& positions, const Index* geometry,
                   const Index* nodes, Index q, const Vector& displacement) {
  const Matrix& values = integration.displacement.values;
  double radial = 0.0;
  for (Index i = 0; i < values.rows(); ++i) radial += values(i, q) * displacement[nodes[i] * 2];
  return radial / integration.radius(positions, geometry, q);
}

template <int d>
CellMeans<d> integrate(const BlockIntegration& integration, const Points& positions, const Index* geometry,
                       const Index* nodes, const StressLaw<d>& law, const Vector& displacement) {
  CellMeans<d> result;
  double volume = 0.0;
  for (std::size_t q = 0; q < integration.displacement.gradients.size(); ++q) {
    const Eigen::Matrix<double, d, d> map = jacobian<d>(positions, geometry, integration.geometry.gradients[q]);
    const Matrix& shape = integration.displacement.gradients[q];
    Eigen::Matrix<double, d, d> reference = Eigen::Matrix<double, d, d>::Zero();
    for (Index i = 0; i < shape.rows(); ++i)
      reference += displacement.segment<d>(nodes[i] * d) * shape.block<1, d>(i, 0);
    const Eigen::Matrix<double, d, d> strain = symmetric<d>(reference * map.inverse());
    const auto point = Index(q);
    const double hoop =
        integration.axisymmetric ? hoop_strain(integration, positions, geometry, nodes, point, displacement) : 0.0;
    const double weight =
        integration.rule.weights[point] * std::abs(map.determinant()) * integration.ring(positions, geometry, point);
    volume += weight;
    result.strain += weight * strain;
    result.hoop += weight * hoop;
    result.energy_density += weight * law.energy_density(strain, hoop);
  }
  result.strain /= volume;
  result.hoop /= volume;
  result.energy_density /= volume;
  return result;
}

/// Calls visit(cell, law, means) for some cells of a block.
template <int d, class Visit>
void visit_cells(const Body& body, const BlockIntegration* integration, std::size_t block, Index first_cell,
                 const Vector& displacement, Index first, Index last, const Visit& visit) {
  const CellBlock& geometry = body.mesh->cells[block];
  const CellBlock& cells = body.space->cells[block];
  for (Index cell = first; cell < last; ++cell) {
    const StressLaw<d> law(body, first_cell + cell);
    CellMeans<d> means;
    if (integration == nullptr) {
      means.strain = simplex_strain<d>(body.space->nodes, cells.cell(cell), displacement);
      means.energy_density = law.energy_density(means.strain, 0.0);
    } else {
      means = integrate<d>(*integration, body.mesh->nodes, geometry.cell(cell), cells.cell(cell), law, displacement);
    }
    visit(cell, law, means);
  }
}

}  // namespace

template <int d>
void CellStress::evaluate_block(std::size_t block, Index first_cell, const Vector& displacement, const Vector& internal,
                                double* stress, double* energy_density) const {
  if (finite_) {
    parallel_ranges(body_.space->cells[block].size(), [&](Index first, Index last) {
      for (Index cell = first; cell < last; ++cell) {
        finite_->cell_stress(block, cell, first_cell + cell, displacement, internal, stress + tensor_components * cell,
                             energy_density[cell]);
      }
    });
    return;
  }
  parallel_ranges(body_.space->cells[block].size(), [&](Index first, Index last) {
    visit_cells<d>(body_, integrations_[block].get(), block, first_cell, displacement, first, last,
                   [&](Index cell, const StressLaw<d>& law, const CellMeans<d>& means) {
                     law.write_stress(means.strain, means.hoop, stress + tensor_components * cell);
                     energy_density[cell] = means.energy_density;
                   });
  });
}

template <int d>
LargestOfCells CellStress::largest_in_block(std::size_t block, Index first_cell, const Vector& displacement,
                                            const Vector& internal) const {
  if (finite_) {
    return parallel_sum<LargestOfCells>(body_.space->cells[block].size(), [&](Index first, Index last) {
      LargestOfCells largest;
      for (Index cell = first; cell < last; ++cell) {
        std::array<double, tensor_components> stress;
        double energy = 0.0;
        finite_->cell_stress(block, cell, first_cell + cell, displacement, internal, stress.data(), energy);
        largest += LargestOfCells{von_mises_stress(stress.data()), first_cell + cell};
      }
      return largest;
    });
  }
  return parallel_sum<LargestOfCells>(body_.space->cells[block].size(), [&](Index first, Index last) {
    LargestOfCells largest;
    visit_cells<d>(body_, integrations_[block].get(), block, first_cell, displacement, first, last,
                   [&](Index cell, const StressLaw<d>& law, const CellMeans<d>& means) {
                     std::array<double, tensor_components> stress;
                     law.write_stress(means.strain, means.hoop, stress.data());
                     largest += LargestOfCells{von_mises_stress(stress.data()), first_cell + cell};
                   });
    return largest;
  });
}

LargestOfCells CellStress::largest_von_mises(const Vector& displacement, const Vector& internal) const {
  LargestOfCells largest;
  for_each_block(body_, [&](std::size_t block, Index first) {
    largest += body_.mesh->dimension == 2 ? largest_in_block<2>(block, first, displacement, internal)
                                          : largest_in_block<3>(block, first, displacement, internal);
  });
  return largest;
}

void CellStress::evaluate(const Vector& displacement, std::vector<double>& stress, std::vector<double>& energy_density,
                          const Vector& internal) const {
  const auto count = std::size_t(body_.mesh->cell_count());
  stress.resize(tensor_components * count);
  energy_density.resize(count);
  for_each_block(body_, [&](std::size_t block, Index first) {
    double* const to = stress.data() + tensor_components * first;
    if (body_.mesh->dimension == 2) {
      evaluate_block<2>(block, first, displacement, internal, to, energy_density.data() + first);
    } else {
      evaluate_block<3>(block, first, displacement, internal, to, energy_density.data() + first);
    }
  });
}

double von_mises_stress(const double* s) {
  const double xy = s[0] - s[3], yz = s[3] - s[5], zx = s[5] - s[0];
  return std::sqrt(0.5 * (xy * xy + yz * yz + zx * zx) + 3.0 * (s[1] * s[1] + s[2] * s[2] + s[4] * s[4]));
}

std::array<double, 3> principal_stresses(const double* s) {
  Eigen::Matrix3d tensor;
  tensor << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5];
  const Eigen::Vector3d values = symmetric_eigenvalues(tensor);
  return {values[2], values[1], values[0]};
}

Vector cell_volumes(const Body& body) {
  Vector volumes(body.mesh->cell_count());
  for_each_block(body, [&](std::size_t block, Index first) {
    if (body.mesh->dimension == 2) {
      block_volumes<2>(body, block, first, volumes);
    } else {
      block_volumes<3>(body, block, first, volumes);
    }
  });
  return volumes;
}

}  // namespace ricochet
